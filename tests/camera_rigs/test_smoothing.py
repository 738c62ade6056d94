"""Smoothing without lag, easing, interpolation, and directions that are undefined for moments."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from camera_rigs.smoothing import (
    at,
    cushioned,
    heading_of,
    rate_of_change,
    smooth,
    smootherstep,
    smootherstep_integral,
    through,
)

FPS = 30.0
SHARES = st.just(0.0) | st.floats(0.01, 0.5)


def test_a_straight_walk_stays_one_up_to_its_ends():
    walk = np.outer(np.arange(60) / FPS, [1.4, -0.3, 0.0])
    np.testing.assert_allclose(smooth(walk, 0.6, FPS), walk, atol=1e-12)


def test_a_sine_is_attenuated_by_the_gaussian_s_transfer_function():
    time, sigma, frequency = np.arange(600) / FPS, 0.3, 0.8
    smoothed = smooth(np.sin(2.0 * np.pi * frequency * time)[:, None], sigma, FPS)[150:450]
    expected = np.exp(-0.5 * (2.0 * np.pi * frequency * sigma) ** 2)
    assert np.abs(smoothed).max() == pytest.approx(expected, rel=0.01)


def test_a_bounded_signal_is_mirrored_and_stays_bounded():
    angle = np.arange(40) * 0.3
    direction = np.column_stack([np.cos(angle), np.sin(angle)])
    assert np.linalg.norm(smooth(direction, 0.5, FPS, travels=False), axis=1).max() <= 1.0


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_the_shortest_signals_are_smoothed_too(frames):
    signal = np.arange(3.0 * frames).reshape(frames, 3)
    np.testing.assert_allclose(smooth(signal, 0.5, FPS), signal, atol=1e-12)


def test_the_step_and_its_integral_belong_together():
    u = np.linspace(0.0, 1.0, 20001)
    step = smootherstep(u)
    assert (step[0], step[-1], smootherstep(0.5)) == (0.0, 1.0, 0.5)
    area = np.concatenate([[0.0], np.cumsum(0.5 * (step[1:] + step[:-1])) * (u[1] - u[0])])
    np.testing.assert_allclose(smootherstep_integral(u), area, atol=1e-8)


@settings(derandomize=True, deadline=None)
@given(length=st.floats(2.0, 200.0), shares=st.tuples(SHARES, SHARES))
def test_a_cushioned_movement_runs_once_from_start_to_end(length, shares):
    time = np.linspace(0.0, length, 400)
    progress = cushioned(time, length, shares[0] * length, shares[1] * length)
    assert progress[0] == pytest.approx(0.0, abs=1e-12)
    assert progress[-1] == pytest.approx(1.0, abs=1e-12)
    assert (np.diff(progress) >= -1e-12).all()


def test_between_its_cushions_a_movement_has_one_speed():
    time = np.linspace(0.0, 100.0, 1001)
    speed = np.diff(cushioned(time, 100.0, 20.0, 30.0))
    np.testing.assert_allclose(speed[201:699], speed[400], rtol=1e-9)
    assert speed[0] < 1e-3 * speed[400]
    assert np.abs(np.diff(speed)).max() < 0.02 * speed[400], "the speed must not jump"
    np.testing.assert_allclose(cushioned(time, 100.0, 0.0, 0.0), time / 100.0)


def test_values_are_met_and_never_overshot():
    times, values = np.array([0.0, 10.0, 30.0, 35.0]), np.array([1.0, 3.0, 3.0, -2.0])
    frames = np.linspace(-5.0, 40.0, 901)
    joined = through(times, values, frames)
    np.testing.assert_allclose(through(times, values, times), values)
    assert (joined.min(), joined.max()) == (-2.0, pytest.approx(3.0, abs=1e-12))
    assert np.abs(np.diff(joined, 2)).max() < 0.01
    np.testing.assert_array_equal(through([4.0], [[1.0, 2.0]], np.arange(3.0)), [[1.0, 2.0]] * 3)


def test_a_signal_between_and_beyond_its_frames():
    signal = np.array([[0.0, 1.0], [2.0, 5.0]])
    np.testing.assert_allclose(at(signal, [-1.0, 0.25, 1.0, 9.0]), [[0, 1], [0.5, 2], [2, 5], [2, 5]])
    assert at(np.array([7.0]), 3.5) == 7.0


def test_a_rate_of_change():
    time = np.arange(20) / FPS
    fall = np.column_stack([0.0 * time, 2.0 * time, 0.5 * 9.81 * time**2])
    np.testing.assert_allclose(rate_of_change(fall, 2, FPS), 9.81, rtol=1e-9)
    assert len(rate_of_change(fall[:2], 3, FPS)) == 0


def test_a_steady_heading_is_kept():
    azimuth = np.full(50, 2.0)
    heading = heading_of(np.column_stack([np.cos(azimuth), np.sin(azimuth)]), 0.5, FPS)
    np.testing.assert_allclose(heading, 2.0, atol=1e-12)


def test_a_slow_turn_is_followed_through_the_half_circle_without_a_jump():
    azimuth = np.linspace(0.0, 2.0 * np.pi, 300)
    heading = heading_of(np.column_stack([np.cos(azimuth), np.sin(azimuth)]), 0.3, FPS)
    assert np.abs(np.diff(heading)).max() < 0.05
    np.testing.assert_allclose(heading[40:-40], azimuth[40:-40], atol=0.02)


def test_an_undefined_direction_is_bridged():
    azimuth = np.where(np.arange(120) < 60, 0.0, 1.0)
    direction = np.column_stack([np.cos(azimuth), np.sin(azimuth)])
    direction[30:90] = 0.0
    heading = heading_of(direction, 0.2, FPS)
    assert (np.diff(heading) >= -1e-9).all()
    assert 0.3 < heading[60] < 0.7


def test_a_spin_faster_than_the_window_has_no_heading_to_follow():
    azimuth = 12.0 * np.arange(150) / FPS
    heading = heading_of(np.column_stack([np.cos(azimuth), np.sin(azimuth)]), 0.5, FPS)
    assert np.ptp(heading) < np.pi
    assert np.isfinite(heading_of(np.zeros((5, 2)), 0.5, FPS)).all()
