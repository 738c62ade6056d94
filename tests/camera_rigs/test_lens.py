"""The lens, and the framing formula against the projection of points."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from camera_rigs import CameraPath, Lens, PlanError, look_at
from camera_rigs.lens import achieved_fraction, framing_radius, radius_for_fraction
from camera_rigs.spherical import spherical_to_cartesian

SIZES = [(1920, 1080), (1080, 1920), (640, 480), (512, 512), (300, 900), (2000, 400)]


def projected_height(lens, r, theta, above, below, phi=0.4):
    """Height in the image, as a share of the image, of an upright stick seen by a camera that looks at it."""
    eye = spherical_to_cartesian(r, theta, phi)[None]
    path = CameraPath(
        lens.intrinsics(np.array([lens.focal])), look_at(eye, np.zeros((1, 3))), 30.0, lens.width, lens.height
    )
    pixels, _ = path.project(np.array([[[0.0, 0.0, above], [0.0, 0.0, -below]]]))
    return (pixels[0, 1, 1] - pixels[0, 0, 1]) / lens.height


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("fov", [30.0, 60.0, 95.0])
def test_the_paper_s_formula_fills_the_fraction_asked_for(size, fov):
    lens = Lens.from_fov(np.radians(fov), *size)
    r = radius_for_fraction(1.75 / 2.0, 0.7, lens.fov, lens.aspect)
    assert projected_height(lens, r, np.pi / 2.0, 0.8, 0.95) == pytest.approx(0.7, rel=1e-9)


@pytest.mark.parametrize("size", SIZES)
def test_taken_literally_with_the_whole_height_it_fills_half_of_it(size):
    lens = Lens.from_fov(np.radians(60.0), *size)
    r = radius_for_fraction(1.75, 0.7, lens.fov, lens.aspect)
    assert projected_height(lens, r, np.pi / 2.0, 0.8, 0.95) == pytest.approx(0.35, rel=1e-9)


@settings(derandomize=True, deadline=None, max_examples=200)
@given(
    size=st.sampled_from(SIZES),
    fov=st.floats(15.0, 110.0),
    frac=st.floats(0.2, 3.0),
    theta=st.floats(40.0, 112.0),
    extent=st.tuples(st.floats(0.05, 1.5), st.floats(0.05, 1.5)),
)
def test_the_framing_is_exact_from_any_angle(size, fov, frac, theta, extent):
    lens = Lens.from_fov(np.radians(fov), *size)
    polar = np.radians(theta)
    r = framing_radius(*extent, frac, polar, lens.focal, lens.height)
    if r > 1.05 * np.cos(polar) * extent[0]:  # the top of the stick is in front of the camera
        assert projected_height(lens, r, polar, *extent) == pytest.approx(frac, rel=1e-6)
        fraction = achieved_fraction(*extent, r, polar, lens.focal, lens.height)
        assert fraction == pytest.approx(frac, rel=1e-6)


def test_at_eye_level_the_exact_framing_is_the_paper_s_formula():
    lens = Lens.from_fov(np.radians(70.0), 1280, 720)
    exact = framing_radius(0.7, 1.0, 0.6, np.pi / 2.0, lens.focal, lens.height)
    assert exact == pytest.approx(radius_for_fraction(0.85, 0.6, lens.fov, lens.aspect), rel=1e-12)


@pytest.mark.parametrize(("size", "long"), [((1920, 1080), 0), ((1080, 1920), 1)])
def test_the_angle_of_view_lies_along_the_longer_side(size, long):
    lens = Lens.from_fov(np.radians(90.0), *size)
    assert lens.focal == pytest.approx(960.0)
    assert np.degrees(lens.fov) == pytest.approx(90.0)
    assert lens.intrinsics()[long, 2] == 960.0


def test_focal_lengths_in_millimetres_are_those_of_a_full_frame_sensor():
    lens = Lens.from_millimetres(18.0, 1920, 1080)
    assert np.degrees(lens.fov) == pytest.approx(90.0)
    assert np.degrees(Lens.from_millimetres(50.0, 640, 360).fov) == pytest.approx(39.6, abs=0.05)


def test_intrinsics_have_the_principal_point_in_the_middle():
    K = Lens(640, 360, 500.0).intrinsics(np.array([500.0, 700.0]))
    np.testing.assert_array_equal(K[1], [[700.0, 0.0, 320.0], [0.0, 700.0, 180.0], [0.0, 0.0, 1.0]])


@pytest.mark.parametrize("lens", [(0, 360, 500.0), (640, 360, 0.0), (640, 360, float("nan"))])
def test_a_lens_that_cannot_be_is_refused(lens):
    with pytest.raises(PlanError, match="must be positive"):
        Lens(*lens)


def test_a_field_of_view_of_half_a_turn_is_refused():
    with pytest.raises(PlanError, match="180"):
        Lens.from_fov(np.pi, 640, 360)
