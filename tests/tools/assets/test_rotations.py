"""The rotations that bring bones to the T-pose and share twists."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from open_people.fine_rig import share, swing_twist
from open_people.tpose import between, frame, part_way
from scipy.spatial.transform import Rotation

vectors = hnp.arrays(np.float64, 3, elements=st.floats(-2, 2)).filter(lambda v: 0.2 < np.linalg.norm(v) < 3)


def is_rotation(matrix):
    return np.allclose(matrix @ matrix.T, np.eye(3), atol=1e-9) and np.isclose(np.linalg.det(matrix), 1)


@settings(derandomize=True, max_examples=80, deadline=None)
@given(a=vectors, b=vectors)
def test_between_turns_one_direction_into_the_other_the_short_way(a, b):
    a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
    if a @ b < -0.999:
        return
    turn = between(a, b)
    assert is_rotation(turn)
    np.testing.assert_allclose(turn @ a, b, atol=1e-7)
    np.testing.assert_allclose(
        Rotation.from_matrix(turn).magnitude(), np.arccos(np.clip(a @ b, -1, 1)), atol=1e-5
    )


@settings(derandomize=True, max_examples=60, deadline=None)
@given(rotation=vectors, axis=vectors)
def test_swing_and_twist_make_the_rotation_and_the_swing_has_no_twist(rotation, axis):
    matrix = Rotation.from_rotvec(rotation).as_matrix()
    swing, twist = swing_twist(matrix, axis)
    np.testing.assert_allclose((swing * twist).as_matrix(), matrix, atol=1e-9)
    unit = axis / np.linalg.norm(axis)
    np.testing.assert_allclose(np.cross(twist.as_rotvec(), unit), 0, atol=1e-9)
    np.testing.assert_allclose(swing.as_quat()[:3] @ unit, 0, atol=1e-9)


@settings(derandomize=True, max_examples=40, deadline=None)
@given(a=vectors, b=vectors, t=st.floats(0, 1))
def test_part_way_lies_on_the_way(a, b, t):
    start, end = Rotation.from_rotvec(a), Rotation.from_rotvec(b)
    middle = Rotation.from_matrix(part_way(start.as_matrix(), end.as_matrix(), t))
    whole = (end * start.inv()).magnitude()
    np.testing.assert_allclose((middle * start.inv()).magnitude(), t * whole, atol=1e-7)
    np.testing.assert_allclose((end * middle.inv()).magnitude(), (1 - t) * whole, atol=1e-7)


def test_share_of_a_rotation_is_about_the_same_axis():
    rotation = Rotation.from_rotvec([0.3, -0.8, 0.4])
    np.testing.assert_allclose(
        Rotation.from_matrix(share(rotation.as_matrix(), 0.25)).as_rotvec(), 0.25 * rotation.as_rotvec()
    )


def test_frame_is_right_handed_with_x_first():
    matrix = frame(np.array([0.0, 2.0, 0.0]), np.array([1.0, 1.0, 0.0]))
    assert is_rotation(matrix)
    np.testing.assert_allclose(matrix[:, 0], [0, 1, 0])


@pytest.mark.parametrize("sign", [1, -1])
def test_between_opposite_or_equal_directions_is_finite(sign):
    assert np.isfinite(between(np.array([0.0, 0, 1]), np.array([0.0, 0, sign]))).all()
