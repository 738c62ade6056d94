"""The body as the fit sees it: where points are, and how they move with pose, root and place."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from whacamole.baseline.estimators.body_points import BodyPoints
from whacamole.baseline.rigid import FloatArray
from whacamole.body import JOINT_INDEX, NUM_JOINTS, PARENTS
from whacamole.body.skinning import forward_kinematics

_BOTH: Mapping[str, tuple[tuple[float, float, float], tuple[float, float, float]]] = {
    "hip": ((-0.2, 0.0, 0.0), (0.7, 0.3, 0.3)),
    "knee": ((0.4, 0.0, 0.0), (0.7, 0.1, 0.1)),
    "ankle": ((0.0, 0.0, 0.0), (0.3, 0.2, 0.2)),
    "collar": ((0.0, 0.0, 0.0), (0.1, 0.15, 0.15)),
    "shoulder": ((0.0, 0.0, -0.9), (0.5, 0.6, 0.7)),
    "elbow": ((0.0, -0.5, 0.0), (0.3, 0.8, 0.3)),
    "wrist": ((0.0, 0.0, 0.0), (0.3, 0.3, 0.3)),
}
"""Mean and standard deviation of a joint's rotation vector [rad], of the left side."""

_MIDDLE: Mapping[str, float] = {"spine1": 0.2, "spine2": 0.1, "spine3": 0.1, "neck": 0.25, "head": 0.25}
"""Standard deviation about rest of the joints in the middle."""

FITTED: tuple[str, ...] = (*_MIDDLE, *(f"{side}_{name}" for side in ("left", "right") for name in _BOTH))
"""Joints that the fit turns; the others stay at rest."""

NUM_UNKNOWNS = 6 + 3 * len(FITTED)
"""Of a frame: the pelvis, the root's turn, the joints' rotation vectors."""

_ROWS = np.array([JOINT_INDEX[name] for name in FITTED], dtype=np.intp)


def prior() -> tuple[FloatArray, FloatArray]:
    """Mean and standard deviation (19, 3) of the rotation vectors of :data:`FITTED`."""
    mean, spread = np.zeros((len(FITTED), 3)), np.ones((len(FITTED), 3))
    for row, name in enumerate(FITTED):
        side, _, part = name.rpartition("_")
        if part in _BOTH:
            # In the mirror, turns about x keep their sign and those about y and z change it.
            sign = np.array([1.0, 1.0, 1.0] if side == "left" else [1.0, -1.0, -1.0])
            mean[row], spread[row] = sign * _BOTH[part][0], _BOTH[part][1]
        else:
            spread[row] = _MIDDLE[name]
    return mean, spread


@dataclass(frozen=True, eq=False)
class FitState:
    """A person over T frames.

    Attributes:
        pelvis: (T, 3) in the camera frame [m].
        orient: (T, 3, 3).
        pose: (T, 19, 3) rotation vectors of :data:`FITTED`.
        betas: (10,).
    """

    pelvis: FloatArray
    orient: FloatArray
    pose: FloatArray
    betas: FloatArray

    def moved(self, step: FloatArray) -> "FitState":
        """The state after a step (T, :data:`NUM_UNKNOWNS`)."""
        turn = Rotation.from_rotvec(step[:, 3:6]).as_matrix()
        return replace(
            self,
            pelvis=self.pelvis + step[:, :3],
            orient=self.orient @ turn,
            pose=self.pose + step[:, 6:].reshape(self.pose.shape),
        )

    def body_pose(self) -> FloatArray:
        """(T, 21, 3), joints that are not fitted at rest."""
        whole = np.zeros((len(self.pelvis), 21, 3))
        whole[:, _ROWS - 1] = self.pose
        return whole


def place_points(state: FitState, points: BodyPoints, rest: FloatArray) -> FloatArray:
    """Points (T, N, 3) in the camera frame [m]; ``rest`` (55, 3) are the joints of the shape at rest."""
    turned, joints = _chain(state, rest)
    return _points(points, turned, joints)


def linearise(state: FitState, points: BodyPoints, rest: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Points (T, N, 3) and how they move with the unknowns (T, N, 3, :data:`NUM_UNKNOWNS`).

    A point p that hangs on joint k moves by ω × (p − k) under a small turn ω of that joint; a change of k's
    rotation vector x turns it by G_k J_r(x) dx, with k's global rotation G_k and the right Jacobian J_r of
    the exponential.
    """
    turned, joints = _chain(state, rest)
    placed = _points(points, turned, joints)
    T, N = placed.shape[:2]
    moves = np.zeros((T, N, 3, NUM_UNKNOWNS))
    moves[..., :3] = np.eye(3)
    moves[..., 3:6] = _turned_about(turned[:, 0], joints[:, 0], placed)
    hanging = _hanging(points.joints)
    J_r = right_jacobian(state.pose.reshape(-1, 3)).reshape(T, len(FITTED), 3, 3)
    for row, joint in enumerate(_ROWS):
        mine = hanging[joint]
        column = 6 + 3 * row
        axes = turned[:, joint] @ J_r[:, row]
        moves[:, mine, :, column : column + 3] = _turned_about(axes, joints[:, joint], placed[:, mine])
    return placed, moves


def right_jacobian(vectors: FloatArray) -> FloatArray:
    """J_r (n, 3, 3): exp(x + dx) ≈ exp(x) exp(J_r(x) dx), for rotation vectors (n, 3)."""
    angle = np.linalg.norm(vectors, axis=-1)[:, None, None]
    safe = np.maximum(angle, 1e-6)
    x = np.zeros((len(vectors), 3, 3))
    x[:, [2, 0, 1], [1, 2, 0]] = vectors
    x[:, [1, 2, 0], [2, 0, 1]] = -vectors
    first = np.where(angle < 1e-4, 0.5, (1.0 - np.cos(safe)) / safe**2)
    second = np.where(angle < 1e-4, 1.0 / 6.0, (safe - np.sin(safe)) / safe**3)
    jacobian: FloatArray = np.eye(3) - first * x + second * (x @ x)
    return jacobian


def _chain(state: FitState, rest: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Global rotations and joints of every frame, the pelvis in its place."""
    T = len(state.pelvis)
    local = np.tile(np.eye(3), (T, NUM_JOINTS, 1, 1))
    local[:, 0] = state.orient
    turns = Rotation.from_rotvec(state.pose.reshape(-1, 3)).as_matrix()
    local[:, _ROWS] = turns.reshape(T, len(FITTED), 3, 3)
    turned, placed = forward_kinematics(local, rest[None])
    return turned, placed - rest[0] + state.pelvis[:, None]


def _points(points: BodyPoints, turned: FloatArray, joints: FloatArray) -> FloatArray:
    offsets = np.einsum("tnij,nj->tni", turned[:, points.joints], points.offsets)
    placed: FloatArray = joints[:, points.joints] + offsets
    return placed


def _turned_about(axes: FloatArray, joint: FloatArray, placed: FloatArray) -> FloatArray:
    """Columns a × (p − k) (T, n, 3, 3) for the columns a of ``axes`` (T, 3, 3)."""
    arm = placed - joint[:, None]
    columns = np.cross(np.swapaxes(axes, -1, -2)[:, None], arm[:, :, None])
    return np.swapaxes(columns, -1, -2)


def _hanging(owners: NDArray[np.intp]) -> dict[int, NDArray[np.intp]]:
    """For every joint the points that hang on it or on what hangs on it."""
    above: list[set[int]] = []
    for parent in PARENTS:
        above.append((above[parent] if parent >= 0 else set()) | {len(above)})
    return {joint: np.flatnonzero([joint in above[owner] for owner in owners]) for joint in range(NUM_JOINTS)}
