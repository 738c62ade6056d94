"""Relative pose error of a camera path (Sturm et al., IROS 2012)."""

import numpy as np
import numpy.typing as npt

from whacamole.evaluation.core.alignment import FloatArray
from whacamole.evaluation.core.pose import MILLIMETRES

IntArray = npt.NDArray[np.intp]


def relative_pose_error(
    prediction: FloatArray, truth: FloatArray, frames: IntArray, delta: int = 1
) -> tuple[FloatArray, FloatArray]:
    """RPE: E = (Q[i]⁻¹ Q[i+δ])⁻¹ (P[i]⁻¹ P[i+δ]) with truth Q and prediction P, camera to world (F, 4, 4).

    No alignment is needed, and none is made: a wrong scale shows in the translation.

    Args:
        prediction, truth: poses (F, 4, 4), translations in metres.
        frames: (F,) time index; rows i and i + δ count if they are δ frames apart.
        delta: δ [frames].

    Returns:
        ‖translation of E‖ (F,) [mm] and angle of E (F,) [degrees], at row i; NaN where there is none.
    """
    translation, rotation = np.full(len(truth), np.nan), np.full(len(truth), np.nan)
    if len(truth) <= delta:
        return translation, rotation
    step_truth = _inverse(truth[:-delta]) @ truth[delta:]
    step_prediction = _inverse(prediction[:-delta]) @ prediction[delta:]
    error = _inverse(step_truth) @ step_prediction
    counted = frames[delta:] - frames[:-delta] == delta
    size = np.linalg.norm(error[:, :3, 3], axis=-1) * MILLIMETRES
    translation[:-delta] = np.where(counted, size, np.nan)
    rotation[:-delta] = np.where(counted, _angle(error[:, :3, :3]), np.nan)
    return translation, rotation


def _inverse(T: FloatArray) -> FloatArray:
    """Inverse of rigid transforms (F, 4, 4)."""
    result = np.zeros_like(T)
    turned = np.swapaxes(T[:, :3, :3], -1, -2)
    result[:, :3, :3] = turned
    result[:, :3, 3] = -np.einsum("fij,fj->fi", turned, T[:, :3, 3])
    result[:, 3, 3] = 1.0
    return result


def _angle(R: FloatArray) -> FloatArray:
    """Angle of rotations (F, 3, 3) [degrees], exact also near 0 where the arccos of the trace is not."""
    skew = np.stack([R[:, 2, 1] - R[:, 1, 2], R[:, 0, 2] - R[:, 2, 0], R[:, 1, 0] - R[:, 0, 1]], axis=-1)
    sine = np.linalg.norm(skew, axis=-1)
    cosine = np.trace(R, axis1=-2, axis2=-1) - 1.0
    return np.asarray(np.degrees(np.arctan2(sine, cosine)))
