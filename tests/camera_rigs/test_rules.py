"""For every rule a plan that keeps all of them, and one that breaks this one and no other."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from camera_rigs import RULES, CameraPath, Limits, Obstacle, World, judge, look_at
from camera_rigs.shots.arc import plan_arc
from camera_rigs.shots.pan import plan_pan
from camera_rigs.shots.push_pull import plan_push
from camera_rigs.shots.tracking import plan_tracking


def arc(rig):
    scene = rig.scene(rig.stander(90))
    return plan_arc(scene, rig.whole(scene), rig.view(scene), delta_phi=0.6), scene


def push(rig):
    scene = rig.scene(rig.stander(90))
    return plan_push(scene, rig.whole(scene), rig.view(scene), frac=0.8), scene


def tracking(rig):
    scene = rig.scene(rig.walker(90).rounded())
    return plan_tracking(scene, rig.whole(scene), rig.view(scene, phi=70.0)), scene


def pan(rig):
    scene = rig.scene(rig.walker(60, speed=1.0).rounded())
    return plan_pan(scene, rig.whole(scene), rig.view(scene, theta=88.0, phi=70.0)), scene


def with_parameters(shot, **changes):
    return replace(shot, parameters={**shot.parameters, **changes})


def with_keyframe(shot, index, **changes):
    keyframes = list(shot.keyframes)
    keyframes[index] = replace(keyframes[index], **changes)
    return replace(shot, keyframes=tuple(keyframes))


def moved(path, offset, target):
    """The path displaced by `offset` (T, 3), still looking at `target` (T, 3)."""
    return CameraPath(path.K, look_at(path.location + offset, target), path.fps, path.width, path.height)


def turned(path, rotation):
    """The path with every camera turned in its own axes."""
    pose = path.T_world_camera.copy()
    pose[:, :3, :3] = pose[:, :3, :3] @ Rotation.from_rotvec(rotation).as_matrix()
    return CameraPath(path.K, pose, path.fps, path.width, path.height)


def bump(frames, size, width):
    """A smooth bump (frames, 3) along x."""
    time = np.arange(frames) - frames // 2
    return np.outer(size * np.exp(-0.5 * (time / width) ** 2), [1.0, 0.0, 0.0])


def not_finite(rig):
    draft, scene = arc(rig)
    path = rig.path_of(draft, scene)
    path.T_world_camera[40, 0, 0] = np.nan
    return rig.evidence_of(draft, scene, path=path)


def mirrored(rig):
    draft, scene = arc(rig)
    path = rig.path_of(draft, scene)
    path.T_world_camera[:, :3, 0] *= -1.0
    return rig.evidence_of(draft, scene, path=path)


def not_covered(rig):
    draft, scene = arc(rig)
    return rig.evidence_of(draft, scene, shots=(replace(draft.shot, end=70, keyframes=()),))


def looks_beside(rig):
    draft, scene = arc(rig)
    return rig.evidence_of(draft, scene, path=turned(rig.path_of(draft, scene), [0.0, np.radians(3.0), 0.0]))


def too_narrow(rig):
    draft, scene = arc(rig)
    path = rig.path_of(draft, scene)
    path.K[:, [0, 1], [0, 1]] *= 8.0
    return rig.evidence_of(draft, scene, path=path)


def hidden(rig):
    draft, scene = arc(rig)
    middle = 0.5 * (draft.move.eye[45] + draft.move.target[45])
    screen = Obstacle(tuple(middle), (0.2, 3.0, 3.0), float(np.radians(45.0)), "screen")
    return rig.evidence_of(draft, scene, world=World(obstacles=(screen,)))


def wrong_fraction(rig):
    draft, scene = push(rig)
    return rig.evidence_of(draft, scene, shots=(with_keyframe(draft.shot, -1, frac=0.85),))


def wrong_radius(rig):
    draft, scene = arc(rig)
    wanted = 1.05 * draft.shot.parameters["radius"]
    return rig.evidence_of(draft, scene, shots=(with_parameters(draft.shot, radius=wanted),))


def a_push_that_goes_back(rig):
    draft, scene = push(rig)
    back = bump(90, 0.5, 16.0)[:, :1] * (draft.move.eye - draft.move.target) / 3.0
    return rig.evidence_of(draft, scene, path=moved(rig.path_of(draft, scene), back, draft.move.target))


def uneven_keyframes(rig):
    draft, scene = arc(rig)
    third = draft.shot.keyframes[2]
    return rig.evidence_of(draft, scene, shots=(with_keyframe(draft.shot, 2, frame=third.frame + 3.0),))


def wrong_way(rig):
    draft, scene = arc(rig)
    shot = replace(draft.shot, keyframes=(draft.shot.keyframes[0], draft.shot.keyframes[-1]))
    return rig.evidence_of(draft, scene, shots=(with_parameters(shot, delta_phi=-0.6),))


def off_its_place(rig):
    draft, scene = tracking(rig)
    heading = draft.shot.keyframes[2].heading + np.radians(5.0)
    return rig.evidence_of(draft, scene, shots=(with_keyframe(draft.shot, 2, heading=heading),))


def a_keyframe_missed(rig):
    draft, scene = tracking(rig)
    keyframes = draft.shot.keyframes[:2] + draft.shot.keyframes[3:]
    return rig.evidence_of(draft, scene, shots=(replace(draft.shot, keyframes=keyframes),))


def a_keyframe_too_early(rig):
    scene = rig.scene(rig.stander(90))
    draft = plan_tracking(scene, rig.whole(scene), rig.view(scene))
    first, last = draft.shot.keyframes
    shot = replace(draft.shot, keyframes=(first, replace(first, frame=40.0), last))
    return rig.evidence_of(draft, scene, shots=(shot,))


def a_pan_that_drifts(rig):
    draft, scene = pan(rig)
    path = moved(rig.path_of(draft, scene), bump(60, 0.03, 12.0), draft.move.target)
    return rig.evidence_of(draft, scene, path=path)


def tilted(rig):
    draft, scene = arc(rig)
    return rig.evidence_of(draft, scene, path=turned(rig.path_of(draft, scene), [0.0, 0.0, np.radians(2.0)]))


def under_ground(rig):
    draft, scene = arc(rig)
    return rig.evidence_of(draft, scene, world=World(ground_z=float(draft.move.eye[:, 2].min()) - 0.05))


def beside_a_column(rig):
    draft, scene = arc(rig)
    away = draft.move.eye[30] - draft.move.target[30]
    place = draft.move.eye[30] + 0.2 * away / np.linalg.norm(away)
    return rig.evidence_of(draft, scene, world=World(obstacles=(Obstacle(tuple(place), (0.2, 0.2, 0.2)),)))


def through_the_wall(rig):
    draft, scene = arc(rig)
    x = float(draft.move.eye[:, 0].max())
    return rig.evidence_of(draft, scene, world=World(bounds=((-9.0, -9.0, 0.0), (x, 9.0, 9.0))))


def touching(rig):
    draft, scene = arc(rig)
    people = scene.subject
    reach = people.people_box_max.copy()
    reach[0, 40, :2] = draft.move.eye[40, :2] - 0.1
    reach[0, 40, 2] = draft.move.eye[40, 2]
    return rig.evidence_of(draft, scene, subject=replace(people, people_box_max=reach))


def limits_broken_by(quantity):
    """An arc with a limit that it breaks; the other limits are as they are."""

    def evidence(rig):
        draft, scene = arc(rig)
        wave = np.outer(0.15 * np.sin(2.0 * np.pi * 0.4 * np.arange(90) / rig.fps), [0.0, 0.0, 1.0])
        path = moved(rig.path_of(draft, scene), wave, draft.move.target)
        shot = replace(draft.shot, kind="dolly")  # promises no radius
        return rig.evidence_of(
            draft, scene, path=path, shots=(shot,), limits=replace(Limits(), **{quantity: 0.05})
        )

    return evidence


def trembling(rig):
    """A millimetre up and down from frame to frame: no acceleration to speak of, but a jerk."""
    draft, scene = arc(rig)
    tremor = np.outer(np.where(np.arange(90) % 2, 0.0008, -0.0008), [0.0, 0.0, 1.0])
    return rig.evidence_of(draft, scene, path=moved(rig.path_of(draft, scene), tremor, draft.move.target))


def zooming(rig):
    draft, scene = arc(rig)
    path = rig.path_of(draft, scene)
    path.K[45:, [0, 1], [0, 1]] *= 1.1
    return rig.evidence_of(draft, scene, path=path)


BROKEN = [
    ("finite", not_finite),
    ("finite", mirrored),
    ("coverage", not_covered),
    ("look-at", looks_beside),
    ("in-frame", too_narrow),
    ("occlusion", hidden),
    ("fraction", wrong_fraction),
    ("radius", wrong_radius),
    ("radius", a_push_that_goes_back),
    ("equal-spacing", uneven_keyframes),
    ("monotone-angle", wrong_way),
    ("tracking-place", off_its_place),
    ("overlap", a_keyframe_missed),
    ("overlap", a_keyframe_too_early),
    ("fixed-location", a_pan_that_drifts),
    ("horizon", tilted),
    ("ground", under_ground),
    ("obstacle", beside_a_column),
    ("wall", through_the_wall),
    ("person", touching),
    ("speed", limits_broken_by("speed")),
    ("acceleration", limits_broken_by("acceleration")),
    ("jerk", limits_broken_by("jerk")),
    ("jerk", trembling),
    ("turn", limits_broken_by("turn")),
    ("zoom", zooming),
]


@pytest.mark.parametrize("plan", [arc, push, tracking, pan])
def test_good_plans_break_no_rule(rig, plan):
    assert judge(rig.evidence_of(*plan(rig))) == ()


@pytest.mark.parametrize(("rule", "broken"), BROKEN, ids=[f"{rule}-{f.__name__}" for rule, f in BROKEN])
def test_a_broken_plan_is_caught_by_the_rule_meant_for_it_and_by_no_other(rig, rule, broken):
    findings = judge(broken(rig))
    assert {finding.rule for finding in findings} == {rule}
    for finding in findings:
        assert rule in finding.message
        assert "\n" not in finding.message
        assert finding.value != finding.limit


def test_every_rule_has_a_broken_plan_and_says_what_it_demands():
    assert {rule.name for rule in RULES} == {rule for rule, _ in BROKEN}
    assert all(rule.demands for rule in RULES)


def test_a_finding_names_the_worst_frame(rig):
    draft, scene = arc(rig)
    path = rig.path_of(draft, scene)
    path.T_world_camera[:, :3, :3] = turned(path, bump(90, np.radians(4.0), 6.0)[:, ::-1]).T_world_camera[
        :, :3, :3
    ]
    finding = judge(rig.evidence_of(draft, scene, path=path))[0]
    assert finding.rule == "horizon"
    assert finding.frame == 45
    assert finding.value == pytest.approx(4.0, rel=0.02)
    assert finding.limit == Limits().horizon


def test_a_window_is_judged_like_the_whole(rig):
    draft, scene = arc(rig)
    path = turned(rig.path_of(draft, scene), [0.0, 0.0, np.radians(2.0)])
    part = CameraPath(path.K[20:60], path.T_world_camera[20:60], path.fps, path.width, path.height)
    findings = judge(rig.evidence_of(draft, scene, path=part, first=20))
    assert [f.rule for f in findings] == ["horizon"]
    assert 20 <= findings[0].frame < 60


@pytest.mark.parametrize("frames", [1, 2, 3])
def test_the_shortest_clips_are_judged(rig, frames):
    scene = rig.scene(rig.stander(frames))
    draft = plan_arc(scene, rig.whole(scene), rig.view(scene), delta_phi=0.02)
    assert judge(rig.evidence_of(draft, scene)) == ()
    path = rig.path_of(draft, scene)
    outward = moved(path, np.zeros((frames, 3)), path.location - path.forward)
    away = rig.evidence_of(draft, scene, path=outward)
    assert {f.rule for f in judge(away)} == {"look-at", "in-frame"}
