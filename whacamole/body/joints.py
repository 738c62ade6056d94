"""The 55 joints of SMPL-X: names, tree, groups. One list for the whole project."""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

_FINGERS = tuple(
    f"{finger}{i}" for finger in ("index", "middle", "pinky", "ring", "thumb") for i in (1, 2, 3)
)

JOINT_NAMES: tuple[str, ...] = (
    "pelvis",
    "left_hip",
    "right_hip",
    "spine1",
    "left_knee",
    "right_knee",
    "spine2",
    "left_ankle",
    "right_ankle",
    "spine3",
    "left_foot",
    "right_foot",
    "neck",
    "left_collar",
    "right_collar",
    "head",
    "left_shoulder",
    "right_shoulder",
    "left_elbow",
    "right_elbow",
    "left_wrist",
    "right_wrist",
    "jaw",
    "left_eye",
    "right_eye",
    *(f"left_{name}" for name in _FINGERS),
    *(f"right_{name}" for name in _FINGERS),
)
"""Joint names in the order of the pose: root, body 21, jaw, eyes, left hand 15, right hand 15."""

NUM_JOINTS = len(JOINT_NAMES)
NUM_BODY_JOINTS = 21
NUM_HAND_JOINTS = 15
NUM_BETAS = 10
NUM_EXPRESSION = 10

JOINT_INDEX: Mapping[str, int] = MappingProxyType({name: i for i, name in enumerate(JOINT_NAMES)})


def _hand_parents(first: int, wrist: int) -> list[int]:
    """Three joints a finger in a row; each finger's first hangs on the wrist."""
    return [wrist if i % 3 == 0 else first + i - 1 for i in range(NUM_HAND_JOINTS)]


PARENTS: tuple[int, ...] = (
    *(-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19),
    *(15, 15, 15),
    *_hand_parents(25, JOINT_INDEX["left_wrist"]),
    *_hand_parents(40, JOINT_INDEX["right_wrist"]),
)
"""Parent of each joint; −1 for the root. A parent always comes before its children."""

JOINT_GROUPS: Mapping[str, tuple[int, ...]] = MappingProxyType(
    {
        "root": (0,),
        "body": tuple(range(1, 22)),
        "face": (22, 23, 24),
        "left_hand": tuple(range(25, 40)),
        "right_hand": tuple(range(40, 55)),
        "torso": tuple(JOINT_INDEX[n] for n in ("pelvis", "spine1", "spine2", "spine3")),
        "head": tuple(JOINT_INDEX[n] for n in ("neck", "head", "jaw", "left_eye", "right_eye")),
        "left_arm": tuple(JOINT_INDEX[f"left_{n}"] for n in ("collar", "shoulder", "elbow", "wrist")),
        "right_arm": tuple(JOINT_INDEX[f"right_{n}"] for n in ("collar", "shoulder", "elbow", "wrist")),
        "left_leg": tuple(JOINT_INDEX[f"left_{n}"] for n in ("hip", "knee", "ankle", "foot")),
        "right_leg": tuple(JOINT_INDEX[f"right_{n}"] for n in ("hip", "knee", "ankle", "foot")),
    }
)
"""Joints by part of the body. The first five cover the 55 once, in the order of the pose; the limbs, the
torso and the head together with the two hands cover them once as well."""


def _mirrored(name: str) -> str:
    side, _, rest = name.partition("_")
    return {"left": f"right_{rest}", "right": f"left_{rest}"}.get(side, name)


MIRROR_JOINTS: tuple[int, ...] = tuple(JOINT_INDEX[_mirrored(name)] for name in JOINT_NAMES)
"""The joint on the other side; a joint of the midline is its own."""


def tree_levels() -> tuple[tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]], ...]:
    """Joints below the root by depth, (joints, their parents) a level: one array operation does each."""
    depth = [0] * NUM_JOINTS
    for joint, parent in enumerate(PARENTS[1:], start=1):
        depth[joint] = depth[parent] + 1
    levels = []
    for level in range(1, max(depth) + 1):
        joints = np.array([j for j, d in enumerate(depth) if d == level], dtype=np.intp)
        levels.append((joints, np.array(PARENTS, dtype=np.intp)[joints]))
    return tuple(levels)
