"""Arc, push, pull, tracking and pan, from their equations."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from camera_rigs import PlanError
from camera_rigs.scene import SCALES
from camera_rigs.shots.arc import plan_arc, plan_arc_vertical_rand
from camera_rigs.shots.pan import plan_pan
from camera_rigs.shots.push_pull import plan_pull, plan_push, plan_push_pull
from camera_rigs.shots.tracking import box_overlap, overlap_keyframes, plan_tracking
from camera_rigs.spherical import cartesian_to_spherical, spherical_to_cartesian


def about_anchor(draft, scene, anchor="pelvis"):
    """(r, θ, φ unwrapped) of the camera per frame."""
    r, theta, phi = cartesian_to_spherical(draft.move.eye - scene.subject.anchor(anchor))
    return r, theta, np.unwrap(phi)


def test_the_location_is_the_equation_of_the_paper(rig):
    scene = rig.scene(rig.subject_of(rig.person(np.zeros((30, 2)), 1.1)))
    view = rig.view(scene, theta=75.0, phi=40.0)
    expected = scene.subject.smooth_pelvis[0] + spherical_to_cartesian(
        view.r, np.radians(75.0), np.radians(40.0) + 1.1
    )
    np.testing.assert_allclose(view.location(scene, 0), expected)


@pytest.mark.parametrize(
    ("scale", "anchor"), [("full", "pelvis"), ("long", "pelvis"), ("medium", "neck"), ("close-up", "neck")]
)
def test_the_anchor_of_a_scale_is_in_the_middle_of_the_image(rig, scale, anchor):
    scene = rig.scene(rig.stander())
    draft = plan_arc(scene, rig.whole(scene), rig.view(scene, scale, SCALES[scale].frac_min), delta_phi=0.5)
    pixels, _ = rig.path_of(draft, scene).project(getattr(scene.subject, anchor))
    np.testing.assert_allclose(pixels, np.tile([320.0, 180.0], (90, 1)), atol=1e-6)


@pytest.mark.parametrize("delta", [0.9, -0.9])
def test_a_horizontal_arc(rig, delta):
    scene = rig.scene(rig.stander())
    view = rig.view(scene)
    draft = plan_arc(scene, rig.whole(scene), view, delta_phi=delta)
    r, theta, phi = about_anchor(draft, scene)
    np.testing.assert_allclose(r, view.r)
    np.testing.assert_allclose(theta, view.theta)
    np.testing.assert_allclose(phi, view.phi + delta * np.arange(90) / 89.0)
    steps = np.diff([k.phi for k in draft.shot.keyframes])
    np.testing.assert_allclose(steps, delta / (len(steps)))


def test_a_vertical_arc_with_cushions_keeps_its_keyframes_equally_spaced(rig):
    scene = rig.scene(rig.stander())
    span = replace(rig.whole(scene), ease_in=20.0, ease_out=30.0)
    draft = plan_arc(scene, span, rig.view(scene, theta=95.0), delta_theta=-0.6, kind="arc-vertical")
    np.testing.assert_allclose(np.diff([k.theta for k in draft.shot.keyframes]), -0.1, atol=1e-4)
    _, theta, _ = about_anchor(draft, scene)
    assert (np.diff(theta) <= 0.0).all()
    assert abs(np.diff(theta)[0]) < 0.01 * np.abs(np.diff(theta)).max()


def test_an_arc_is_not_dragged_along_by_a_spin(rig):
    scene = rig.scene(rig.dancer(90, sway=0.0, spin=9.0))
    draft = plan_arc(scene, rig.whole(scene), rig.view(scene), delta_phi=0.5)
    _, _, phi = about_anchor(draft, scene)
    assert np.ptp(phi) == pytest.approx(0.5)


def test_an_arc_that_pushes_and_pulls_fills_the_fractions(rig):
    scene = rig.scene(rig.stander(121))
    draft = plan_arc(scene, rig.whole(scene), rig.view(scene), delta_phi=0.5, fracs=[0.8, 0.55])
    pixels, _ = rig.path_of(draft, scene).project(head_and_feet(rig, 121))
    filled = (pixels[:, 1, 1] - pixels[:, 0, 1]) / 360.0
    assert filled[60] == pytest.approx(0.8, rel=0.02)
    assert filled[120] == pytest.approx(0.55, rel=0.02)


def test_an_arc_in_both_angles_at_once_is_refused(rig):
    scene = rig.scene(rig.stander())
    with pytest.raises(PlanError, match="not both"):
        plan_arc(scene, rig.whole(scene), rig.view(scene), delta_phi=0.1, delta_theta=0.1)


def test_vertical_arcs_pass_between_high_eye_level_and_low_angles(rig):
    scene = rig.scene(rig.stander(150))
    ends = []
    for seed in range(30):
        view = rig.view(scene, theta=86.0)
        draft = plan_arc_vertical_rand(np.random.default_rng(seed), scene, rig.whole(scene), view)
        ends.append(draft.shot.keyframes[-1].theta)
    assert min(ends) < np.radians(66.0)
    assert max(ends) > np.radians(94.0)


@pytest.mark.parametrize("size", [(640, 360), (360, 640), (512, 512), (1000, 400)])
@pytest.mark.parametrize("theta", [60.0, 90.0, 100.0])
@pytest.mark.parametrize("scale", SCALES)
def test_push_and_pull_fill_the_fraction_within_two_percent(rig, size, scale, theta):
    """The projected height at the keyframe that asks for it: of the person, or, where only a part is shown,
    of a rod as long as the person held square to the view at the neck."""
    scene = rig.scene(rig.stander(half_width=0.05), lens=rig.lens(*size, millimetres=50.0))
    low, high = SCALES[scale].frac_min, 0.9 * SCALES[scale].frac_max
    for planner, start, frac in ((plan_push, low, high), (plan_pull, high, low)):
        draft = planner(scene, rig.whole(scene), rig.view(scene, scale, start, theta), frac=frac)
        path = rig.path_of(draft, scene)
        ends = head_and_feet(rig, 90)
        if SCALES[scale].anchor == "neck":
            rod = 0.5 * rig.height * path.T_world_camera[:, None, :3, 1]
            neck = scene.subject.neck[:, None]
            ends = np.concatenate([neck - rod, neck + rod], axis=1)
        pixels, _ = path.project(ends)
        filled = (pixels[-1, 1, 1] - pixels[-1, 0, 1]) / size[1]
        assert filled == pytest.approx(frac, rel=0.02)
        assert draft.shot.keyframes[-1].frac == pytest.approx(frac)


@pytest.mark.parametrize("theta", [40.0, 60.0, 90.0, 105.0])
def test_a_medium_shot_is_one_from_any_angle(rig, theta):
    """Head and hips (0.52 m below the neck) are in the view at a fraction of 1.5, from high above as well."""
    scene = rig.scene(rig.stander(), lens=rig.lens(640, 360, millimetres=35.0))
    view = rig.view(scene, "medium", 1.5, theta)
    draft = plan_push_pull(scene, rig.whole(scene), view, fracs=[1.5, 1.5])
    neck = scene.subject.neck
    points = neck[:, None] + np.array([[0.0, 0.0, 0.25], [0.0, 0.0, -0.52]])
    pixels, depth = rig.path_of(draft, scene).project(points)
    assert (depth > 0.5).all()
    assert ((pixels[..., 1] > 0.0) & (pixels[..., 1] < 360.0)).all()


def head_and_feet(rig, frames):
    """The ends (frames, 2, 3) of a person who stands at the origin."""
    return np.tile([[0.0, 0.0, rig.height], [0.0, 0.0, 0.0]], (frames, 1, 1))


def test_a_push_only_comes_nearer_and_a_pull_only_goes(rig):
    scene = rig.scene(rig.dancer())
    span = rig.whole(scene)
    near, _, _ = about_anchor(plan_push(scene, span, rig.view(scene, frac=0.55), frac=0.8), scene)
    far, _, _ = about_anchor(plan_pull(scene, span, rig.view(scene, frac=0.8), frac=0.55), scene)
    assert (np.diff(near) < 0.0).all()
    assert (np.diff(far) > 0.0).all()
    with pytest.raises(PlanError, match="use a pull"):
        plan_push(scene, span, rig.view(scene, frac=0.8), frac=0.6)
    with pytest.raises(PlanError, match="use a push"):
        plan_pull(scene, span, rig.view(scene, frac=0.6), frac=0.8)


def test_a_push_pull_turns_at_its_keyframes(rig):
    scene = rig.scene(rig.stander(181))
    draft = plan_push_pull(scene, rig.whole(scene), rig.view(scene, frac=0.6), fracs=[0.8, 0.55, 0.7])
    r, _, _ = about_anchor(draft, scene)
    speed = np.abs(np.diff(r))
    assert speed[[60, 120]].max() < 0.02 * speed.max()
    assert [k.frac for k in draft.shot.keyframes] == [None, *(pytest.approx(f) for f in (0.8, 0.55, 0.7))]


def test_where_the_width_binds_the_fraction_is_the_smaller_one_that_is_reached(rig):
    scene = rig.scene(rig.pair(apart=4.0), lens=rig.lens(360, 640))
    r, frac = scene.framing(0, 0.8, np.pi / 2.0, SCALES["full"], scene.lens.focal)
    assert frac < 0.6
    width = scene.subject.span[0] * scene.lens.focal / r
    assert width == pytest.approx(0.9 * 360.0)


def test_tracking_keeps_its_place(rig):
    scene = rig.scene(rig.walker(120))
    view = rig.view(scene, phi=70.0)
    draft = plan_tracking(scene, rig.whole(scene), view)
    r, theta, phi = about_anchor(draft, scene)
    np.testing.assert_allclose(r, view.r)
    np.testing.assert_allclose(theta, view.theta)
    np.testing.assert_allclose(phi, view.phi, atol=1e-9)
    for k in draft.shot.keyframes:
        np.testing.assert_allclose((k.r, k.theta, k.phi), (view.r, view.theta, view.phi), atol=1e-9)


def test_tracking_turns_with_the_facing_at_its_keyframes(rig):
    scene = rig.scene(rig.turner(180, speed=0.8, radius=3.0))
    view = rig.view(scene, phi=70.0)
    draft = plan_tracking(scene, rig.whole(scene), view)
    assert abs(draft.shot.keyframes[-1].heading - draft.shot.keyframes[0].heading) > 0.5
    np.testing.assert_allclose([k.phi for k in draft.shot.keyframes], draft.shot.parameters["phi"], atol=1e-9)
    still = plan_tracking(scene, rig.whole(scene), view, max_turn=0.0)
    assert np.ptp(about_anchor(still, scene)[2]) < 1e-9


def test_a_keyframe_is_set_when_the_overlap_falls_below_lambda(rig):
    subject = rig.walker(150, speed=1.2).rounded()
    frames = overlap_keyframes(subject, 0, 149, 0.5)
    assert frames[0] == 0
    assert frames[-1] == 149
    assert len(frames) > 4
    for last, fresh in itertools.pairwise(frames[:-1]):
        overlap = box_overlap(subject, last, last, fresh + 1)
        assert overlap[-1] < 0.5
        assert (overlap[15:-1] >= 0.5).all(), "none was missed once the least time was over"


def test_nobody_who_stands_gets_keyframes(rig):
    assert overlap_keyframes(rig.stander(300), 0, 299, 0.5) == [0, 299]


def test_the_overlap_of_boxes_is_intersection_over_union(rig):
    subject = rig.walker(31, speed=0.3)  # 0.3 m on, of a box 0.6 m wide: half of it is common
    np.testing.assert_allclose(box_overlap(subject, 0, 0, 31)[[0, -1]], [1.0, 1.0 / 3.0])


def test_a_pan_stays_and_turns_level(rig):
    scene = rig.scene(rig.walker(90, speed=1.0))
    draft = plan_pan(scene, rig.whole(scene), rig.view(scene, theta=88.0, phi=70.0))
    path = rig.path_of(draft, scene)
    assert np.ptp(path.location, axis=0).max() == 0.0
    towards = scene.subject.smooth_pelvis - path.location
    np.testing.assert_allclose(
        np.arctan2(path.forward[:, 1], path.forward[:, 0]),
        np.arctan2(towards[:, 1], towards[:, 0]),
        atol=1e-9,
    )
    assert np.ptp(path.forward[:, 2]) < 1e-12, "it turns horizontally only"
    assert draft.shot.parameters["tilt"] is False


def test_a_pan_from_above_tilts_after_someone_who_walks_away(rig):
    scene = rig.scene(rig.walker(150, speed=2.0))
    draft = plan_pan(scene, rig.whole(scene), rig.view(scene, theta=60.0, phi=180.0))
    assert draft.shot.parameters["tilt"] is True
    pixels, _ = rig.path_of(draft, scene).project(scene.subject.smooth_pelvis)
    np.testing.assert_allclose(pixels, np.tile([320.0, 180.0], (150, 1)), atol=1e-6)
