"""Geometry of posed bodies: where a person faces, normals, volume."""

from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt
import scipy.sparse

from whacamole.body.joints import JOINT_INDEX

FloatArray = npt.NDArray[np.float64]
Float32Array = npt.NDArray[np.float32]
Integer = TypeVar("Integer", bound=np.integer[Any])

_TRUSTED = 0.15
"""Below this trust (trunk within 32° of straight down) the facing is taken from the frames around."""


def facing(joints: npt.ArrayLike) -> FloatArray:
    """Where a person faces, level with the ground, steady through bends, rolls and cartwheels.

    The trunk's frame (left from hips and shoulders, up from hips to shoulders, forward = left × up) is
    tipped upright by the shortest turn that brings its up axis to the world's; forward then lies level. So
    bending over, lying on back or belly, rolling and turning a cartwheel keep the heading they started with.
    In closed form, with up u and forward f, ``h = (1 + u_z) f − f_z u`` (its level part), whose length
    ``1 + u_z`` is also how far to trust it: upside down no heading is defined, and those frames take the
    direction between their trusted neighbours.

    Args:
        joints: (T, 55, 3) in a world with z up [m].

    Returns:
        (T, 3) unit vectors with z = 0.
    """
    J = np.asarray(joints, dtype=np.float64)
    hips = J[:, [JOINT_INDEX["left_hip"], JOINT_INDEX["right_hip"]]]
    shoulders = J[:, [JOINT_INDEX["left_shoulder"], JOINT_INDEX["right_shoulder"]]]
    up = unit_vectors(shoulders.mean(axis=1) - hips.mean(axis=1))
    left = unit_vectors(hips[:, 0] - hips[:, 1]) + unit_vectors(shoulders[:, 0] - shoulders[:, 1])
    forward = unit_vectors(np.cross(left, up))
    trust = 1.0 + up[:, 2]
    level = trust[:, None] * forward - forward[:, 2:] * up
    # All upside down: no frame to lean on, so the chest's own direction serves.
    trusted = np.flatnonzero(trust > _TRUSTED)
    source = level if len(trusted) else forward
    azimuth = np.arctan2(source[:, 1], source[:, 0])
    if len(trusted):
        azimuth = np.interp(np.arange(len(J)), trusted, np.unwrap(azimuth[trusted]))
    return np.stack([np.cos(azimuth), np.sin(azimuth), np.zeros(len(J))], axis=1)


def vertex_normals(vertices: npt.ArrayLike, faces: npt.ArrayLike) -> Float32Array:
    """Unit normals (…, V, 3) of vertices (…, V, 3), faces weighted by area; zero at a vertex of no face."""
    points = np.asarray(vertices, dtype=np.float32)
    triangles = np.asarray(faces)
    corners = points[..., triangles, :]
    flat = np.cross(corners[..., 1, :] - corners[..., 0, :], corners[..., 2, :] - corners[..., 0, :])
    V, F = points.shape[-2], len(triangles)
    ones = np.ones(3 * F, dtype=np.float32)
    entries = (ones, (triangles.T.reshape(-1), np.tile(np.arange(F), 3)))
    touches: Any = scipy.sparse.coo_array(entries, shape=(V, F)).tocsr()
    columns = np.moveaxis(flat, -2, 0).reshape(F, -1)
    total = np.moveaxis((touches @ columns).reshape(V, *points.shape[:-2], 3), 0, -2)
    length = np.linalg.norm(total, axis=-1, keepdims=True)
    normals: Float32Array = np.divide(total, length, out=np.zeros_like(total), where=length > 0)
    return normals


def mesh_volume(vertices: npt.ArrayLike, faces: npt.ArrayLike) -> FloatArray:
    """Volume (…,) [m³] inside a closed mesh (…, V, 3): signed tetrahedra from the origin to every face."""
    points = np.asarray(vertices, dtype=np.float64)
    a, b, c = np.moveaxis(points[..., np.asarray(faces), :], -2, 0)
    triple: FloatArray = a * np.cross(b, c)
    return np.asarray(triple.sum(axis=(-1, -2)) / 6.0)


def triangulated(faces: npt.NDArray[Integer]) -> npt.NDArray[Integer]:
    """Triangles (F, 3) as they are; quads (F, 4) cut in two, those with −1 last being triangles."""
    if faces.shape[1] == 3:
        return faces
    return np.concatenate([faces[:, :3], faces[faces[:, 3] >= 0][:, [0, 2, 3]]])


def unit_vectors(vectors: FloatArray) -> FloatArray:
    """Vectors (…, k) at length 1; those without length stay as they are."""
    length = np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), np.finfo(np.float64).tiny)
    unit: FloatArray = vectors / length
    return unit
