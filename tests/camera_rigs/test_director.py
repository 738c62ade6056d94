"""Which shot when, by the rule of the paper; and whole plans."""

import itertools
from collections import Counter

import numpy as np
import pytest

from camera_rigs import GROUPS, KINDS, SCALES, PlanError, Shake, Style, World, direct, resolve_shots
from camera_rigs.director import Director
from camera_rigs.joins import spans_between


def plan(rig, subject, shots="auto", seed=0, lens=None, world=None, **options):
    return direct(
        subject, lens or rig.lens(), world or World(), shots, np.random.default_rng(seed), **options
    )


def director(rig, subject, shots="auto", **options):
    scene = rig.scene(subject)
    interactive = options.pop("interactive", subject.num_people > 1)
    return Director(scene, Style(**options), resolve_shots(shots), interactive), rig.whole(scene)


def kinds(plans):
    return Counter(shot.kind for p in plans for shot in p.shots)


def test_the_paper_s_rule(rig):
    cases = [
        (rig.stander(), "static"),
        (rig.walker(90, speed=0.4), "static"),
        (rig.walker(90, speed=0.6), "travelling"),
        (rig.turner(150, speed=1.4, radius=1.5), "turning"),
        (rig.turner(90, speed=1.0, radius=5.0), "travelling"),
    ]
    for subject, situation in cases:
        chooser, span = director(rig, subject)
        assert chooser.situation(span) == situation


def test_the_lambdas_move_the_borders(rig):
    chooser, span = director(rig, rig.walker(90, speed=1.0), lambda_bbox=4.0)
    assert chooser.situation(span) == "static"
    chooser, span = director(rig, rig.turner(90, speed=1.0, radius=5.0), lambda_angle=np.radians(5.0))
    assert chooser.situation(span) == "turning"


def test_people_who_act_on_each_other_are_static_however_far_they_go(rig):
    subject = rig.walker(90, speed=3.0)
    assert director(rig, subject, interactive=True)[0].situation(rig.whole(rig.scene(subject))) == "static"


def test_a_long_clip_is_asked_shot_by_shot(rig):
    way = np.concatenate([np.zeros((300, 2)), np.column_stack([0.05 * np.arange(300), np.zeros(300)])])
    chooser, _ = director(rig, rig.subject_of(rig.person(way, 0.0)))
    first, *_, last = spans_between([0, 90, 500, 599], 30.0)
    assert (chooser.situation(first), chooser.situation(last)) == ("static", "travelling")


def test_static_motion_gets_arcs_and_long_distance_tracking_or_pan(rig):
    static = kinds(plan(rig, rig.dancer(300), seed=seed) for seed in range(25))
    assert set(static) <= {"arc-horizontal", "arc-vertical", "push", "pull", "push-pull"}
    assert static["arc-horizontal"] + static["arc-vertical"] > 0.7 * static.total()
    straight = kinds(plan(rig, rig.walker(150), seed=seed) for seed in range(25))
    assert straight["tracking"] > 0.5 * straight.total()
    assert straight["pan"] == 0
    circle = kinds(plan(rig, rig.turner(200, radius=1.2), seed=seed) for seed in range(10))
    assert circle["pan"] > 0


def test_a_clip_passes_through_several_angles(rig):
    spans = []
    for seed in range(30):
        path = plan(rig, rig.dancer(300), seed=seed).path
        spans.append(np.degrees(np.ptp(np.arcsin(path.forward[:, 2]))))
    assert np.median(spans) > 15.0


def test_closer_shots_are_not_taken_from_steeply_above(rig):
    steepest = {"pelvis": 0.0, "neck": 0.0}
    for seed in range(40):
        made = plan(rig, rig.dancer(120), "boom,arc-vertical", seed=seed)
        for shot in made.shots:
            anchor = SCALES[shot.scale].anchor
            frames = slice(shot.start, shot.end + 1)
            offset = made.path.location[frames] - made.subject.anchor(anchor)[frames]
            rise = np.degrees(np.arcsin(offset[:, 2] / np.linalg.norm(offset, axis=1))).max()
            steepest[anchor] = max(steepest[anchor], rise)
    assert 20.0 < steepest["neck"] < 28.5
    assert 40.0 < steepest["pelvis"] < 55.5


@pytest.mark.parametrize("shots", sorted(KINDS))
def test_a_kind_that_is_asked_for_is_shown(rig, shots):
    needs_pair, travels = shots == "over-shoulder", KINDS[shots].min_travel > 0.0
    subject = rig.pair(90) if needs_pair else rig.walker(90, speed=1.0) if travels else rig.stander(90)
    shown = kinds(plan(rig, subject, [shots], seed=seed) for seed in range(5))
    assert shown[shots] >= 0.8 * shown.total()


def test_shots_are_named_by_lists_and_groups():
    assert resolve_shots("arc,tracking") == ("arc-horizontal", "arc-vertical", "tracking")
    assert resolve_shots(["pan", "pan"]) == ("pan",)
    assert resolve_shots("auto") == GROUPS["auto"]
    assert set(resolve_shots("all")) == set(KINDS)
    for wrong in ("wobble", "", []):
        with pytest.raises(PlanError, match="choose from"):
            resolve_shots(wrong)


def test_shots_that_cannot_apply_say_so(rig):
    made = plan(rig, rig.stander(), "arc,tracking,over-shoulder")
    assert set(made.refusals) == {"tracking", "over-shoulder"}
    assert "cover" in made.refusals["tracking"]
    with pytest.raises(PlanError, match=r"none of the shots.*tracking needs people who cover 0.5 m"):
        plan(rig, rig.stander(), "tracking")
    assert not plan(rig, rig.stander(), "auto").refusals, "auto chooses; nothing was asked for by name"


@pytest.mark.parametrize("frames", [1, 2, 3, 5, 24, 60])
@pytest.mark.parametrize("shots", ["auto", "all"])
def test_the_shortest_clips(rig, frames, shots):
    for subject in (rig.stander(frames), rig.walker(frames), rig.pair(frames)):
        made = plan(rig, subject, shots, seed=frames)
        assert made.ok
        assert made.path.num_frames == frames
        assert len(made.shots) == 1


def test_someone_who_walks_twenty_metres(rig):
    for seed in range(5):
        made = plan(rig, rig.walker(430, speed=1.4), seed=seed)
        assert made.ok
        assert len(made.shots) >= 3


def test_equal_seeds_make_equal_plans(rig):
    first, second = (plan(rig, rig.dancer(), "all", seed=7) for _ in range(2))
    np.testing.assert_array_equal(first.path.T_world_camera, second.path.T_world_camera)
    assert first.to_json() == second.to_json()
    assert plan(rig, rig.dancer(), "all", seed=8).to_json() != first.to_json()


def test_shots_follow_each_other_without_a_jump(rig):
    for seed in range(10):
        made = plan(rig, rig.dancer(300), "all", seed=seed)
        location = made.path.location
        velocity = np.linalg.norm(np.diff(location, axis=0), axis=1) * rig.fps
        assert np.abs(np.diff(velocity)).max() * rig.fps < 10.0
        for before, after in itertools.pairwise(made.shots):
            assert before.end == after.start


def test_the_style_is_obeyed(rig):
    turns = Style(options={"orbit": {"angle": (1.0, 1.0)}}, scales=("long",))
    made = plan(rig, rig.stander(150), "orbit", style=turns)
    assert made.shots[0].scale == "long"
    assert abs(made.shots[0].parameters["delta_phi"]) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"scales": ("huge",)}, "choose from long, full"),
        ({"options": {"wobble": {}}}, "choose from arc-horizontal"),
        ({"options": {"orbit": {"speed": 1}}}, "it has angle"),
    ],
)
def test_a_style_that_cannot_be_is_refused(options, message):
    with pytest.raises(PlanError, match=message):
        Style(**options)


def test_a_hand_held_plan_shakes_and_keeps_the_rules(rig):
    still = plan(rig, rig.stander(150), "static")
    held = plan(rig, rig.stander(150), "static", shake=Shake(6.0, 0.3))
    assert held.ok
    assert np.ptp(still.path.location, axis=0).max() == 0.0
    moved = held.path.location - held.path.location.mean(axis=0)
    assert 2.0 < moved.std(axis=0).mean() * 1000.0 < 12.0
    assert held.to_json()["shake"]["millimetres"] == 6.0


def test_a_dolly_zoom_changes_the_intrinsics_per_frame(rig):
    path = plan(rig, rig.stander(90), "dolly-zoom").path
    assert abs(path.focal[-1] / path.focal[0] - 1.0) > 0.05
    np.testing.assert_array_equal(path.K[:, 0, 0], path.K[:, 1, 1])
    np.testing.assert_array_equal(path.K[:, :2, 2], np.tile([320.0, 180.0], (90, 1)))
