"""Relative pose error against evo and in closed form."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from whacamole.evaluation.core.camera import relative_pose_error


def poses(seed, frames=25, step=0.2):
    rng = np.random.default_rng(seed)
    T = np.tile(np.eye(4), (frames, 1, 1))
    turns = Rotation.from_rotvec(0.1 * rng.normal(size=(frames, 3)))
    orientation = Rotation.random(random_state=rng)
    for i, turn in enumerate(turns):
        orientation = orientation * turn
        T[i, :3, :3] = orientation.as_matrix()
    T[:, :3, 3] = np.cumsum(step * rng.normal(size=(frames, 3)), axis=0)
    return T


@pytest.mark.parametrize("delta", [1, 3])
@pytest.mark.parametrize("seed", range(4))
def test_rpe_is_that_of_evo(seed, delta):
    metrics = pytest.importorskip("evo.core.metrics")
    trajectory = pytest.importorskip("evo.core.trajectory")
    truth, prediction = poses(seed), poses(seed) @ poses(seed + 9, step=0.01)
    pair = tuple(trajectory.PosePath3D(poses_se3=list(T)) for T in (truth, prediction))
    ours = relative_pose_error(prediction, truth, np.arange(25), delta)
    for relation, values, unit in (
        (metrics.PoseRelation.translation_part, ours[0], 1000.0),
        (metrics.PoseRelation.rotation_angle_deg, ours[1], 1.0),
    ):
        rpe = metrics.RPE(relation, delta=delta, delta_unit=metrics.Unit.frames, all_pairs=True)
        rpe.process_data(pair)
        np.testing.assert_allclose(values[:-delta], unit * rpe.error, atol=1e-9 * unit)


def test_a_rigid_change_of_world_changes_nothing():
    truth, prediction, world = poses(1), poses(2), poses(3, 1)
    ours = relative_pose_error(prediction, truth, np.arange(25))
    other = relative_pose_error(world @ prediction, truth, np.arange(25))
    np.testing.assert_allclose(other[0], ours[0], atol=1e-9)
    np.testing.assert_allclose(other[1], ours[1], atol=1e-9)


def test_a_wrong_scale_shows_in_the_translation_alone():
    truth = poses(4)
    prediction = truth.copy()
    prediction[:, :3, 3] *= 1.5
    translation, rotation = relative_pose_error(prediction, truth, np.arange(25))
    steps = np.linalg.norm(np.diff(truth[:, :3, 3], axis=0), axis=1)
    np.testing.assert_allclose(translation[:-1], 500 * steps, rtol=1e-9)
    np.testing.assert_allclose(rotation[:-1], 0.0, atol=1e-7)


def test_steps_across_a_gap_do_not_count():
    truth = poses(5, 6)
    translation, _ = relative_pose_error(truth, truth, np.array([0, 1, 2, 7, 8, 9]))
    np.testing.assert_array_equal(np.isfinite(translation), [1, 1, 0, 1, 1, 0])


def test_one_frame_has_no_step():
    assert np.isnan(relative_pose_error(poses(0, 1), poses(0, 1), np.arange(1))[0]).all()


@pytest.mark.parametrize("degrees", [0.0, 1e-6, 45.0, 179.0])
def test_the_angle_is_exact_at_both_ends(degrees):
    truth = np.tile(np.eye(4), (2, 1, 1))
    prediction = truth.copy()
    prediction[1, :3, :3] = Rotation.from_euler("y", degrees, degrees=True).as_matrix()
    assert relative_pose_error(prediction, truth, np.arange(2))[1][0] == pytest.approx(degrees, rel=1e-9)
