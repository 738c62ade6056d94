"""Errors of a body in the camera's frame, and its motion."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from whacamole.evaluation.core.alignment import FloatArray, align

IntArray = npt.NDArray[np.intp]

MILLIMETRES = 1000.0


def distances(prediction: FloatArray, truth: FloatArray) -> FloatArray:
    """‖prediction − truth‖ of points (…, 3) [m] → (…) [m]."""
    apart = prediction - truth
    np.square(apart, out=apart)
    squared: FloatArray = apart @ np.ones(3, apart.dtype)  # a product: sums over an axis of 3 are slow
    return np.sqrt(squared, out=squared)


def point_error(prediction: FloatArray, truth: FloatArray) -> FloatArray:
    """Mean distance of N points a frame, no alignment: (F, N, 3) [m] → (F,) [mm].

    T-MPJPE and T-PVE of WHAC (arXiv 2403.12959, section 5): joints or vertices in the camera's frame.
    """
    mean: FloatArray = distances(prediction, truth).mean(axis=-1)
    return mean * MILLIMETRES


def root_aligned_error(
    prediction: FloatArray, truth: FloatArray, root_prediction: FloatArray, root_truth: FloatArray
) -> FloatArray:
    """MPJPE, or PVE for vertices: :func:`point_error` with each root (F, 3) [m] moved to 0 → (F,) [mm]."""
    return point_error(prediction - root_prediction[:, None], truth - root_truth[:, None])


def procrustes_error(prediction: FloatArray, truth: FloatArray) -> FloatArray:
    """PA-MPJPE, PA-PVE: :func:`point_error` after the best similarity of each frame → (F,) [mm].

    With the points of two people concatenated it is Pair-PA-MPJPE.
    """
    return point_error(align(prediction, truth), truth)


def second_difference(points: FloatArray) -> FloatArray:
    """x[i−1] − 2 x[i] + x[i+1] of (F, …) for i = 1 … F − 2."""
    difference: FloatArray = points[:-2] - 2.0 * points[1:-1] + points[2:]
    return difference


def acceleration_error(
    prediction: FloatArray, truth: FloatArray, fps: float, frames: IntArray, trim: int = 0
) -> FloatArray:
    """Accel: mean joint ‖a − a_truth‖, a = (x[i−1] − 2 x[i] + x[i+1]) · fps² → (F,) [m/s²].

    Args:
        prediction, truth: joints (F, J, 3) [m], root aligned.
        frames: (F,) time index of each row; only three rows in immediate succession give a value.
        trim: values dropped at each end of the sequence (WHAM and TRAM: 1).

    Returns:
        The value of row i at i; NaN where there is none.
    """
    result = np.full(len(prediction), np.nan)
    if len(prediction) > 2:
        apart = second_difference(prediction) - second_difference(truth)
        values = np.linalg.norm(apart, axis=-1).mean(axis=-1) * fps**2
        result[1:-1] = np.where(_successive(frames, 3), values, np.nan)
    if trim:
        result[: trim + 1] = np.nan
        result[len(result) - trim - 1 :] = np.nan
    return result


def jitter(points: FloatArray, fps: float, frames: IntArray, ignored: Sequence[int] = ()) -> FloatArray:
    """Mean joint jerk ‖x[i+3] − 3 x[i+2] + 3 x[i+1] − x[i]‖ · fps³ / 10 of a prediction → (F,) [10 m/s³].

    Args:
        points: joints (F, J, 3) [m] in the world.
        frames: (F,) time index; only four rows in immediate succession give a value.
        ignored: joints that count as still but stay in the mean over J (EMDB's own script).

    Returns:
        The value of rows i … i + 3 at i; NaN where there is none.
    """
    result = np.full(len(points), np.nan)
    if len(points) > 3:
        third = points[3:] - 3.0 * points[2:-1] + 3.0 * points[1:-2] - points[:-3]
        size = np.linalg.norm(third, axis=-1)
        size[:, list(ignored)] = 0.0
        result[:-3] = np.where(_successive(frames, 4), size.mean(axis=-1) * fps**3 / 10.0, np.nan)
    return result


def _successive(frames: IntArray, count: int) -> npt.NDArray[np.bool_]:
    """Whether rows i … i + count − 1 are frames in immediate succession, for every i that has them."""
    return np.asarray(frames[count - 1 :] - frames[: len(frames) - count + 1] == count - 1)


def joint_angle_error(prediction: FloatArray, truth: FloatArray) -> FloatArray:
    """MPJAE: mean geodesic angle between rotations (F, K, 3, 3), arccos((tr(R Rᵀ) − 1) / 2) → (F,) [degrees].

    EMDB's ``evaluation_metrics.py``: global rotations of nine joints. The angle is taken as
    2 arcsin(‖R − R_truth‖ / (2 √2)), the same number without the loss of digits near zero.
    """
    chord = np.linalg.norm(prediction - truth, axis=(-2, -1)) / np.sqrt(8.0)
    angles: FloatArray = np.degrees(2.0 * np.arcsin(np.clip(chord, 0.0, 1.0)))
    return np.asarray(angles.mean(axis=-1))
