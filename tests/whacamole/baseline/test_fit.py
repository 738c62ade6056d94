"""The fit of the body to landmarks."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from baseline_scenes import true_scene
from whacamole.baseline.estimators.blazepose import NUM_LANDMARKS
from whacamole.baseline.estimators.body_points import BodyPoints, body_points
from whacamole.baseline.estimators.first_guess import first_guess
from whacamole.baseline.estimators.fit_model import (
    FITTED,
    NUM_UNKNOWNS,
    FitState,
    linearise,
    place_points,
    prior,
    right_jacobian,
)
from whacamole.baseline.estimators.mediapipe import fit_person
from whacamole.baseline.estimators.tracks import LandmarkTrack
from whacamole.baseline.rigid import FloatArray
from whacamole.body import JOINT_INDEX, BodyModel, BodyParams

K = np.array([[600.0, 0.0, 320.0], [0.0, 600.0, 180.0], [0.0, 0.0, 1.0]])


@pytest.fixture(scope="module")
def points(body: BodyModel) -> BodyPoints:
    return body_points(body)


def _state(seed: int, frames: int) -> FitState:
    rng = np.random.default_rng(seed)
    mean, spread = prior()
    orient = Rotation.from_rotvec(np.array([np.pi, 0.0, 0.0]) + 0.3 * rng.normal(size=(frames, 3)))
    return FitState(
        pelvis=rng.normal(size=(frames, 3)) * 0.3 + np.array([0.0, 0.0, 5.0]),
        orient=orient.as_matrix(),
        pose=mean + 0.5 * spread * rng.normal(size=(frames, *mean.shape)),
        betas=rng.normal(size=10),
    )


def test_points_lie_where_their_names_say(body: BodyModel, points: BodyPoints) -> None:
    rest = body.rest_joints(np.zeros(10))
    place = dict(zip(points.landmarks.tolist(), rest[points.joints] + points.offsets, strict=True))
    vertices = body.rest_vertices(np.zeros(10))
    for left, right in ((7, 8), (29, 30), (31, 32)):
        np.testing.assert_allclose(place[left], place[right] * [-1, 1, 1], atol=0.01)
    assert place[0][2] > rest[JOINT_INDEX["left_eye"], 2] + 0.01
    assert abs(place[0][0]) < 0.02
    assert 0.05 < place[7][0] < 0.12
    assert place[29][2] < rest[JOINT_INDEX["left_ankle"], 2] - 0.02
    assert place[31][2] == pytest.approx(vertices[:, 2].max(), abs=0.02)
    assert max(place[29][1], place[31][1]) < vertices[:, 1].min() + 0.06


def test_the_right_jacobian_is_that_of_the_exponential() -> None:
    rng = np.random.default_rng(0)
    vectors = np.concatenate([rng.normal(size=(5, 3)), np.zeros((1, 3)), 1e-5 * rng.normal(size=(1, 3))])
    for axis in range(3):
        step = 1e-6 * np.eye(3)[axis]
        moved = Rotation.from_rotvec(vectors).inv() * Rotation.from_rotvec(vectors + step)
        found = right_jacobian(vectors)[..., axis]
        np.testing.assert_allclose(found, moved.as_rotvec() / 1e-6, atol=1e-5)


def test_points_move_as_the_linearisation_says(body: BodyModel, points: BodyPoints) -> None:
    state = _state(0, 2)
    rest = body.rest_joints(state.betas)
    placed, moves = linearise(state, points, rest)
    np.testing.assert_allclose(placed, place_points(state, points, rest))
    for unknown in range(NUM_UNKNOWNS):
        step = np.zeros((2, NUM_UNKNOWNS))
        step[:, unknown] = 1e-6
        numeric = (place_points(state.moved(step), points, rest) - placed) / 1e-6
        np.testing.assert_allclose(moves[..., unknown], numeric, atol=1e-5, err_msg=str(unknown))


def _seen(joints: FloatArray, place: FloatArray, points: BodyPoints, noise: float = 0.0) -> LandmarkTrack:
    """Landmarks of a body whose points are at ``place`` (T, N, 3); those that have no point are not seen."""
    T = len(place)
    rng = np.random.default_rng(1)
    pixels, metric = np.zeros((T, NUM_LANDMARKS, 2)), np.zeros((T, NUM_LANDMARKS, 3))
    hips = joints[:, [1, 2]].mean(axis=1, keepdims=True)
    projected = place[..., :2] / place[..., 2:] * 600.0 + np.array([320.0, 180.0])
    pixels[:] = projected.mean(axis=1, keepdims=True)
    pixels[:, points.landmarks] = projected + noise * rng.normal(size=projected.shape)
    # MediaPipe sees a crop: its axes are those of a camera that looks at the person.
    from whacamole.baseline.estimators.first_guess import viewing_turn

    turn = viewing_turn(pixels.mean(axis=1), np.tile(K, (T, 1, 1)))
    metric[:, points.landmarks] = (place - hips) @ turn
    return LandmarkTrack(pixels, np.ones((T, NUM_LANDMARKS)), metric, np.ones(T, dtype=bool))


@pytest.mark.parametrize(("noise", "worst"), [(0.0, 0.03), (2.0, 0.06)])
def test_a_body_is_found_from_its_landmarks(
    body: BodyModel, points: BodyPoints, noise: float, worst: float
) -> None:
    """A dance in front of a camera that stands; joints to centimetres, with a mean shape."""
    scene = true_scene(body, (("dance_a.npz", 0.0),), 60)
    params = replace(scene.world[0], betas=np.zeros(10), transl=scene.world[0].transl)
    upright = Rotation.from_euler("x", 90.0, degrees=True).as_matrix()
    T_camera_world = np.eye(4)
    T_camera_world[:3, :3], T_camera_world[:3, 3] = upright, [0.3, 0.9, 5.0]
    seen = params.transformed(T_camera_world, body.rest_joints(params.betas)[0])
    joints = body.pose_joints(seen)
    place = _place(seen, body, points)
    track = _seen(joints, place, points, noise)
    found = fit_person(1, track, np.tile(K, (60, 1, 1)), body, points)
    assert found.valid.all()
    apart = body.pose_joints(found.params)[:, :22] - joints[:, :22]
    relative = apart - apart[:, :1]
    assert np.linalg.norm(relative, axis=-1).mean() < worst
    assert np.abs(apart[:, 0, 2]).mean() < 0.15


def _place(params: BodyParams, body: BodyModel, points: BodyPoints) -> FloatArray:
    """The points of a posed body (T, N, 3), by its own forward kinematics."""
    from whacamole.body.skinning import forward_kinematics, rotations

    rest = body.rest_joints(params.betas)
    turned, placed = forward_kinematics(rotations(params.full_pose()), rest[None])
    joints = placed + params.transl[:, None]
    return joints[:, points.joints] + np.einsum("tnij,nj->tni", turned[:, points.joints], points.offsets)


def test_the_first_guess_is_near(body: BodyModel, points: BodyPoints) -> None:
    state = replace(_state(3, 4), betas=np.zeros(10))
    rest = body.rest_joints(state.betas)
    state.pose[
        :, [FITTED.index(n) for n in ("spine1", "spine2", "spine3", "left_collar", "right_collar")]
    ] = 0.0
    place = place_points(state, points, rest)
    pixels, metric = np.zeros((4, 33, 2)), np.zeros((4, 33, 3))
    pixels[:, points.landmarks] = place[..., :2] / place[..., 2:] * 600.0 + np.array([320.0, 180.0])
    hips = place[:, np.isin(points.landmarks, (23, 24))].mean(axis=1, keepdims=True)
    metric[:, points.landmarks] = place - hips
    chosen = np.isin(np.arange(33), points.landmarks)
    pixels[:, ~chosen], metric[:, ~chosen] = pixels[:, [23, 24]].mean(axis=1)[:, None], 0.0
    guess = first_guess(metric, pixels, np.tile(K, (4, 1, 1)), body)
    assert np.linalg.norm(guess.pelvis - state.pelvis, axis=-1).max() < 0.15
    apart = place_points(guess, points, rest) - place
    assert np.linalg.norm(apart[:, np.isin(points.landmarks, range(11, 29))], axis=-1).mean() < 0.15
