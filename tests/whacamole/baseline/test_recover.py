"""Perfect inputs give the perfect world: every equation is right."""

from dataclasses import replace

import numpy as np
import pytest

from baseline_scenes import TrueScene, moving_camera, oracle, true_scene
from whacamole.baseline.modes import MODES, Components, Mode
from whacamole.baseline.odometry import Odometry
from whacamole.baseline.recover import Recovery, place_people, recover
from whacamole.baseline.rigid import inverse
from whacamole.body import BodyModel

MILLIMETRE = 1e-3


def _run(scene: TrueScene, mode: Mode, components: Components = "both", fps: float = 30.0) -> Recovery:
    people, velocities = scene.estimates(), oracle(scene, mode, fps)
    return recover(people, scene.odometry(), fps, scene.body, velocities, mode, components)


def _joint_error(scene: TrueScene, recovery: Recovery) -> float:
    """Largest distance [m] of any joint of anybody from the truth, in the frame of the first camera."""
    placed = place_people(scene.estimates(), recovery, scene.body)
    worst = 0.0
    for truth, (_, world) in zip(scene.world, placed, strict=True):
        wanted = scene.in_first_camera(scene.body.pose_joints(truth))
        apart = scene.body.pose_joints(world.params) - wanted
        worst = max(worst, float(np.linalg.norm(apart, axis=-1).max()))
    return worst


def _true_unit(scene: TrueScene) -> float:
    """Metres for a unit of the odometry."""
    return float(np.sqrt((np.diff(scene.T_world_camera[:, :3, 3], axis=0) ** 2).sum(axis=1).mean()))


@pytest.mark.parametrize("mode", ["paper", "steady"])
def test_perfect_inputs_give_the_world_to_a_millimetre(scene: TrueScene, mode: str) -> None:
    recovery = _run(scene, MODES[mode])
    assert _joint_error(scene, recovery) < MILLIMETRE
    truth = inverse(scene.T_world_camera[0]) @ scene.T_world_camera
    np.testing.assert_allclose(recovery.T_world_camera, truth, atol=MILLIMETRE)
    assert recovery.scale == pytest.approx(_true_unit(scene), rel=1e-6)


@pytest.mark.parametrize("fps", [24.0, 25.0, 59.94])
def test_so_they_do_at_other_frame_rates(scene: TrueScene, fps: float) -> None:
    """Up to what interpolating velocities between frames costs."""
    recovery = _run(scene, MODES["paper"], fps=fps)
    assert recovery.scale == pytest.approx(_true_unit(scene), rel=0.01)
    assert _joint_error(scene, recovery) < 0.03


def test_the_velocimeter_alone_gives_the_world_too(scene: TrueScene) -> None:
    recovery = _run(scene, MODES["paper"], "mv")
    assert _joint_error(scene, recovery) < MILLIMETRE
    assert np.isnan(recovery.scale)


def test_the_odometry_alone_has_the_shape_and_another_unit(scene: TrueScene) -> None:
    recovery = _run(scene, MODES["paper"], "vo")
    truth = (inverse(scene.T_world_camera[0]) @ scene.T_world_camera)[:, :3, 3]
    np.testing.assert_allclose(recovery.T_world_camera[:, :3, 3] * _true_unit(scene), truth, atol=1e-9)
    assert np.isnan(recovery.scale)


def test_the_release_is_biased_by_what_it_takes_for_the_root(scene: TrueScene) -> None:
    """Even with perfect inputs: transl for the pelvis, and a smoothed path."""
    unbiased = replace(MODES["release"], root="pelvis", smoothing=0.0)
    errors = [abs(_run(scene, mode).scale / _true_unit(scene) - 1.0) for mode in (MODES["release"], unbiased)]
    assert errors[0] > 5e-4
    assert errors[1] < 1e-9


def test_runs_with_gaps_share_one_scale(scene: TrueScene) -> None:
    """Somebody who leaves and returns has a path of another origin, but the same world."""
    here, gone = np.ones(scene.num_frames, dtype=bool), np.ones(scene.num_frames, dtype=bool)
    gone[64:80] = False
    people, mode = scene.estimates([here, gone]), MODES["paper"]
    velocities = oracle(scene, mode, valid=[here, gone])
    recovery = recover(people, scene.odometry(), 30.0, scene.body, velocities, mode)
    assert recovery.scale == pytest.approx(_true_unit(scene), rel=1e-6)
    assert _joint_error(scene, recovery) < MILLIMETRE


def test_lost_frames_stay_lost(scene: TrueScene) -> None:
    valid = np.ones(scene.num_frames, dtype=bool)
    valid[100:] = False
    odometry = Odometry.from_poses(scene.T_world_camera, valid)
    people = scene.estimates()
    recovery = recover(people, odometry, 30.0, scene.body, _silence, MODES["paper"])
    assert recovery.camera_valid.tolist() == valid.tolist()
    for _, world in place_people(people, recovery, scene.body):
        assert world.valid.tolist() == valid.tolist()


def _silence(windows: list[np.ndarray]) -> list[np.ndarray]:
    return [np.zeros((len(window), 3)) for window in windows]


def test_nobody_in_view_leaves_the_scale_unknown(scene: TrueScene) -> None:
    nobody = scene.estimates([np.zeros(scene.num_frames, dtype=bool)] * 2)
    recovery = recover(nobody, scene.odometry(), 30.0, scene.body, _silence, MODES["paper"])
    assert np.isnan(recovery.scale)
    np.testing.assert_allclose(recovery.T_world_camera, scene.odometry().T_vo)


@pytest.mark.parametrize("mode", ["paper", "release", "steady"])
def test_a_camera_that_stands_has_no_scale_and_needs_none(body: BodyModel, mode: str) -> None:
    still = true_scene(body, (("walk.npz", 0.0),), 80)
    poses = moving_camera(80, 1)
    poses[:, :3, 3] = poses[0, :3, 3]
    still = TrueScene(still.world, poses, body)
    recovery = _run(still, MODES[mode])
    if mode != "release":
        assert np.isnan(recovery.scale)
    assert _joint_error(still, recovery) < MILLIMETRE
