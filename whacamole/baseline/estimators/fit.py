"""SMPL-X through landmarks: Gauss-Newton over all frames of a track at once.

Minimised: reprojection of the landmarks, their metric shape as MediaPipe has it, a prior on the joints, and
the acceleration of everything. What links frames reaches two frames far, so the normal equations are banded
and solved exactly. Landmarks that disagree lose their weight (Geman-McClure).
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import solveh_banded
from scipy.spatial.transform import Rotation

from whacamole.baseline.estimators.body_points import HIPS, BodyPoints
from whacamole.baseline.estimators.fit_model import NUM_UNKNOWNS, FitState, linearise, place_points, prior
from whacamole.baseline.rigid import FloatArray
from whacamole.body import NUM_BETAS, BodyModel


@dataclass(frozen=True)
class FitWeights:
    """Standard deviations.

    Attributes:
        pixel: of a landmark in the image, as a share of the person's size there.
        metric: of a landmark's place about the hips, across and along the view [m].
        pelvis, orient, pose: of an acceleration [m, rad, rad a frame²].
        robust: residuals of this many standard deviations count half.
        rounds: steps of Gauss-Newton.
        shape_from: round from which the shape is fitted too.
    """

    pixel: float = 0.012
    metric: tuple[float, float] = (0.05, 0.10)
    pelvis: float = 0.006
    orient: float = 0.03
    pose: float = 0.04
    robust: float = 3.0
    rounds: int = 14
    shape_from: int = 6


@dataclass(frozen=True, eq=False)
class Observations:
    """What the body is fitted to; frames in which nothing was seen have zero weights.

    Attributes:
        pixels: (T, N, 2) of the body's points.
        metric: (T, N, 3) about the middle of the hips, in the camera's axes [m].
        weight: (T, N), 0 to 1.
        size: (T,) of the person in the image [px].
        K: (T, 3, 3).
    """

    pixels: FloatArray
    metric: FloatArray
    weight: FloatArray
    size: FloatArray
    K: FloatArray


def fit_track(
    start: FitState,
    seen: Observations,
    points: BodyPoints,
    body: BodyModel,
    weights: FitWeights | None = None,
) -> FitState:
    """The body through a track, from a first guess."""
    by = weights or FitWeights()
    state = start
    for step in range(by.rounds):
        rest = body.rest_joints(state.betas)
        placed, moves = linearise(state, points, rest)
        H, g = _data_terms(placed, moves, seen, points, by)
        H, g = _add_prior(H, g, state)
        state = state.moved(_banded_step(H, g, state, by))
        if step >= by.shape_from:
            state = _fit_shape(state, seen, points, body, by)
    return state


def residuals(
    placed: FloatArray, seen: Observations, points: BodyPoints, by: FitWeights
) -> tuple[FloatArray, FloatArray]:
    """Residuals in standard deviations: of pixels (T, N, 2) and of metric places (T, N, 3)."""
    depth = np.maximum(placed[..., 2:], 0.1)
    projected = np.einsum("tij,tnj->tni", seen.K[:, :2, :2], placed[..., :2] / depth) + seen.K[:, None, :2, 2]
    pixel = (projected - seen.pixels) / (by.pixel * seen.size[:, None, None])
    metric = (placed - _hips(placed, points) - seen.metric) / _metric_spread(by)
    return pixel, metric


def _hips(placed: FloatArray, points: BodyPoints) -> FloatArray:
    middle: FloatArray = placed[:, np.isin(points.landmarks, HIPS)].mean(axis=1, keepdims=True)
    return middle


def _metric_spread(by: FitWeights) -> FloatArray:
    return np.array([by.metric[0], by.metric[0], by.metric[1]])


def _data_terms(
    placed: FloatArray, moves: FloatArray, seen: Observations, points: BodyPoints, by: FitWeights
) -> tuple[FloatArray, FloatArray]:
    """JᵀWJ (T, D, D) and JᵀWr (T, D) of both kinds of residuals."""
    pixel, metric = residuals(placed, seen, points, by)
    depth = np.maximum(placed[..., 2:], 0.1)
    projection = np.zeros((*placed.shape[:2], 2, 3))
    focal = seen.K[:, None, [0, 1], [0, 1]]
    projection[..., [0, 1], [0, 1]] = focal / depth
    projection[..., 2] = -focal * placed[..., :2] / depth**2
    projection /= by.pixel * seen.size[:, None, None, None]
    relative = moves - moves[:, np.isin(points.landmarks, HIPS)].mean(axis=1, keepdims=True)
    jacobians = (projection @ moves, relative / _metric_spread(by)[:, None])
    H = np.zeros((len(placed), NUM_UNKNOWNS, NUM_UNKNOWNS))
    g = np.zeros((len(placed), NUM_UNKNOWNS))
    for residual, jacobian in zip((pixel, metric), jacobians, strict=True):
        trust = seen.weight / (1.0 + (residual**2).sum(axis=-1) / by.robust**2) ** 2
        flat = jacobian.reshape(len(placed), -1, NUM_UNKNOWNS)
        weighted = (jacobian * trust[..., None, None]).reshape(flat.shape)
        H += np.swapaxes(weighted, -1, -2) @ flat
        g += np.einsum("trd,tr->td", weighted, residual.reshape(len(placed), -1))
    return H, g


def _add_prior(H: FloatArray, g: FloatArray, state: FitState) -> tuple[FloatArray, FloatArray]:
    mean, spread = prior()
    information = 1.0 / spread.ravel() ** 2
    pose = np.arange(6, NUM_UNKNOWNS)
    H[:, pose, pose] += information
    g[:, 6:] += information * (state.pose - mean).reshape(len(g), -1)
    H[:, np.arange(6), np.arange(6)] += 1e-3  # holds a frame without landmarks between its neighbours
    return H, g


def _banded_step(H: FloatArray, g: FloatArray, state: FitState, by: FitWeights) -> FloatArray:
    """Minus the solution of (H + smoothness) x = g + smoothness' slope, limited in length."""
    T, D = g.shape
    information = np.concatenate(
        [np.full(3, by.pelvis**-2.0), np.full(3, by.orient**-2.0), np.full(D - 6, by.pose**-2.0)]
    )
    second = np.diff(np.eye(T), 2, axis=0)  # (T − 2, T)
    smooth = second.T @ second
    slope = np.zeros((T, D))
    slope[:, :3] = smooth @ state.pelvis
    slope[:, 3:6] = second.T @ _turn_acceleration(state.orient)
    slope[:, 6:] = smooth @ state.pose.reshape(T, -1)
    band = np.zeros((2 * D + 1, T * D))
    for offset in range(D):
        rows = np.arange(D - offset)
        band[offset].reshape(T, D)[:, rows] = H[:, rows + offset, rows]
    for gap in range(3):
        coupled = np.zeros(T)
        coupled[: T - gap] = np.diagonal(smooth, -gap)
        band[gap * D].reshape(T, D)[:] += coupled[:, None] * information
    step = -solveh_banded(band, (g + slope * information).ravel(), lower=True).reshape(T, D)
    limit = np.concatenate([np.full(3, 1.0), np.full(D - 3, 0.5)])
    return np.clip(step, -limit, limit)


def _turn_acceleration(orient: FloatArray) -> FloatArray:
    """Differences (T − 2, 3) of the turns from frame to frame, as rotation vectors."""
    turns = Rotation.from_matrix(np.swapaxes(orient[:-1], -1, -2) @ orient[1:]).as_rotvec()
    return np.diff(turns, axis=0)


def _fit_shape(
    state: FitState, seen: Observations, points: BodyPoints, body: BodyModel, by: FitWeights
) -> FitState:
    """One step of the betas, a standard normal prior on them, every fifth frame."""
    every = slice(None, None, 5)
    part = FitState(state.pelvis[every], state.orient[every], state.pose[every], state.betas)
    few = Observations(*(getattr(seen, key)[every] for key in ("pixels", "metric", "weight", "size", "K")))
    before = _stacked(part, few, points, body, by)
    columns = []
    for axis in np.eye(NUM_BETAS):
        other = replace(part, betas=part.betas + 0.1 * axis)
        columns.append((_stacked(other, few, points, body, by) - before) / 0.1)
    J = np.stack(columns, axis=-1)
    trust = 1.0 / (1.0 + before**2 / by.robust**2) ** 2
    weight = trust * np.repeat(few.weight[..., None], 5, axis=-1).ravel()
    # Errors of neighbouring frames are one error: they count as one in fifteen frames.
    weight = weight / 3.0
    H = J.T @ (weight[:, None] * J) + np.eye(NUM_BETAS)
    step = np.linalg.solve(H, J.T @ (weight * before) + part.betas)
    return replace(state, betas=np.clip(state.betas - step, -3.0, 3.0))


def _stacked(
    state: FitState, seen: Observations, points: BodyPoints, body: BodyModel, by: FitWeights
) -> FloatArray:
    placed = place_points(state, points, body.rest_joints(state.betas))
    return np.concatenate(residuals(placed, seen, points, by), axis=-1).ravel()
