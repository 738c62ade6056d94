"""Named parts of a body, for any model with the 55 joints of SMPL-X.

A vertex belongs to the group of joints that together hold the largest skinning weight, so the parts need no
list of vertex numbers and are the same parts on the embedded body, on SMPL-X and on anything else with this
skeleton. The torso is then cut into front and back by the direction the skin faces at rest, and each foot
into heel and forefoot halfway between the ankle and the ball of the foot (joints ``ankle`` and ``foot``).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from whacamole.body import vertex_normals
from whacamole.labels.arrays import Float64s, Floats, Indices, Integers

# Joint groups before the cuts, SMPL-X joint numbers. Collars move with the chest.
_GROUPS: dict[str, tuple[int, ...]] = {
    "head": (15, 22, 23, 24),
    "neck": (12,),
    "chest": (9, 13, 14),
    "belly": (3, 6),
    "pelvis": (0,),
    "left_upper_arm": (16,),
    "right_upper_arm": (17,),
    "left_forearm": (18,),
    "right_forearm": (19,),
    "left_hand": (20, *range(25, 40)),
    "right_hand": (21, *range(40, 55)),
    "left_thigh": (1,),
    "right_thigh": (2,),
    "left_shin": (4,),
    "right_shin": (5,),
    "left_heel": (7, 10),
    "right_heel": (8, 11),
}

# What the half that the cut takes away is called: the back of the torso, the front of the feet.
_CUT: dict[str, str] = {
    "chest": "upper_back",
    "belly": "lower_back",
    "left_heel": "left_forefoot",
    "right_heel": "right_forefoot",
}

PART_NAMES: tuple[str, ...] = (
    "head",
    "neck",
    "chest",
    "upper_back",
    "belly",
    "lower_back",
    "pelvis",
    "left_upper_arm",
    "right_upper_arm",
    "left_forearm",
    "right_forearm",
    "left_hand",
    "right_hand",
    "left_thigh",
    "right_thigh",
    "left_shin",
    "right_shin",
    "left_heel",
    "right_heel",
    "left_forefoot",
    "right_forefoot",
)
"""The parts of :func:`skinning_parts`, in the order of ``part_names`` in ``contact.npz``."""


@dataclass(frozen=True, eq=False)
class BodyParts:
    """A partition of a body's vertices.

    Attributes:
        names: C part names.
        vertex_part: ``(V,)`` int32 index into ``names``; -1 for a vertex of no part.
    """

    names: tuple[str, ...]
    vertex_part: NDArray[np.int32]

    def vertices(self, name: str) -> Indices:
        """The vertex numbers of one part.

        Raises:
            ValueError: there is no such part.
        """
        return np.flatnonzero(self.vertex_part == self.names.index(name))


def skinning_parts(
    weights: Floats,
    rest_vertices: Floats,
    rest_joints: Floats,
    faces: Integers,
) -> BodyParts:
    """The 21 parts :data:`PART_NAMES` of a body at rest.

    Args:
        weights: ``(V, 55)`` skinning weights.
        rest_vertices: ``(V, 3)`` T-pose, y up, metres.
        rest_joints: ``(55, 3)``.
        faces: ``(F, 3)`` triangles, outward.
    """
    vertices = np.asarray(rest_vertices, dtype=np.float64)
    joints = np.asarray(rest_joints, dtype=np.float64)
    names = list(_GROUPS)
    pulls = np.stack([weights[:, list(group)].sum(axis=1) for group in _GROUPS.values()], axis=1)
    group_of = pulls.argmax(axis=1)
    forward = _forward(joints)
    taken = {
        "torso": vertex_normals(vertices, faces) @ forward < 0,
        "left": (vertices - (joints[7] + joints[10]) / 2) @ forward > 0,
        "right": (vertices - (joints[8] + joints[11]) / 2) @ forward > 0,
    }
    part = np.array([PART_NAMES.index(name) for name in names], dtype=np.int32)[group_of]
    for name, other in _CUT.items():
        side = taken.get(name.partition("_")[0], taken["torso"])
        part[(group_of == names.index(name)) & side] = PART_NAMES.index(other)
    return BodyParts(PART_NAMES, part)


UNLISTED = "unlisted"
"""The part of the vertices that no region of a region file holds; the last, there only if it is needed."""


def parts_from_regions(regions: Mapping[str, Sequence[int] | Integers], num_vertices: int) -> BodyParts:
    """Parts given as lists of vertices: a segmentation made for one body, as the 75 regions of SMPL-X.

    Every vertex gets a part, so that all that touches has a name: those in no region make a last part,
    :data:`UNLISTED`.

    Args:
        regions: vertex numbers by name; where regions share a vertex the later one keeps it.
        num_vertices: V of the body.

    Raises:
        ValueError: a vertex number does not exist on this body, or there is no region.
    """
    if not regions:
        raise ValueError("the region file names no region")
    part = np.full(num_vertices, -1, dtype=np.int32)
    for number, (name, listed) in enumerate(regions.items()):
        members = np.asarray(listed, dtype=np.int64)
        wrong = members[(members < 0) | (members >= num_vertices)]
        if wrong.size:
            raise ValueError(
                f"region {name!r} holds vertex {wrong[0]}, the body has {num_vertices}: "
                "the region file belongs to another body model"
            )
        part[members] = number
    if (part >= 0).all():
        return BodyParts(tuple(regions), part)
    if UNLISTED in regions:
        raise ValueError(f"a region is called {UNLISTED!r}, the name of what no region holds: rename it")
    part[part < 0] = len(regions)
    return BodyParts((*regions, UNLISTED), part)


def _forward(joints: Float64s) -> Float64s:
    """Unit vector a body at rest faces: level, from the ankles to the balls of the feet."""
    direction = (joints[[10, 11]] - joints[[7, 8]]).mean(axis=0)
    direction[1] = 0.0
    forward: Float64s = direction / np.linalg.norm(direction)
    return forward
