"""Errors of a person's path and motion in the world."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from whacamole.evaluation.core.alignment import FloatArray, align, spread, umeyama
from whacamole.evaluation.core.pose import MILLIMETRES, distances, point_error

IntArray = npt.NDArray[np.intp]

STATIC_SPREAD = 0.05
"""A path closer to its mean than this (root mean square, [m]) has no scale to be aligned by."""

STATIC_PATH = 0.10
"""A path shorter than this [m] is no denominator for RTE."""

_ROUNDING = 1e-12
"""Share of a path's numbers below which its spread is no motion."""


def segment_error(
    prediction: FloatArray,
    truth: FloatArray,
    rows: list[IntArray],
    *,
    fit_frames: int | None,
    with_scale: bool,
) -> FloatArray:
    """W-MPJPE and WA-MPJPE: mean joint distance after one alignment a segment → (F,) [mm].

    Args:
        prediction, truth: joints (F, J, 3) [m] in their worlds.
        rows: the rows of each segment (:func:`~whacamole.evaluation.core.segments.rows_of_segments`).
        fit_frames: the alignment is found on the first so many frames of the segment (W: 2), ``None`` on all
            (WA).
        with_scale: a similarity, or a rigid motion.

    Returns:
        NaN for rows in no segment.
    """
    result = np.full(len(prediction), np.nan)
    for segment in rows:
        fit = segment[:fit_frames]
        found = umeyama(prediction[fit].reshape(-1, 3), truth[fit].reshape(-1, 3), with_scale=with_scale)
        moved = found.apply(prediction[segment].reshape(-1, 3)).reshape(len(segment), -1, 3)
        result[segment] = point_error(moved, truth[segment])
    return result


def root_translation_error(prediction: FloatArray, truth: FloatArray) -> FloatArray | None:
    """RTE: distance of the root after one rigid alignment of the whole path, by the length of the true path.

    100 · ‖truth − (R prediction + t)‖ / Σ ‖truth[i+1] − truth[i]‖, roots (F, 3) [m] → (F,) [%]. ``None`` for
    a person who goes less than :data:`STATIC_PATH`: there is no path to divide by.
    """
    length = float(np.linalg.norm(np.diff(truth, axis=0), axis=-1).sum())
    if length < STATIC_PATH:
        return None
    return distances(align(prediction, truth, with_scale=False), truth) / length * 100.0


@dataclass(frozen=True, eq=False)
class PathError:
    """How far a path is from the true one after one alignment of the whole.

    Attributes:
        error: (F,) [mm].
        scale: s of s · prediction ≈ truth, the alignment scale AS from prediction to truth; 1 when rigid, NaN
            for a prediction that does not move.
        aligned: (F, 3) [m], the prediction where it was compared.
    """

    error: FloatArray
    scale: float
    aligned: FloatArray

    @property
    def mean(self) -> float:
        """ATE as the mean [mm]."""
        return float(self.error.mean())

    @property
    def rmse(self) -> float:
        """ATE as the root mean square [mm]."""
        return float(np.sqrt(np.mean(self.error**2)))


def path_error(prediction: FloatArray, truth: FloatArray, *, with_scale: bool = True) -> PathError | None:
    """H-ATE and H-AS for a root, C-ATE and C-AS for a camera centre: paths (F, 3) [m].

    ``None`` for a true path that stays in place (:data:`STATIC_SPREAD`): it has no scale to be aligned to.
    With scale, a predicted path that does not move at all is compared at the mean of the true one, where
    every scale puts it; its own scale is NaN.
    """
    if len(truth) < 2 or spread(truth) < STATIC_SPREAD:
        return None
    if with_scale and spread(prediction) <= _ROUNDING * (1.0 + float(np.abs(prediction).max())):
        middle = np.broadcast_to(truth.mean(axis=0), truth.shape)
        return PathError(distances(middle, truth) * MILLIMETRES, float("nan"), middle)
    found = umeyama(prediction, truth, with_scale=with_scale)
    aligned = found.apply(prediction)
    return PathError(distances(aligned, truth) * MILLIMETRES, float(found.scale), aligned)


def egocentric_velocity_error(
    prediction: FloatArray,
    truth: FloatArray,
    orient_prediction: FloatArray,
    orient_truth: FloatArray,
    frames: IntArray,
) -> FloatArray:
    """ERVE of TRAM: ‖R_truth R_predictionᵀ v − v_truth‖, v = x[i+1] − x[i] of the root → (F,) [mm a frame].

    Args:
        prediction, truth: root joint (F, 3) [m] in their worlds.
        orient_prediction, orient_truth: root orientation (F, 3, 3) in the same worlds.
        frames: (F,) time index; only rows in immediate succession give a value.
    """
    result = np.full(len(truth), np.nan)
    turn = orient_truth @ np.swapaxes(orient_prediction, -1, -2)
    velocity = np.einsum("fij,fj->fi", turn[:-1], np.diff(prediction, axis=0))
    apart = distances(velocity, np.diff(truth, axis=0)) * MILLIMETRES
    result[:-1] = np.where(np.diff(frames) == 1, apart, np.nan)
    return result


def step_lengths(points: FloatArray, frames: IntArray) -> FloatArray:
    """‖x[i+1] − x[i]‖ of (F, K, 3) [m] at row i → (F, K) [m]; NaN at the last row and across gaps."""
    result = np.full(points.shape[:2], np.nan)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=-1)
    result[:-1] = np.where((np.diff(frames) == 1)[:, None], steps, np.nan)
    return result


def foot_sliding(
    prediction: FloatArray, truth: FloatArray, frames: IntArray, still: float
) -> tuple[FloatArray, FloatArray]:
    """FS: how far predicted foot points move while the true ones stand (WHAM).

    Args:
        prediction, truth: foot points (F, K, 3) [m] in their worlds.
        frames: (F,) time index.
        still: a true point that moves less than this a frame [m] stands.

    Returns:
        Mean predicted step over the standing points (F,) [mm], 0 where none stands, and their number (F,).
    """
    steps = step_lengths(prediction, frames)
    standing = step_lengths(truth, frames) < still  # NaN compares false: no step, no contact
    count = standing.sum(axis=1)
    total = np.where(standing, steps, 0.0).sum(axis=1) * MILLIMETRES
    return total / np.maximum(count, 1), count.astype(np.float64)
