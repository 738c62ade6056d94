"""Static, orbit, boom, dolly, dolly zoom, follow, over the shoulder."""

import numpy as np
import pytest

from camera_rigs import SCALES, PlanError
from camera_rigs.scene import View
from camera_rigs.shots.boom import plan_boom, plan_boom_rand
from camera_rigs.shots.dolly import plan_dolly, plan_dolly_rand
from camera_rigs.shots.dolly_zoom import FOCAL_RATIO, plan_dolly_zoom, plan_dolly_zoom_rand
from camera_rigs.shots.follow import MAX_LEAD, plan_follow
from camera_rigs.shots.orbit import plan_orbit
from camera_rigs.shots.over_shoulder import (
    Shoulder,
    plan_over_shoulder,
    plan_over_shoulder_rand,
    refuse_over_shoulder,
    shoulder_place,
)
from camera_rigs.shots.static import plan_static


def test_a_static_camera_neither_moves_nor_turns(rig):
    scene = rig.scene(rig.dancer())
    path = rig.path_of(plan_static(scene, rig.whole(scene), rig.view(scene)), scene)
    assert np.ptp(path.T_world_camera, axis=0).max() == 0.0


def test_an_orbit_by_a_full_turn_comes_back(rig):
    scene = rig.scene(rig.stander())
    draft = plan_orbit(scene, rig.whole(scene), rig.view(scene), angle=2.0 * np.pi)
    np.testing.assert_allclose(draft.move.eye[0], draft.move.eye[-1], atol=1e-9)
    around = draft.move.eye - scene.subject.smooth_pelvis
    turned = np.unwrap(np.arctan2(around[:, 1], around[:, 0]))
    assert turned[-1] - turned[0] == pytest.approx(2.0 * np.pi)


def test_a_boom_rises_upright(rig):
    scene = rig.scene(rig.stander())
    draft = plan_boom(scene, rig.whole(scene), rig.view(scene), height=1.2)
    np.testing.assert_allclose(draft.move.eye[:, :2], np.tile(draft.move.eye[0, :2], (90, 1)))
    assert draft.move.eye[-1, 2] - draft.move.eye[0, 2] == pytest.approx(1.2)


def test_a_boom_travels_with_a_walker_and_not_with_the_bounce(rig):
    scene = rig.scene(rig.walker(90))
    eye = plan_boom(scene, rig.whole(scene), rig.view(scene), height=0.5).move.eye
    np.testing.assert_allclose(eye[:, 0] - eye[0, 0], scene.subject.pelvis[:, 0], atol=1e-9)
    np.testing.assert_allclose(np.diff(eye[:, 2]), 0.5 / 89.0)


def test_a_boom_goes_where_there_is_room(rig):
    scene = rig.scene(rig.stander(60), ground_z=0.62)
    view = View(SCALES["full"], 3.0, np.radians(95.0), 0.0, 500.0)  # just over the ground
    for seed in range(20):
        draft = plan_boom_rand(np.random.default_rng(seed), scene, rig.whole(scene), view)
        assert draft.move.eye[-1, 2] > draft.move.eye[0, 2]
    low = View(SCALES["full"], 0.05, np.radians(89.0), 0.0, 500.0)
    with pytest.raises(PlanError, match="no room"):
        plan_boom_rand(
            np.random.default_rng(0), rig.scene(rig.stander(60), ground_z=0.8), rig.whole(scene), low
        )


def test_a_dolly_rolls_on_a_straight_level_track(rig):
    scene = rig.scene(rig.dancer())
    draft = plan_dolly(scene, rig.whole(scene), rig.view(scene), azimuth=0.3, distance=1.5)
    way = draft.move.eye - draft.move.eye[0]
    np.testing.assert_allclose(
        way, np.outer(np.arange(150) / 149.0, [1.5 * np.cos(0.3), 1.5 * np.sin(0.3), 0.0])
    )
    np.testing.assert_array_equal(draft.move.target, scene.subject.smooth_pelvis)


def test_the_track_lies_along_the_way_of_a_walker_and_across_the_view_of_others(rig):
    rng = np.random.default_rng(0)
    scene = rig.scene(rig.walker(90))
    draft = plan_dolly_rand(rng, scene, rig.whole(scene), rig.view(scene))
    assert draft.shot.parameters["azimuth"] == pytest.approx(0.0, abs=1e-9)
    scene = rig.scene(rig.stander())
    draft = plan_dolly_rand(rng, scene, rig.whole(scene), rig.view(scene))
    along, towards = draft.move.eye[-1] - draft.move.eye[0], draft.move.target[0] - draft.move.eye[0]
    assert along @ towards == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("theta", [60.0, 88.0])
@pytest.mark.parametrize("factor", [0.6, 1.6])
def test_a_dolly_zoom_holds_the_size_while_the_lens_changes(rig, theta, factor):
    scene = rig.scene(rig.stander())
    view = rig.view(scene, theta=theta)
    path = rig.path_of(plan_dolly_zoom(scene, rig.whole(scene), view, radius=factor * view.r), scene)
    pixels, depth = path.project(np.tile([[0.0, 0.0, rig.height], [0.0, 0.0, 0.0]], (90, 1, 1)))
    height = pixels[:, 1, 1] - pixels[:, 0, 1]
    np.testing.assert_allclose(height, height[0], rtol=1e-6)
    assert path.focal[-1] / path.focal[0] == pytest.approx(factor, rel=0.1)
    behind, _ = path.project(scene.subject.smooth_pelvis + 4.0 * path.forward)
    assert depth[-1].mean() != pytest.approx(depth[0].mean(), rel=0.1)
    np.testing.assert_allclose(behind, np.tile([320.0, 180.0], (90, 1)), atol=1e-6)


def test_a_dolly_zoom_stays_within_the_range_of_a_zoom_lens(rig):
    scene = rig.scene(rig.stander(150))
    view = rig.view(scene)
    for seed in range(40):
        try:
            draft = plan_dolly_zoom_rand(np.random.default_rng(seed), scene, rig.whole(scene), view)
        except PlanError:
            continue
        focal = draft.shot.keyframes[-1].focal
        view = View(view.scale, draft.shot.keyframes[-1].r, view.theta, view.phi, focal)
        assert 0.9 * FOCAL_RATIO[0] < focal / scene.lens.focal < 1.1 * FOCAL_RATIO[1]


def test_a_follow_looks_ahead_of_a_walker(rig):
    scene = rig.scene(rig.walker(120, speed=1.0))
    draft = plan_follow(scene, rig.whole(scene), rig.view(scene, phi=180.0), look_ahead=0.4)
    lead = draft.move.target - scene.subject.smooth_pelvis
    np.testing.assert_allclose(
        lead, np.tile([0.4 / np.hypot(1.0, 0.4 / MAX_LEAD), 0.0, 0.0], (120, 1)), atol=1e-6
    )


def test_a_follow_swings_into_a_new_direction_instead_of_whipping_round(rig):
    way = np.concatenate([np.column_stack([0.05 * np.arange(90), np.zeros(90)]), np.zeros((60, 2))])
    way[90:] = way[89] + np.column_stack([np.zeros(60), 0.05 * np.arange(1, 61)])
    scene = rig.scene(rig.subject_of(rig.person(way, 0.0)))
    path = rig.path_of(plan_follow(scene, rig.whole(scene), rig.view(scene, phi=180.0)), scene)
    azimuth = np.unwrap(np.arctan2(path.forward[:, 1], path.forward[:, 0]))
    assert np.abs(np.diff(azimuth)).max() * rig.fps < np.radians(45.0)
    assert azimuth[-1] - azimuth[0] > np.radians(30.0)


def test_over_the_shoulder_is_behind_one_and_looks_at_the_other(rig):
    scene = rig.scene(rig.pair(apart=1.6))
    shoulder = Shoulder(person=0, side=1, behind=1.0, beside=0.5)
    place = shoulder_place(scene, shoulder, 0, 0)[0]
    near = scene.subject.people_neck[0, 0]
    # The first person stands at x = −0.8 and looks along +x: behind is −x, the right hand is at −y.
    np.testing.assert_allclose(place - near, [-1.0, -0.5, 0.15], atol=1e-6)
    view = View.from_location(scene, 0, place, SCALES["medium"], scene.lens.focal)
    path = rig.path_of(plan_over_shoulder(scene, rig.whole(scene), view, shoulder=shoulder), scene)
    pixels, depth = path.project(scene.subject.people_neck.transpose(1, 0, 2))
    np.testing.assert_allclose(pixels[-1, 1], [320.0, 180.0], atol=1e-6)
    assert depth[-1, 0] < depth[-1, 1]
    assert pixels[-1, 0, 0] < 320.0, "past the right shoulder the near person is on the left"


def test_over_the_shoulder_travels_there_in_time(rig):
    scene = rig.scene(rig.pair(frames=150, apart=1.6))
    shoulder = Shoulder(person=1, side=-1, behind=1.0, beside=0.5)
    view = rig.view(scene, "medium", 1.2, 85.0, 30.0)
    draft = plan_over_shoulder(scene, rig.whole(scene), view, shoulder=shoulder)
    np.testing.assert_allclose(draft.move.eye[0], view.location(scene, 0))
    np.testing.assert_allclose(draft.move.eye[-1], shoulder_place(scene, shoulder, 149, 149)[0], atol=1e-9)


def test_over_the_shoulder_needs_a_pair(rig):
    assert "two people" in refuse_over_shoulder(rig.scene(rig.stander()))
    assert "apart" in refuse_over_shoulder(rig.scene(rig.pair(apart=6.0)))
    assert refuse_over_shoulder(rig.scene(rig.pair())) is None
    scene = rig.scene(rig.stander())
    with pytest.raises(PlanError, match="two people"):
        plan_over_shoulder(scene, rig.whole(scene), rig.view(scene), shoulder=Shoulder(0, 1, 1.0, 0.5))


def test_a_shoulder_too_far_away_is_refused(rig):
    scene = rig.scene(rig.pair(frames=20))
    with pytest.raises(PlanError, match="too far away"):
        plan_over_shoulder_rand(
            np.random.default_rng(0), scene, rig.whole(scene), rig.view(scene, "long", 0.3)
        )
