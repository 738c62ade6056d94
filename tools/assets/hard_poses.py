"""Poses that are hard on skin and clothes: what the audit measures and ``people_sheet.py --hard`` shows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

import numpy as np
from numpy.typing import NDArray

from whacamole.body import JOINT_INDEX

Turns = Mapping[str, tuple[float, float, float]]

_STRAIGHT: Final[Turns] = {"shoulder": (0, 0.1, -1.15), "elbow": (0, -0.25, 0)}

HARD_POSES: Final[Mapping[str, Turns]] = {
    "walk": {
        "left_hip": (-0.5, 0, 0), "right_hip": (0.35, 0, 0), "left_knee": (0.1, 0, 0),
        "right_knee": (0.6, 0, 0), "left_shoulder": (0, 0.4, -1.15),
        "right_shoulder": (0, 0.3, 1.15), "elbow": (0, -0.4, 0),
    },
    "sit": {"hip": (-1.5, 0, 0.1), "knee": (1.5, 0, 0), "shoulder": (0, -0.4, -1.0), "elbow": (0, -0.8, 0)},
    "squat": {
        "hip": (-2.0, 0.1, 0.3), "knee": (2.3, 0, 0), "ankle": (-0.4, 0, 0), "spine1": (0.3, 0, 0),
        "spine2": (0.2, 0, 0), "shoulder": (0, -1.2, -0.3), "elbow": (0, -0.3, 0),
    },
    "bend": {
        "hip": (-1.3, 0, 0), "spine1": (0.4, 0, 0), "spine2": (0.3, 0, 0), "spine3": (0.2, 0, 0),
        "shoulder": (0, -1.1, -0.5),
    },
    "arms up": {"collar": (0, 0, 0.2), "shoulder": (0, 0, 1.1)},
    "twist": {
        "spine1": (0, 0.3, 0), "spine2": (0, 0.3, 0), "spine3": (0, 0.3, 0), "neck": (0.1, 0.5, 0),
        "head": (0.1, 0.3, 0), **_STRAIGHT,
    },
    "crawl": {
        "hip": (-1.4, 0, 0.1), "knee": (1.5, 0, 0), "ankle": (0.5, 0, 0), "shoulder": (0, -1.4, -0.2),
        "wrist": (0, 0, 1.0), "neck": (-0.3, 0, 0), "head": (-0.3, 0, 0),
    },
    "folded arms": {"shoulder": (0.2, -0.7, -1.0), "elbow": (0, -1.9, 0)},
}  # fmt: skip
"""Rotation vectors [rad] by joint; a name without a side is the left joint's, mirrored on the right."""

LEAN: Final[Mapping[str, float]] = {"squat": 0.6, "bend": 1.4, "crawl": 1.4}
"""How far the pelvis leans forward from upright [rad]."""

_MIRROR: Final = np.array([1.0, -1.0, -1.0])


def hard_root(name: str) -> NDArray[np.float64]:
    """Root orientation ``(3,)`` in a world with z up."""
    return np.array([np.pi / 2 + LEAN.get(name, 0.0), 0.0, 0.0])


def hard_pose(name: str) -> NDArray[np.float64]:
    """Body pose ``(21, 3)`` of one of :data:`HARD_POSES`."""
    pose = np.zeros((21, 3))
    for joint, turn in HARD_POSES[name].items():
        if joint in JOINT_INDEX:
            pose[JOINT_INDEX[joint] - 1] = turn
        else:
            pose[JOINT_INDEX[f"left_{joint}"] - 1] = turn
            pose[JOINT_INDEX[f"right_{joint}"] - 1] = np.array(turn) * _MIRROR
    return pose
