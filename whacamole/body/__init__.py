"""SMPL-X bodies: parameters, models, posing and the geometry that follows from it."""

from whacamole.body.geometry import facing, mesh_volume, triangulated, unit_vectors, vertex_normals
from whacamole.body.joints import (
    JOINT_GROUPS,
    JOINT_INDEX,
    JOINT_NAMES,
    MIRROR_JOINTS,
    NUM_BETAS,
    NUM_EXPRESSION,
    NUM_JOINTS,
    PARENTS,
)
from whacamole.body.model import EMBEDDED_NAME, BodyModel, Posed
from whacamole.body.params import BodyParams
from whacamole.errors import BodyModelError

__all__ = [
    "EMBEDDED_NAME",
    "JOINT_GROUPS",
    "JOINT_INDEX",
    "JOINT_NAMES",
    "MIRROR_JOINTS",
    "NUM_BETAS",
    "NUM_EXPRESSION",
    "NUM_JOINTS",
    "PARENTS",
    "BodyModel",
    "BodyModelError",
    "BodyParams",
    "Posed",
    "facing",
    "mesh_volume",
    "triangulated",
    "unit_vectors",
    "vertex_normals",
]
