"""Camera-frame metrics: closed forms, and what must not change them."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from whacamole.evaluation.core.alignment import align
from whacamole.evaluation.core.pose import (
    acceleration_error,
    jitter,
    joint_angle_error,
    point_error,
    procrustes_error,
    root_aligned_error,
)

seeds = st.integers(0, 2**32 - 1)


def body(seed, frames=6, joints=22):
    return np.random.default_rng(seed).normal(size=(frames, joints, 3))


def test_the_same_is_no_error():
    x = body(0)
    for error in (point_error(x, x), procrustes_error(x, x), root_aligned_error(x, x, x[:, 0], x[:, 0])):
        np.testing.assert_allclose(error, 0.0, atol=1e-10)


def test_an_offset_is_its_length_and_goes_with_the_root():
    x = body(1)
    moved = x + np.array([0.03, 0.0, 0.04])
    np.testing.assert_allclose(point_error(moved, x), 50.0)
    np.testing.assert_allclose(root_aligned_error(moved, x, moved[:, 0], x[:, 0]), 0.0, atol=1e-10)


def test_one_joint_of_many_counts_its_share():
    x = body(2)
    moved = x.copy()
    moved[:, 5, 1] += 0.22
    np.testing.assert_allclose(point_error(moved, x), 220.0 / 22)


def test_a_known_scale_is_its_distance_from_the_root():
    x = body(3)
    expected = 0.1 * np.linalg.norm(x - x[:, :1], axis=-1).mean(axis=1) * 1000
    np.testing.assert_allclose(root_aligned_error(1.1 * x, x, 1.1 * x[:, 0], x[:, 0]), expected)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(seeds)
def test_pa_undoes_any_similarity_of_the_prediction(seed):
    rng = np.random.default_rng(seed)
    x, y = body(seed), body(seed + 1)
    R = Rotation.random(6, random_state=rng).as_matrix()
    s, t = rng.uniform(0.1, 9.0, size=(6, 1, 1)), rng.normal(size=(6, 1, 3))
    np.testing.assert_allclose(procrustes_error(s * x @ R + t, y), procrustes_error(x, y), rtol=1e-7)


@settings(max_examples=40, deadline=None, derandomize=True)
@given(seeds)
def test_a_common_rigid_motion_changes_nothing(seed):
    rng = np.random.default_rng(seed)
    x, y = body(seed), body(seed + 1)
    R, t = Rotation.random(random_state=rng).as_matrix(), rng.normal(size=3)
    a, b = x @ R + t, y @ R + t
    np.testing.assert_allclose(point_error(a, b), point_error(x, y), rtol=1e-9)
    np.testing.assert_allclose(
        root_aligned_error(a, b, a[:, 0], b[:, 0]), root_aligned_error(x, y, x[:, 0], y[:, 0]), rtol=1e-9
    )


@settings(max_examples=40, deadline=None, derandomize=True)
@given(seeds)
def test_pa_in_squares_is_never_above_the_root_aligned(seed):
    """The similarity minimises the sum of squares, of which root alignment is one candidate."""
    x, y = body(seed), body(seed + 1)
    best = ((align(x, y) - y) ** 2).sum(axis=(1, 2))
    rooted = ((x - x[:, :1] - y + y[:, :1]) ** 2).sum(axis=(1, 2))
    assert (best <= rooted + 1e-9).all()


def test_the_order_of_joints_changes_nothing():
    x, y = body(4), body(5)
    order = np.random.default_rng(0).permutation(22)
    np.testing.assert_allclose(procrustes_error(x[:, order], y[:, order]), procrustes_error(x, y), rtol=1e-9)


def test_a_parabola_has_its_acceleration():
    time = np.arange(10) / 25.0
    y = np.zeros((10, 4, 3))
    x = y + 0.5 * np.array([3.0, 0.0, 4.0]) * time[:, None, None] ** 2
    error = acceleration_error(x, y, 25.0, np.arange(10))
    np.testing.assert_allclose(error[1:-1], 5.0)
    assert np.isnan(error[[0, -1]]).all()


def test_trimming_drops_one_value_more_at_each_end():
    x, y = body(6, 8), body(7, 8)
    full, cut = (acceleration_error(x, y, 30.0, np.arange(8), trim) for trim in (0, 1))
    assert np.isfinite(full).sum() == 6
    np.testing.assert_array_equal(np.isfinite(cut), [0, 0, 1, 1, 1, 1, 0, 0])
    np.testing.assert_allclose(cut[2:6], full[2:6])


def test_no_difference_is_taken_across_a_gap():
    x, y = body(8, 9), body(9, 9)
    frames = np.array([0, 1, 2, 3, 10, 11, 12, 13, 14])
    accel, jerk = acceleration_error(x, y, 30.0, frames), jitter(x, 30.0, frames)
    np.testing.assert_array_equal(np.isfinite(accel), [0, 1, 1, 0, 0, 1, 1, 1, 0])
    np.testing.assert_array_equal(np.isfinite(jerk), [1, 0, 0, 0, 1, 1, 0, 0, 0])


@pytest.mark.parametrize("frames", [0, 1, 2, 3])
def test_too_few_frames_have_no_differences(frames):
    x = body(0, frames)
    assert np.isfinite(acceleration_error(x, x, 30.0, np.arange(frames))).sum() == max(frames - 2, 0)
    assert np.isnan(jitter(x, 30.0, np.arange(frames))).all()


def test_a_cubic_has_its_jerk():
    time = np.arange(12) / 30.0
    x = np.zeros((12, 5, 3))
    x[..., 2] = 7.0 * time[:, None] ** 3
    values = jitter(x, 30.0, np.arange(12))
    np.testing.assert_allclose(values[:-3], 6 * 7.0 / 10.0)
    assert np.isnan(values[-3:]).all()


def test_emdb_counts_still_joints_in_the_mean():
    time = np.arange(6) / 30.0
    x = np.zeros((6, 24, 3))
    x[..., 0] = time[:, None] ** 3
    assert jitter(x, 30.0, np.arange(6), ignored=range(9))[0] == pytest.approx(0.6 * 15 / 24)


@pytest.mark.parametrize("angle", [0.0, 1e-7, 30.0, 120.0, 179.9])
def test_the_angle_between_rotations(angle):
    R = Rotation.random(18, random_state=np.random.default_rng(0)).as_matrix().reshape(2, 9, 3, 3)
    turn = Rotation.from_rotvec(np.radians(angle) * np.array([0.6, 0.0, 0.8])).as_matrix()
    np.testing.assert_allclose(joint_angle_error(R @ turn, R), angle, rtol=1e-6, atol=2e-14)
