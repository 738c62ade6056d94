"""A first guess of the body from landmarks: the trunk by its axes, the limbs by their directions, depth by
size."""

import numpy as np
from scipy.spatial.transform import Rotation

from whacamole.baseline.estimators.body_points import HIPS, SHOULDERS
from whacamole.baseline.estimators.fit_model import FITTED, FitState
from whacamole.baseline.rigid import FloatArray
from whacamole.body import JOINT_INDEX, NUM_BETAS, BodyModel

_LIMBS = (
    ("left_shoulder", "left_elbow", 11, 13), ("left_elbow", "left_wrist", 13, 15),
    ("right_shoulder", "right_elbow", 12, 14), ("right_elbow", "right_wrist", 14, 16),
    ("left_hip", "left_knee", 23, 25), ("left_knee", "left_ankle", 25, 27),
    ("right_hip", "right_knee", 24, 26), ("right_knee", "right_ankle", 26, 28),
)  # fmt: skip
"""Joint that turns, joint that it turns, and the landmarks of the two; upper limb before lower."""


def viewing_turn(center: FloatArray, K: FloatArray) -> FloatArray:
    """Rotations (T, 3, 3) from a camera that looks at pixels ``center`` (T, 2) to the camera itself.

    MediaPipe's metric landmarks are in the axes of the former: it sees a crop.
    """
    ray = np.concatenate([(center - K[:, :2, 2]) / K[:, [0, 1], [0, 1]], np.ones((len(center), 1))], axis=1)
    return _shortest(np.array([0.0, 0.0, 1.0]), ray)


def first_guess(metric: FloatArray, pixels: FloatArray, K: FloatArray, body: BodyModel) -> FitState:
    """The state from which the fit starts.

    Args:
        metric: (T, 33, 3) landmarks about the hips, in the camera's axes [m].
        pixels: (T, 33, 2).
        K: (T, 3, 3).
        body: at its mean shape.
    """
    rest = body.rest_joints(np.zeros(NUM_BETAS))
    orient = _trunk(metric)
    pose = np.zeros((len(metric), len(FITTED), 3))
    above: dict[str, FloatArray] = {}
    for joint, child, start, end in _LIMBS:
        parent = above.get(joint, orient)
        bone = rest[JOINT_INDEX[child]] - rest[JOINT_INDEX[joint]]
        wanted = np.einsum("tji,tj->ti", parent, metric[:, end] - metric[:, start])
        turn = _shortest(bone, wanted)
        pose[:, FITTED.index(joint)] = Rotation.from_matrix(turn).as_rotvec()
        above[child] = parent @ turn
    hips = rest[[JOINT_INDEX["left_hip"], JOINT_INDEX["right_hip"]]].mean(axis=0) - rest[0]
    pelvis = _place(metric, pixels, K) - orient @ hips
    return FitState(pelvis, orient, pose, np.zeros(NUM_BETAS))


def _trunk(metric: FloatArray) -> FloatArray:
    """Root orientation (T, 3, 3): columns left, up and forward of the trunk."""
    hips, shoulders = (metric[:, list(pair)] for pair in (HIPS, SHOULDERS))
    up = _unit(shoulders.mean(axis=1) - hips.mean(axis=1))
    left = _unit(hips[:, 0] - hips[:, 1]) + _unit(shoulders[:, 0] - shoulders[:, 1])
    left = _unit(left - (left * up).sum(axis=-1, keepdims=True) * up)
    return np.stack([left, up, np.cross(left, up)], axis=-1)


def _place(metric: FloatArray, pixels: FloatArray, K: FloatArray) -> FloatArray:
    """Where the hips are (T, 3) [m] so that the metric landmarks project to the pixels, by linear least
    squares.

    (u − c) (z + t_z) = f (x + t_x): the perspective form of t_z = (2 / I) (f / s).
    """
    ray = (pixels - K[:, None, :2, 2]) / K[:, None, [0, 1], [0, 1]]
    T, N = ray.shape[:2]
    A = np.zeros((T, N, 2, 3))
    A[..., 0, 0] = A[..., 1, 1] = 1.0
    A[..., 2] = -ray
    b = ray * metric[..., 2:] - metric[..., :2]
    A, b = A.reshape(T, -1, 3), b.reshape(T, -1, 1)
    turned = np.swapaxes(A, -1, -2)
    place = np.linalg.solve(turned @ A + 1e-9 * np.eye(3), turned @ b)[..., 0]
    place[:, 2] = np.maximum(place[:, 2], 0.5)
    return place


def _shortest(vector: FloatArray, wanted: FloatArray) -> FloatArray:
    """The shortest rotations (T, 3, 3) that bring ``vector`` (3,) into the directions ``wanted`` (T, 3)."""
    a, b = _unit(vector[None]), _unit(wanted)
    axis = np.cross(a, b)
    sine = np.linalg.norm(axis, axis=-1, keepdims=True)
    angle = np.arctan2(sine, (a * b).sum(axis=-1, keepdims=True))
    turned: FloatArray = Rotation.from_rotvec(axis / np.maximum(sine, 1e-12) * angle).as_matrix()
    return turned


def _unit(vectors: FloatArray) -> FloatArray:
    unit: FloatArray = vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-12)
    return unit
