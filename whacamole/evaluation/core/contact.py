"""Contact as detection: counts that add up over frames and sequences."""

import numpy as np
import numpy.typing as npt

from whacamole.evaluation.core.alignment import FloatArray
from whacamole.evaluation.core.world import IntArray, step_lengths

BoolArray = npt.NDArray[np.bool_]


def standing(points: FloatArray, frames: IntArray, still: float) -> tuple[BoolArray, BoolArray]:
    """Label foot points (F, K, 3) [m] that move less than ``still`` [m] to the next frame as in contact
    (JOSH).

    Returns:
        Labels (F, K) and whether there is a next frame to tell by (F, K).
    """
    steps = step_lengths(points, frames)
    return steps < still, np.isfinite(steps)


def detection_counts(
    prediction: BoolArray, truth: BoolArray, counted: BoolArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """True positives, false positives, false negatives a frame: labels (F, K) → three of (F,)."""
    hit = prediction & truth & counted
    false_alarm = prediction & ~truth & counted
    miss = ~prediction & truth & counted
    tp, fp, fn = (np.sum(x, axis=1, dtype=np.float64) for x in (hit, false_alarm, miss))
    return tp, fp, fn


def ratios(counts: tuple[FloatArray, FloatArray, FloatArray]) -> dict[str, tuple[FloatArray, FloatArray]]:
    """Precision, recall and F1 a frame with the weights by which they pool exactly.

    Precision = TP / (TP + FP), recall = TP / (TP + FN), F1 = 2 TP / (2 TP + FP + FN) [0 … 1]: each is a
    fraction and its denominator the weight, so a weighted mean over frames is the ratio of their counts.
    """
    tp, fp, fn = counts
    parts = {"precision": (tp, tp + fp), "recall": (tp, tp + fn), "f1": (2.0 * tp, 2.0 * tp + fp + fn)}
    return {name: (top / np.maximum(bottom, 1.0), bottom) for name, (top, bottom) in parts.items()}
