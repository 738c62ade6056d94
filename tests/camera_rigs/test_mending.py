"""What stands in the way is planned around, and the plan tells how."""

import numpy as np
import pytest

from camera_rigs import Limits, Obstacle, World, direct


def column(x, y, name="column"):
    return Obstacle((x, y, 1.2), (0.8, 0.8, 2.4), name=name)


def planned(rig, subject, world, shots="auto", seed=0, **options):
    return direct(subject, rig.lens(), world, shots, np.random.default_rng(seed), **options)


FOREST = World(obstacles=tuple(column(3.0 * np.cos(a), 3.0 * np.sin(a)) for a in np.arange(0.0, 6.2, 0.7)))


def test_a_forest_is_filmed_without_touching_or_losing_anybody(rig):
    mended = 0
    for seed in range(12):
        made = planned(rig, rig.dancer(200), FOREST, seed=seed)
        assert made.ok
        assert FOREST.obstacle_distance(made.path.location).min() >= Limits().obstacle
        eye, people = made.path.location, made.subject
        hidden = FOREST.hides(eye, people.neck) & FOREST.hides(eye, people.pelvis)
        runs = np.diff(np.flatnonzero(np.diff(np.concatenate([[0], hidden, [0]]))))[::2]
        assert runs.max(initial=0) <= Limits().hidden_seconds * rig.fps
        mended += bool(made.mends)
    assert mended > 3


def test_the_mends_are_told(rig):
    mends = [m for seed in range(12) for m in planned(rig, rig.dancer(200), FOREST, seed=seed).mends]
    assert "redrawn" in {mend.action for mend in mends}
    assert any(mend.reason.startswith(("obstacle:", "occlusion:")) for mend in mends)
    document = planned(rig, rig.dancer(200), FOREST, seed=0).to_json()
    assert all(set(mend) == {"shot", "kind", "action", "reason"} for mend in document["mends"])


def test_a_small_room_is_not_left(rig):
    room = World(bounds=((-2.2, -2.2, 0.0), (2.2, 2.2, 2.4)))
    for seed in range(10):
        made = planned(rig, rig.dancer(150, sway=0.2), room, seed=seed)
        assert made.ok
        assert room.wall_distance(made.path.location).min() >= Limits().wall


def test_the_ground_is_above_someone_who_crawls_low(rig):
    for seed in range(10):
        made = planned(rig, rig.walker(90, speed=0.5, height=0.6), World(), seed=seed)
        assert made.ok
        assert made.path.location[:, 2].min() >= Limits().ground


def test_a_room_without_room_leaves_its_findings(rig):
    closet = World(bounds=((-0.5, -0.5, 0.0), (0.5, 0.5, 2.0)))
    made = planned(rig, rig.stander(30), closet)
    assert not made.ok
    assert {"wall", "person"} & {finding.rule for finding in made.findings}
    assert len(made.shots) == 1, "there is a plan all the same, for those who ask for it"


def test_a_shot_that_loses_the_people_is_replaced_and_that_is_told(rig):
    plans = [planned(rig, rig.walker(150, speed=2.0), World(), "static", seed=seed) for seed in range(6)]
    replaced = [made for made in plans if made.shots[0].kind != "static"]
    assert replaced, "ten metres of a walk do not pass before most tripods"
    for made in replaced:
        assert made.ok
        mend = made.mends[-1]
        assert (mend.shot, mend.kind, mend.action) == (0, "static", f"replaced by {made.shots[0].kind}")
        assert mend.reason.startswith("in-frame:")


def test_a_shot_that_cannot_go_on_is_replaced_and_that_is_told(rig):
    wall = World(obstacles=(Obstacle((9.0, 0.0, 1.0), (0.3, 14.0, 2.0), name="wall"),))
    made = planned(rig, rig.walker(150, speed=1.4, half_width=0.25), wall, "tracking", seed=1)
    assert made.ok
    shown = {shot.kind for shot in made.shots}
    if shown != {"tracking"}:
        assert any("replaced" in mend.action or "drawn anew" in mend.action for mend in made.mends)


@pytest.mark.parametrize("quantity", ["speed", "acceleration", "jerk", "turn"])
def test_tighter_limits_are_kept_too(rig, quantity):
    limits = Limits(speed=1.0, acceleration=2.0, jerk=10.0, turn=30.0)
    for seed in range(5):
        made = planned(rig, rig.dancer(150, sway=0.1), World(), seed=seed, limits=limits)
        assert not [finding for finding in made.findings if finding.rule == quantity]
