"""Contact as detection: counts, and ratios that pool exactly."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from whacamole.evaluation.core.contact import detection_counts, ratios, standing


def test_a_point_stands_while_it_moves_less_than_the_limit():
    points = np.zeros((4, 2, 3))
    points[:, 1, 0] = [0.0, 0.005, 0.03, 0.03]
    labels, told = standing(points, np.arange(4), 0.01)
    np.testing.assert_array_equal(labels, [[1, 1], [1, 0], [1, 1], [0, 0]])
    np.testing.assert_array_equal(told, [[1, 1], [1, 1], [1, 1], [0, 0]])


def test_counts_by_hand():
    prediction = np.array([[1, 1, 0, 0]], dtype=bool)
    truth = np.array([[1, 0, 1, 0]], dtype=bool)
    tp, fp, fn = detection_counts(prediction, truth, np.ones_like(truth))
    assert (tp[0], fp[0], fn[0]) == (1, 1, 1)
    tp, fp, fn = detection_counts(prediction, truth, np.array([[1, 0, 1, 1]], dtype=bool))
    assert (tp[0], fp[0], fn[0]) == (1, 0, 1)


@settings(max_examples=50, deadline=None, derandomize=True)
@given(st.integers(0, 2**32 - 1))
def test_weighted_means_are_the_ratios_of_all_counts(seed):
    rng = np.random.default_rng(seed)
    prediction, truth = rng.random((2, 30, 4)) < 0.5
    counts = detection_counts(prediction, truth, np.ones_like(truth))
    tp, fp, fn = (c.sum() for c in counts)
    expected = {"precision": tp / (tp + fp), "recall": tp / (tp + fn), "f1": 2 * tp / (2 * tp + fp + fn)}
    for name, (values, weights) in ratios(counts).items():
        np.testing.assert_allclose(np.sum(values * weights) / weights.sum(), expected[name])
