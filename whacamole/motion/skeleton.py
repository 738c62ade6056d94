"""A nominal adult skeleton in SMPL-X order: finds ground and up axis before any body model is known."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from whacamole.motion.data import FloatArray

# name, parent, rest position [m] of a person 1.7 m tall: y up, facing +z, pelvis where SMPL-X has it.
_BODY: tuple[tuple[str, int, tuple[float, float, float]], ...] = (
    ("pelvis", -1, (0.0, -0.351, 0.012)),
    ("left_hip", 0, (0.095, -0.424, -0.012)),
    ("right_hip", 0, (-0.095, -0.424, -0.012)),
    ("spine1", 0, (0.0, -0.246, -0.028)),
    ("left_knee", 1, (0.115, -0.830, -0.026)),
    ("right_knee", 2, (-0.115, -0.830, -0.026)),
    ("spine2", 3, (0.0, -0.117, -0.033)),
    ("left_ankle", 4, (0.115, -1.253, -0.053)),
    ("right_ankle", 5, (-0.115, -1.253, -0.053)),
    ("spine3", 6, (0.0, -0.046, -0.037)),
    ("left_foot", 7, (0.119, -1.298, 0.082)),
    ("right_foot", 8, (-0.119, -1.298, 0.082)),
    ("neck", 9, (0.0, 0.134, -0.006)),
    ("left_collar", 9, (0.046, 0.041, 0.010)),
    ("right_collar", 9, (-0.046, 0.041, 0.010)),
    ("head", 12, (0.0, 0.252, 0.015)),
    ("left_shoulder", 13, (0.176, 0.072, 0.006)),
    ("right_shoulder", 14, (-0.176, 0.072, 0.006)),
    ("left_elbow", 16, (0.416, 0.023, -0.025)),
    ("right_elbow", 17, (-0.416, 0.023, -0.025)),
    ("left_wrist", 18, (0.657, 0.032, -0.034)),
    ("right_wrist", 19, (-0.657, 0.032, -0.034)),
)

JOINT_NAMES = tuple(name for name, _, _ in _BODY)
PARENTS = tuple(parent for _, parent, _ in _BODY)
REST_JOINTS: FloatArray = np.array([rest for _, _, rest in _BODY])

# Points of the surface that may touch the ground: (joint, offset in the rest pose, radius) [m].
_TOUCH: tuple[tuple[str, tuple[float, float, float], float], ...] = (
    *((f"{side}_ankle", (0.0, -0.072, -0.045), 0.0) for side in ("left", "right")),  # heel
    *((f"{side}_foot", (0.0, -0.027, -0.01), 0.0) for side in ("left", "right")),  # ball
    *((f"{side}_foot", (0.0, -0.022, 0.05), 0.0) for side in ("left", "right")),  # toe tip
    *((f"{side}_knee", (0.0, 0.0, 0.02), 0.05) for side in ("left", "right")),
    *((f"{side}_elbow", (0.0, 0.0, 0.0), 0.04) for side in ("left", "right")),
    *((f"{side}_wrist", (0.0, 0.0, 0.0), 0.03) for side in ("left", "right")),
    ("left_wrist", (0.18, 0.0, 0.0), 0.01),  # fingertips
    ("right_wrist", (-0.18, 0.0, 0.0), 0.01),
    ("pelvis", (0.0, -0.06, -0.02), 0.10),
    ("spine1", (0.0, 0.0, 0.02), 0.10),
    ("spine3", (0.0, 0.05, 0.02), 0.12),
    ("head", (0.0, 0.06, 0.03), 0.10),
    # The sole's corners, for a foot on its edge, and the little finger, for a hand on its edge.
    *((f"{side}_ankle", (x, -0.07, -0.03), 0.0) for side in ("left", "right") for x in (-0.028, 0.028)),
    *((f"{side}_foot", (x, -0.025, 0.0), 0.0) for side in ("left", "right") for x in (-0.038, 0.038)),
    ("left_wrist", (0.14, 0.0, -0.05), 0.01),
    ("right_wrist", (-0.14, 0.0, -0.05), 0.01),
)
TOUCH_RADII: FloatArray = np.array([radius for _, _, radius in _TOUCH])

SOURCE_REST_PELVIS: dict[str, tuple[float, float, float]] = {
    # Rest pelvis j0 of the neutral mean shapes [m]. Betas move it by at most a few centimetres.
    "smpl": (-0.0018, -0.2233, 0.0282),
    "smplh": (-0.0018, -0.2233, 0.0282),
    "smplx": (0.0031, -0.3514, 0.0120),
}


def forward(
    global_orient: FloatArray, body_pose: FloatArray, pelvis: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """World position and rotation of the 22 body joints of the nominal skeleton.

    ``global_orient (T,3)``, ``body_pose (T,21,3)`` axis-angle; ``pelvis (T,3)`` world position of the
    pelvis joint [m]. Returns ``joints (T,22,3)`` [m] and ``rotations (T,22,3,3)``.
    """
    T = len(pelvis)
    local = Rotation.from_rotvec(
        np.concatenate([global_orient[:, None], body_pose], axis=1).reshape(-1, 3)
    ).as_matrix()
    local = local.reshape(T, len(_BODY), 3, 3)
    joints = np.empty((T, len(_BODY), 3))
    rotations = np.empty((T, len(_BODY), 3, 3))
    joints[:, 0], rotations[:, 0] = pelvis, local[:, 0]
    for j in range(1, len(_BODY)):
        parent = PARENTS[j]
        rotations[:, j] = rotations[:, parent] @ local[:, j]
        joints[:, j] = joints[:, parent] + rotations[:, parent] @ (REST_JOINTS[j] - REST_JOINTS[parent])
    return joints, rotations


def touch_points(joints: FloatArray, rotations: FloatArray) -> FloatArray:
    """Points that may touch the ground, ``(T,C,3)`` [m]; each is the centre of a ball of ``TOUCH_RADII[c]``.

    Takes the result of :func:`forward`.
    """
    index = [JOINT_NAMES.index(name) for name, _, _ in _TOUCH]
    offset = np.array([point for _, point, _ in _TOUCH])
    points: FloatArray = joints[:, index] + np.einsum("tcij,cj->tci", rotations[:, index], offset)
    return points
