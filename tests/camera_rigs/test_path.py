"""`CameraPath`, projection and look-at."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from camera_rigs import CameraPath, Lens, PlanError, look_at

LENS = Lens(640, 360, 500.0)


def one_camera(eye, target, roll=0.0):
    pose = look_at(np.array([eye], float), np.array([target], float), np.array([roll]))
    return CameraPath(LENS.intrinsics(np.array([LENS.focal])), pose, 30.0, LENS.width, LENS.height)


def test_what_is_looked_at_lies_in_the_middle():
    path = one_camera((3.0, -2.0, 1.5), (0.2, 0.1, 1.0))
    pixels, depth = path.project(np.array([[0.2, 0.1, 1.0]]))
    np.testing.assert_allclose(pixels, [[320.0, 180.0]])
    assert depth[0] == pytest.approx(np.linalg.norm([2.8, -2.1, 0.5]))


def test_right_is_right_and_up_is_up():
    path = one_camera((0.0, -5.0, 1.0), (0.0, 0.0, 1.0))
    pixels, _ = path.project(np.array([[[1.0, 0.0, 1.0], [0.0, 0.0, 2.0]]]))
    np.testing.assert_allclose(pixels[0, 0], [320.0 + 100.0, 180.0])
    np.testing.assert_allclose(pixels[0, 1], [320.0, 180.0 - 100.0])


@settings(derandomize=True, deadline=None)
@given(st.lists(st.floats(-5.0, 5.0), min_size=6, max_size=6))
def test_a_camera_is_rigid_level_and_upright(numbers):
    eye, target = np.array(numbers[:3]), np.array(numbers[3:])
    if np.hypot(*(eye - target)[:2]) < 0.1:
        return
    R = look_at(eye[None], target[None])[0, :3, :3]
    np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(R) == pytest.approx(1.0)
    assert R[2, 0] == 0.0, "the x axis is level"
    assert R[2, 1] < 0.0, "the y axis points down"
    np.testing.assert_allclose(R[:, 2], (target - eye) / np.linalg.norm(target - eye), atol=1e-12)


def test_a_roll_turns_x_towards_y():
    level, rolled = (one_camera((0, -5, 1), (0, 0, 1), roll).T_world_camera[0] for roll in (0.0, 0.1))
    assert level[:3, 1] @ rolled[:3, 0] == pytest.approx(np.sin(0.1))
    np.testing.assert_allclose(level[:3, 2], rolled[:3, 2])


def test_points_behind_the_camera_have_no_pixels():
    pixels, depth = one_camera((0, -5, 1), (0, 0, 1)).project(np.array([[0.0, -9.0, 1.0]]))
    assert depth[0] == pytest.approx(-4.0)
    assert np.isnan(pixels).all()


def test_the_inverse_is_the_inverse():
    path = one_camera((3.0, -2.0, 1.5), (0.2, 0.1, 1.0), 0.2)
    np.testing.assert_allclose(path.T_camera_world @ path.T_world_camera, np.eye(4)[None], atol=1e-15)
    np.testing.assert_allclose(path.T_camera_world, np.linalg.inv(path.T_world_camera), atol=1e-12)


def test_arrays_of_different_lengths_are_refused():
    with pytest.raises(PlanError, match="one length"):
        CameraPath(LENS.intrinsics(np.full(3, 500.0)), np.tile(np.eye(4), (2, 1, 1)), 30.0, 640, 360)
