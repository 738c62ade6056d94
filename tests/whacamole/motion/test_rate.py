"""Frame rates as fractions, and resampling against motions known in closed form."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from whacamole.motion.rate import Resampler, rational_rate, resampled_length

RATES = [25.0, 30.0, 50.0, 59.94, 60.0, 100.0, 119.88, 120.00004577, 150.0, 250.0]


@pytest.mark.parametrize(
    ("stored", "meant"),
    [
        (120.00004577, Fraction(120)),
        (59.94, Fraction(60000, 1001)),
        (29.97002997, Fraction(30000, 1001)),
        (23.976, Fraction(24000, 1001)),
        (30, Fraction(30)),
        (12.5, Fraction(25, 2)),
        (59.9, Fraction(599, 10)),
    ],
)
def test_rate_that_was_meant(stored, meant):
    assert rational_rate(stored) == meant


@settings(derandomize=True, deadline=None)
@given(st.integers(1, 1000), st.floats(-9e-6, 9e-6))
def test_a_rounded_whole_rate_is_whole(whole, error):
    rate = whole * (1.0 + error)
    if 1.0 <= rate <= 1000.0:
        assert rational_rate(rate) == whole


@settings(derandomize=True, deadline=None)
@given(st.floats(1.0, 1000.0))
def test_the_fraction_is_close_to_the_rate(rate):
    assert abs(float(rational_rate(rate)) / rate - 1.0) < 1e-3


@pytest.mark.parametrize("rate", [0.0, -30.0, 0.5, 1001.0, float("nan"), float("inf")])
def test_absurd_rates_are_refused(rate):
    with pytest.raises(ValueError, match="frame rate"):
        rational_rate(rate)


@settings(derandomize=True, deadline=None)
@given(st.integers(1, 5000), st.sampled_from(RATES))
def test_nothing_is_extrapolated_and_nothing_lost(frames, stored):
    rate = rational_rate(stored)
    length = resampled_length(frames, rate)
    last = Fraction(frames - 1) / rate
    assert Fraction(length - 1, 30) <= last < Fraction(length, 30)
    assert Resampler(frames, rate).num_frames == length


@pytest.mark.parametrize("factor", [1, 2, 3, 4, 5, 8])
def test_whole_ratios_copy_frames_bit_for_bit(factor):
    rng = np.random.default_rng(0)
    pose, path = rng.normal(size=(97, 5, 3)), rng.normal(size=(97, 3))
    resampler = Resampler(97, Fraction(30 * factor))
    assert resampler.rotations(pose).tobytes() == pose[::factor].tobytes()
    assert resampler.linear(path).tobytes() == path[::factor].tobytes()


@pytest.mark.parametrize("stored", RATES)
def test_even_turns_and_straight_paths_are_exact(stored):
    rate = rational_rate(stored)
    times = np.arange(200) / float(rate)
    axes = np.array([[0.0, 0.0, 1.0], [0.6, 0.8, 0.0]])
    turns = np.stack([(Rotation.from_rotvec(3.0 * t * axes)).as_rotvec() for t in times])
    resampler = Resampler(200, rate)
    at = np.arange(resampler.num_frames) / 30.0
    for joint in range(2):
        expected = Rotation.from_rotvec(3.0 * at[:, None] * axes[joint])
        found = Rotation.from_rotvec(resampler.rotations(turns)[:, joint])
        assert (expected.inv() * found).magnitude().max() < 1e-9
    line = times[:, None] * np.array([1.0, -2.0, 0.5]) + 3.0
    np.testing.assert_allclose(
        resampler.linear(line), at[:, None] * np.array([1.0, -2.0, 0.5]) + 3.0, atol=1e-9
    )


def test_a_turn_past_half_a_circle_takes_the_short_way():
    # The same attitude may be written as +179 or −181 degrees; between two such frames nothing may spin.
    pose = np.radians([[[0.0, 0.0, 179.0]], [[0.0, 0.0, -179.0]]])
    found = Resampler(2, Fraction(15)).rotations(pose)
    assert len(found) == 3
    assert Rotation.from_rotvec(found[1, 0]).magnitude() == pytest.approx(np.pi)


def test_the_input_is_left_alone():
    path = np.arange(30.0).reshape(10, 3)
    kept = path.copy()
    Resampler(10, Fraction(25)).linear(path)
    np.testing.assert_array_equal(path, kept)


@pytest.mark.parametrize("fps", [15, 30, 60, 120])
def test_another_rate_passes_through_the_same_moments(fps: int) -> None:
    time = np.arange(121) / 120.0
    path = np.stack([time, time**2, np.sin(time)], axis=1)
    resampler = Resampler(121, Fraction(120), Fraction(fps))
    assert resampler.num_frames == fps + 1
    np.testing.assert_array_equal(resampler.linear(path.copy()), path[:: 120 // fps])
