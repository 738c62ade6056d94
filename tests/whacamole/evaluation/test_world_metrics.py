"""World-frame metrics: closed forms, invariances, and ATE against evo."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from whacamole.evaluation.core.world import (
    egocentric_velocity_error,
    foot_sliding,
    path_error,
    root_translation_error,
    segment_error,
)

seeds = st.integers(0, 2**32 - 1)


def walk(seed, frames=30, joints=22):
    """A body of random joints that goes on its way."""
    rng = np.random.default_rng(seed)
    path = np.cumsum(rng.normal(size=(frames, 1, 3)), axis=0) * 0.1
    return rng.normal(size=(1, joints, 3)) + 0.02 * rng.normal(size=(frames, joints, 3)) + path


def moved(points, seed, scale=None):
    rng = np.random.default_rng(seed)
    R, t = Rotation.random(random_state=rng).as_matrix(), 10 * rng.normal(size=3)
    return (rng.uniform(0.2, 5.0) if scale is None else scale) * points @ R.T + t


def rows_of(*ends):
    return [np.arange(a, b) for a, b in zip((0, *ends[:-1]), ends, strict=True)]


@settings(max_examples=30, deadline=None, derandomize=True)
@given(seeds)
def test_a_known_similarity_is_undone_by_both_and_a_known_motion_by_the_rigid_ones(seed):
    truth = walk(seed)
    for fit in (2, None):
        rows = rows_of(30)
        similar = segment_error(moved(truth, seed), truth, rows, fit_frames=fit, with_scale=True)
        rigid = segment_error(moved(truth, seed, 1.0), truth, rows, fit_frames=fit, with_scale=False)
        np.testing.assert_allclose([similar, rigid], 0.0, atol=1e-7)


@settings(max_examples=30, deadline=None, derandomize=True)
@given(seeds)
def test_a_similarity_of_the_prediction_changes_nothing(seed):
    truth, prediction = walk(seed), walk(seed) + 0.05 * np.random.default_rng(seed).normal(size=(30, 22, 3))
    for fit in (2, None):
        ours = segment_error(prediction, truth, rows_of(12, 30), fit_frames=fit, with_scale=True)
        other = segment_error(
            moved(prediction, seed), truth, rows_of(12, 30), fit_frames=fit, with_scale=True
        )
        np.testing.assert_allclose(other, ours, rtol=1e-7)


def test_w_shows_a_drift_by_its_length_and_wa_spreads_it():
    truth = walk(0, 50)
    drift = np.zeros((50, 1, 3))
    drift[:, 0, 0] = np.maximum(np.arange(50) - 1, 0) * 0.01
    w = segment_error(truth + drift, truth, rows_of(50), fit_frames=2, with_scale=True)
    wa = segment_error(truth + drift, truth, rows_of(50), fit_frames=None, with_scale=True)
    np.testing.assert_allclose(w, drift[:, 0, 0] * 1000, atol=1e-7)
    assert wa.mean() < w.mean()


def test_segments_are_aligned_apart():
    truth = walk(1, 40)
    prediction = truth.copy()
    prediction[20:] = moved(truth[20:], 5)
    two = segment_error(prediction, truth, rows_of(20, 40), fit_frames=2, with_scale=True)
    one = segment_error(prediction, truth, rows_of(40), fit_frames=2, with_scale=True)
    np.testing.assert_allclose(two, 0.0, atol=1e-7)
    assert one[20:].min() > 1.0


def test_the_two_frame_scale_hides_and_causes_errors_that_the_rigid_fit_shows_rightly():
    """A body 10 % too tall on the right path: W multiplies the path by 1/1.1, its rigid form keeps it."""
    rng = np.random.default_rng(2)
    shape, path = rng.normal(size=(1, 22, 3)), np.zeros((60, 1, 3))
    path[:, 0, 0] = np.linspace(0, 6, 60)
    truth, tall = shape + path, 1.1 * shape + path
    w = segment_error(tall, truth, rows_of(60), fit_frames=2, with_scale=True)
    rigid = segment_error(tall, truth, rows_of(60), fit_frames=2, with_scale=False)
    assert w[-1] == pytest.approx(6000 * (1 - 1 / 1.1), rel=0.02)
    assert rigid.max() < 1000 * 0.11 * np.linalg.norm(shape, axis=-1).mean()


def test_frames_in_no_segment_have_no_error():
    truth = walk(3, 10)
    error = segment_error(truth, truth, [np.arange(4)], fit_frames=2, with_scale=True)
    np.testing.assert_array_equal(np.isfinite(error), np.arange(10) < 4)


def test_one_frame_is_aligned_on_itself():
    truth = walk(4, 1)
    error = segment_error(moved(truth, 0), truth, rows_of(1), fit_frames=2, with_scale=True)
    np.testing.assert_allclose(error, 0.0, atol=1e-7)


def test_rte_is_a_share_of_the_way():
    truth = np.zeros((11, 3))
    truth[:, 0] = np.arange(11.0)
    bumped = truth.copy()
    bumped[:, 1] = np.where(np.arange(11) % 2, 0.1, -0.1)
    error = root_translation_error(bumped, truth)
    assert error is not None
    assert error.mean() == pytest.approx(0.1 / 10 * 100, rel=0.05)


def test_rte_does_not_forgive_scale_and_does_forgive_a_motion():
    truth = walk(5)[:, 0]
    np.testing.assert_allclose(root_translation_error(moved(truth, 1, 1.0), truth), 0.0, atol=1e-7)
    assert root_translation_error(2.0 * truth, truth).max() > 1.0


def test_a_person_who_stays_has_no_rte_and_no_scale():
    still = np.full((20, 3), 2.0)
    assert root_translation_error(still, still) is None
    assert path_error(still, still) is None
    assert path_error(walk(6)[:1, 0], walk(6)[:1, 0]) is None


@pytest.mark.parametrize("place", [0.0, 2.3, -1e4 / 3])
@pytest.mark.parametrize("with_scale", [True, False])
def test_a_prediction_that_does_not_move_is_in_the_middle_and_has_no_scale(place, with_scale):
    truth = walk(6)[:, 0]
    path = path_error(np.full(truth.shape, place), truth, with_scale=with_scale)
    apart = np.linalg.norm(truth - truth.mean(axis=0), axis=1)
    np.testing.assert_allclose(path.error, 1000 * apart, rtol=1e-9)
    assert np.isnan(path.scale) == with_scale


@settings(max_examples=30, deadline=None, derandomize=True)
@given(seeds, st.floats(0.05, 20.0))
def test_the_scale_goes_from_prediction_to_truth(seed, scale):
    truth = walk(seed)[:, 0]
    found = path_error(moved(truth, seed, scale), truth)
    assert found.scale == pytest.approx(1 / scale, rel=1e-7)
    assert found.rmse == pytest.approx(0.0, abs=1e-6)
    np.testing.assert_allclose(found.aligned, truth, atol=1e-8)


@pytest.mark.parametrize("with_scale", [True, False])
@pytest.mark.parametrize("seed", range(5))
def test_ate_is_that_of_evo(seed, with_scale):
    metrics = pytest.importorskip("evo.core.metrics")
    trajectory = pytest.importorskip("evo.core.trajectory")
    rng = np.random.default_rng(seed)
    truth = walk(seed)[:, 0]
    prediction = moved(truth, seed) + 0.05 * rng.normal(size=(30, 3))
    quaternions = np.tile([1.0, 0, 0, 0], (30, 1))
    theirs = trajectory.PosePath3D(prediction.copy(), quaternions)
    reference = trajectory.PosePath3D(truth.copy(), quaternions)
    theirs.align(reference, correct_scale=with_scale)
    ape = metrics.APE(metrics.PoseRelation.translation_part)
    ape.process_data((reference, theirs))
    ours = path_error(prediction, truth, with_scale=with_scale)
    assert ours.mean == pytest.approx(1000 * ape.get_statistic(metrics.StatisticsType.mean), abs=1e-9)
    assert ours.rmse == pytest.approx(1000 * ape.get_statistic(metrics.StatisticsType.rmse), abs=1e-9)


def test_erve_sees_velocity_in_the_bodys_own_frame():
    """A prediction in another world, turned by R, moves alike as seen by the body."""
    truth = walk(7)[:, 0]
    orient = Rotation.random(30, random_state=np.random.default_rng(0)).as_matrix()
    R = Rotation.random(random_state=np.random.default_rng(1)).as_matrix()
    frames = np.arange(30)
    same = egocentric_velocity_error(truth @ R.T + 3.0, truth, R @ orient, orient, frames)
    np.testing.assert_allclose(same[:-1], 0.0, atol=1e-9)
    assert np.isnan(same[-1])
    still = egocentric_velocity_error(0 * truth, truth, orient, orient, frames)
    np.testing.assert_allclose(still[:-1], 1000 * np.linalg.norm(np.diff(truth, axis=0), axis=1))


def test_foot_sliding_counts_the_steps_of_feet_that_should_stand():
    truth = np.zeros((5, 4, 3))
    truth[:, 2:, 0] = np.arange(5)[:, None] * 0.5  # two points walk, two stand
    prediction = np.zeros((5, 4, 3))
    prediction[:, :, 1] = np.arange(5)[:, None] * 0.003
    value, count = foot_sliding(prediction, truth, np.arange(5), still=0.01)
    np.testing.assert_allclose(count, [2, 2, 2, 2, 0])
    np.testing.assert_allclose(value, [3, 3, 3, 3, 0])
    _, gapped = foot_sliding(prediction, truth, np.array([0, 1, 5, 6, 7]), still=0.01)
    np.testing.assert_allclose(gapped, [2, 0, 2, 2, 0])
