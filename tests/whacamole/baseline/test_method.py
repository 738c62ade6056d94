"""The equations, one by one."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from whacamole.baseline import method
from whacamole.baseline.intrinsics import focal_length, intrinsics
from whacamole.baseline.odometry import Odometry
from whacamole.baseline.rigid import inverse, rigid
from whacamole.errors import BaselineError

seeds = st.integers(0, 2**32 - 1)
quick = settings(max_examples=25, deadline=None, derandomize=True)


def _poses(rng: np.random.Generator, n: int) -> np.ndarray:
    return rigid(Rotation.random(n, random_state=rng).as_matrix(), rng.normal(size=(n, 3)))


@given(st.floats(0.1, 3.0), st.floats(300.0, 6000.0), st.floats(50.0, 1000.0), st.floats(2.0, 30.0))
@quick
def test_depth_puts_a_person_where_he_has_the_size_that_was_seen(
    size: float, focal: float, side: float, depth: float
) -> None:
    """A length of 1 m at depth z spans f / z pixels, which is s · I / 2 in a crop that sees [−1, 1]."""
    scale = (focal / depth) / (side / 2.0)
    found = method.depth_from_scale(np.array(scale), np.array(focal), np.array(side))
    assert found == pytest.approx(depth)
    assert size * focal / found == pytest.approx(size * scale * side / 2.0)


@given(seeds, st.floats(0.2, 5.0))
@quick
def test_another_focal_length_leaves_the_pixel_and_the_size(seed: int, factor: float) -> None:
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(4, 3)) + np.array([0.0, 0.0, 6.0])
    moved = method.refocus(root, 600.0, 600.0 * factor)
    np.testing.assert_allclose(moved[:, :2] / moved[:, 2:] * factor, root[:, :2] / root[:, 2:])
    np.testing.assert_allclose(600.0 * factor / moved[:, 2], 600.0 / root[:, 2])


@given(seeds)
@quick
def test_canonical_joints_do_not_depend_on_the_world(seed: int) -> None:
    """Any rigid motion of the world, and any translation of every frame, leaves them: no scale can come
    in."""
    rng = np.random.default_rng(seed)
    joints, orient = rng.normal(size=(6, 15, 3)), Rotation.random(random_state=rng).as_matrix()
    plain = method.canonicalise(joints, orient)
    R = Rotation.random(random_state=rng).as_matrix()
    other = joints @ R.T + rng.normal(size=(6, 1, 3))
    np.testing.assert_allclose(method.canonicalise(other, R @ orient), plain, atol=1e-12)
    assert not plain[:, 0].any()


@given(seeds)
@quick
def test_velocities_come_back_as_the_path_they_were_made_of(seed: int) -> None:
    rng = np.random.default_rng(seed)
    path, orient = rng.normal(size=(9, 3)), Rotation.random(random_state=rng).as_matrix()
    canonical = np.diff(path, axis=0, prepend=np.nan) @ orient
    world = method.decanonicalise(np.nan_to_num(canonical), orient)
    np.testing.assert_allclose(method.trajectory(world), path - path[0], atol=1e-12)


@given(seeds)
@quick
def test_the_derived_camera_is_the_one_that_saw_the_human(seed: int) -> None:
    rng = np.random.default_rng(seed)
    T_world_camera, T_world_human = _poses(rng, 5), _poses(rng, 5)
    seen = inverse(T_world_camera) @ T_world_human
    derived = method.derived_camera(T_world_human, seen)
    np.testing.assert_allclose(derived, T_world_camera, atol=1e-12)
    np.testing.assert_allclose(method.final_human(derived, seen), T_world_human, atol=1e-12)


@given(seeds, st.floats(0.01, 100.0))
@quick
def test_alignment_finds_any_scale_of_paths_that_begin_anywhere(seed: int, scale: float) -> None:
    rng = np.random.default_rng(seed)
    vo = [rng.normal(size=(n, 3)) for n in (12, 5, 30)]
    R = Rotation.random(random_state=rng).as_matrix()
    turned = [scale * path @ R.T + rng.normal(size=3) for path in vo]
    found = method.align(vo, turned)
    assert found.scale == pytest.approx(scale)
    np.testing.assert_allclose(found.rotation, R, atol=1e-9)
    shifted = [scale * path + rng.normal(size=3) for path in vo]
    assert method.align_scale(vo, shifted) == pytest.approx(scale)
    np.testing.assert_allclose(method.window_scales(vo[2], shifted[2]), scale)


def test_a_scale_of_noise_on_noise_is_no_scale_unless_a_rotation_is_fitted() -> None:
    """Why the mode `steady` is there: Umeyama's rotation finds agreement where there is none."""
    draws = np.random.default_rng(0).normal(size=(50, 2, 100, 3))
    fixed = [method.align_scale([vo], [derived]) for vo, derived in draws]
    fitted = [float(method.align([vo], [derived]).scale) for vo, derived in draws]
    assert np.mean(fitted) > 3.0 * np.mean(fixed)


def test_windows_of_a_still_camera_count_nothing() -> None:
    still, moving = np.zeros((20, 3)), np.random.default_rng(0).normal(size=(20, 3))
    assert method.window_scales(still, moving).tolist() == [0.0] * 16
    assert method.window_scales(still[:3], moving[:3]).shape == (0,)


@given(seeds, st.floats(1e-3, 1e3))
@quick
def test_odometry_has_no_scale_place_or_heading(seed: int, scale: float) -> None:
    """The same trajectory in any metric gives the same odometry: nothing metric leaks through."""
    rng = np.random.default_rng(seed)
    poses, valid = _poses(rng, 8), np.ones(8, dtype=bool)
    plain = Odometry.from_poses(poses, valid)
    other = _poses(rng, 1)[0] @ poses
    other[:, :3, 3] *= scale
    np.testing.assert_allclose(Odometry.from_poses(other, valid).T_vo, plain.T_vo, atol=1e-9)
    steps = np.diff(plain.T_vo[:, :3, 3], axis=0)
    assert (steps**2).sum(axis=1).mean() == pytest.approx(1.0)


def test_odometry_keeps_its_longest_run_and_says_so() -> None:
    poses = _poses(np.random.default_rng(0), 10)
    valid = np.array([1, 1, 1, 0, 1, 1, 1, 1, 0, 1], dtype=bool)
    poses[3] = np.nan
    found = Odometry.from_poses(poses, valid)
    assert np.flatnonzero(found.valid).tolist() == [4, 5, 6, 7]
    np.testing.assert_allclose(found.T_vo[4], np.eye(4), atol=1e-12)
    np.testing.assert_array_equal(found.T_vo[~found.valid], np.tile(np.eye(4), (6, 1, 1)))
    assert "4 frames" in found.notes[0]


def test_odometry_that_lost_everything_is_an_error() -> None:
    with pytest.raises(BaselineError, match="lost in every frame"):
        Odometry.from_poses(np.full((4, 4, 4), np.nan), np.ones(4, dtype=bool))


@pytest.mark.parametrize(
    ("source", "focal"), [("diagonal", 734.302), ("24mm", 438.857), ("dummy", 5000.0), ("612.5", 612.5)]
)
def test_focal_lengths_are_guessed_from_the_image(source: str, focal: float) -> None:
    assert focal_length(source, 640, 360) == pytest.approx(focal, abs=1e-3)
    K = intrinsics(source, 640, 360, 2)
    np.testing.assert_allclose(K[1], [[focal, 0, 320], [0, focal, 180], [0, 0, 1]], atol=1e-3)


@pytest.mark.parametrize("source", ["given", "wide", "-3", "nan", "0"])
def test_a_focal_length_that_is_none_is_refused(source: str) -> None:
    with pytest.raises(BaselineError, match="focal length"):
        focal_length(source, 640, 360)
