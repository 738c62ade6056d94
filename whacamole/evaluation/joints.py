"""Joint sets: which joints of which body are compared."""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from whacamole.evaluation.core.alignment import FloatArray
from whacamole.evaluation.protocol import JointSet
from whacamole.evaluation.records import BodyKind, IntArray

_BODY22 = tuple(range(22))
_SETS: Mapping[tuple[JointSet, BodyKind], tuple[int, ...]] = MappingProxyType(
    {
        # SMPL's hand joints 22 and 23 sit at the knuckles: the first joint of the middle finger elsewhere.
        ("smpl24", "smpl"): tuple(range(24)),
        ("smpl24", "smplh"): (*_BODY22, 25, 40),
        ("smpl24", "smplx"): (*_BODY22, 28, 43),
    }
)
_BODY15 = (0, 1, 2, 4, 5, 7, 8, 12, 15, 16, 17, 18, 19, 20, 21)

H36M14 = (6, 5, 4, 1, 2, 3, 16, 15, 14, 11, 12, 13, 8, 10)
"""The 14 joints of 3DPW tables among the 17 of ``J_regressor_h36m.npy`` (SPIN, WHAM, GVHMR)."""

MPJAE_JOINTS = (0, 1, 2, 4, 5, 16, 17, 18, 19)
"""The nine joints of EMDB's angle errors: pelvis, hips, knees, shoulders, elbows."""

STILL_JOINTS = (0, 7, 8, 10, 11, 20, 21, 22, 23)
"""The nine joints that EMDB's script sets to zero before it takes the jitter."""


def common_set(wanted: JointSet, kinds: tuple[BodyKind, BodyKind]) -> tuple[JointSet, str | None]:
    """The set that two bodies can be compared on, and a note if it is not the one wanted."""
    if wanted == "smpl24" and "smpl" in kinds and kinds[0] != kinds[1]:
        return "body22", f"smpl24 on the 22 body joints: {kinds[0]} and {kinds[1]} have other hand joints"
    return wanted, None


def joint_rows(joint_set: JointSet, kind: BodyKind) -> IntArray:
    """Which of a body's joints make up a set (not ``h36m14``, which is regressed from vertices)."""
    if joint_set == "body15":
        return np.array(_BODY15)
    return np.array(_SETS.get((joint_set, kind), _BODY22))


def root_of(joints: FloatArray, joint_set: JointSet, root: str) -> FloatArray:
    """The point (F, 3) that root alignment subtracts, of joints (F, K, 3) of a set."""
    if root == "pelvis" and joint_set != "h36m14":
        return joints[:, 0]
    hips = [2, 3] if joint_set == "h36m14" else [1, 2]  # the hips come first in every other set
    return np.asarray(joints[:, hips].mean(axis=1))


def still_joints(joint_set: JointSet) -> tuple[int, ...]:
    """EMDB's nine joints as rows of a set."""
    rows = _BODY15 if joint_set == "body15" else tuple(range(24))
    count = {"body15": 15, "body22": 22, "smpl24": 24, "h36m14": 0}[joint_set]
    return tuple(i for i, joint in enumerate(rows[:count]) if joint in STILL_JOINTS)
