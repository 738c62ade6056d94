"""The hand-held shake: amplitude, band, bounds."""

import numpy as np
import pytest

from camera_rigs import CameraPath, PlanError, Shake, look_at
from camera_rigs.shake import shake_rand, shaken

SHAKE = Shake(millimetres=6.0, degrees=0.3, low=0.5, high=3.0)


def test_the_amplitude_is_the_one_asked_for():
    moved, turned = shake_rand(np.random.default_rng(0), SHAKE, 30000, 30.0)
    np.testing.assert_allclose(moved.std(axis=0) * 1000.0, 6.0, rtol=0.02)
    np.testing.assert_allclose(np.degrees(turned).std(axis=0), 0.3, rtol=0.02)


def test_nothing_lies_outside_the_band():
    moved, turned = shake_rand(np.random.default_rng(1), SHAKE, 6000, 30.0)
    window = np.blackman(6000)[:, None]
    power = np.abs(np.fft.rfft(np.hstack([moved, turned]) * window, axis=0)) ** 2
    frequency = np.fft.rfftfreq(6000, 1.0 / 30.0)
    outside = (frequency < SHAKE.low - 0.05) | (frequency > SHAKE.high + 0.05)
    assert (power[outside].sum(axis=0) / power.sum(axis=0)).max() < 1e-6


def test_every_derivative_keeps_its_bound():
    moved, turned = shake_rand(np.random.default_rng(2), SHAKE, 5000, 120.0)
    for order in (1, 2, 3):
        assert np.abs(np.diff(moved, order, axis=0)).max() * 120.0**order <= SHAKE.bound(order)
    assert np.abs(moved).max() <= SHAKE.bound(0)
    assert np.abs(turned).max() <= SHAKE.angle_bound()


def test_equal_seeds_shake_alike():
    first, second = (shake_rand(np.random.default_rng(3), SHAKE, 50, 30.0) for _ in range(2))
    np.testing.assert_array_equal(first, second)


def test_the_camera_is_moved_and_turned_in_its_own_axes():
    pose = look_at(np.array([[0.0, -5.0, 1.0]]), np.array([[0.0, 0.0, 1.0]]))
    path = CameraPath(np.eye(3)[None], pose, 30.0, 640, 360)
    moved = shaken(path, np.array([[0.1, 0.0, 0.0]]), np.array([[0.0, 0.2, 0.0]]))
    np.testing.assert_allclose(moved.location, [[0.1, -5.0, 1.0]], atol=1e-12)
    np.testing.assert_allclose(moved.forward, [[np.sin(0.2), np.cos(0.2), 0.0]], atol=1e-12)
    np.testing.assert_allclose(moved.T_world_camera[0, :3, 1], pose[0, :3, 1], atol=1e-12)


@pytest.mark.parametrize(
    "bad", [{"millimetres": -1.0}, {"low": 0.0}, {"low": 4.0}, {"degrees": float("nan")}]
)
def test_a_shake_that_cannot_be_is_refused(bad):
    with pytest.raises(PlanError, match="band"):
        Shake(**bad)
