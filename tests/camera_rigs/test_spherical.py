"""The human-centric spherical frame."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from camera_rigs.spherical import cartesian_to_spherical, spherical_to_cartesian, wrap


def test_the_equation_of_the_paper():
    offset = spherical_to_cartesian(2.0, np.radians(60.0), np.radians(30.0))
    sin, cos = np.sin(np.radians(60.0)), np.cos(np.radians(60.0))
    expected = 2.0 * np.array([sin * np.cos(np.radians(30.0)), sin * np.sin(np.radians(30.0)), cos])
    np.testing.assert_allclose(offset, expected, atol=1e-15)


def test_eye_level_is_a_right_angle_from_the_vertical():
    assert spherical_to_cartesian(3.0, np.pi / 2.0, 0.7)[2] == np.float64(3.0 * np.cos(np.pi / 2.0))
    assert spherical_to_cartesian(3.0, np.radians(60.0), 0.7)[2] > 0.0


@settings(derandomize=True, deadline=None)
@given(r=st.floats(0.1, 50.0), theta=st.floats(0.01, 3.13), phi=st.floats(-3.1, 3.1))
def test_there_and_back(r, theta, phi):
    np.testing.assert_allclose(
        cartesian_to_spherical(spherical_to_cartesian(r, theta, phi)), (r, theta, phi), atol=1e-9
    )


def test_arrays_broadcast():
    assert spherical_to_cartesian(np.ones(4), 1.0, np.zeros((3, 1))).shape == (3, 4, 3)


@settings(derandomize=True, deadline=None)
@given(st.floats(-100.0, 100.0))
def test_a_wrapped_angle_is_the_same_direction(angle):
    wrapped = wrap(angle)
    assert -np.pi <= wrapped < np.pi
    np.testing.assert_allclose([np.cos(wrapped), np.sin(wrapped)], [np.cos(angle), np.sin(angle)], atol=1e-9)
