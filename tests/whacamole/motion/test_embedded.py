"""The embedded motions look like people: on their feet, knees and elbows the right way, without a jump."""

import hashlib
import re
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from whacamole.motion import FPS, Motion, MotionPerson, embedded_motions, find_motions, read_motion
from whacamole.motion.skeleton import JOINT_NAMES, REST_JOINTS, TOUCH_RADII, forward, touch_points

PAIRS = {"duet", "sparring", "stroll"}
WALKS = {"walk", "walk_turn", "run", "stroll"}
ON_FEET = {"walk", "walk_turn", "stroll", "jump", "punch", "kick", "dance_a", "dance_b", "duet"}
FILES = find_motions(embedded_motions())
NAMES = [file.id for file in FILES]


@cache
def motion(name: str) -> Motion:
    """The embedded motion ``name``."""
    return read_motion(FILES[NAMES.index(name)])


def world(person: MotionPerson) -> tuple[np.ndarray, np.ndarray]:
    """Joints and their rotations in the world."""
    return forward(person.global_orient, person.body_pose, person.pelvis)


def soles(person: MotionPerson) -> np.ndarray:
    """Points of both soles (T,K,3): those fixed to an ankle or to the ball of a foot."""
    joints, turns = world(person)
    points = touch_points(joints, turns)
    moved = touch_points(joints + 1.0 * np.isin(np.arange(22), [7, 8, 10, 11])[:, None], turns)
    return points[:, (moved != points).any(axis=(0, 2))]


def joint(name: str) -> int:
    """Index of a body joint."""
    return JOINT_NAMES.index(name)


def test_what_is_promised_is_there():
    assert {"walk", "run", "dance_a", "dance_b", "jump", "spinkick", "crawl", "getup_back"} | PAIRS <= set(
        NAMES
    )
    assert all(file.problem is None for file in FILES)
    assert {file.id for file in FILES if file.num_people == 2} == PAIRS
    assert motion("walk").num_frames >= 6 * FPS
    assert sum(path.stat().st_size for path in embedded_motions().iterdir()) < 600_000


def test_licence_and_provenance_cover_every_file():
    assert "zlib license" in (embedded_motions() / "LICENSE.txt").read_text()
    assert all(motion(name).licence.startswith("zlib") for name in NAMES)
    provenance = (embedded_motions() / "PROVENANCE.md").read_text()
    listed = set(re.findall(r"`([0-9a-f]{16})`", provenance))
    files = embedded_motions().glob("*.npz")
    assert {hashlib.sha256(path.read_bytes()).hexdigest()[:16] for path in files} == listed
    assert all(f"| {name} |" in provenance for name in NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_nobody_sinks_and_nobody_floats(name):
    for person in motion(name).people:
        lowest = (touch_points(*world(person))[..., 2] - TOUCH_RADII).min(axis=1)
        assert lowest.min() > -0.005
        # Somebody may jump; most of the time something touches the ground.
        assert np.median(lowest) < 0.01


@pytest.mark.parametrize("name", NAMES)
def test_knees_and_elbows_bend_the_right_way(name):
    for person in motion(name).people:
        joints, _ = world(person)
        for side in ("left", "right"):
            hip, knee, ankle = (joints[:, joint(f"{side}_{part}")] for part in ("hip", "knee", "ankle"))
            thigh, shank = knee - hip, ankle - knee
            bend = np.arccos(
                np.sum(thigh * shank, 1) / np.linalg.norm(thigh, axis=1) / np.linalg.norm(shank, axis=1)
            )
            # In the thigh's frame a bent shank points backwards (−z), whatever the leg does.
            _, turns = world(person)
            back = np.einsum("tji,tj->ti", turns[:, joint(f"{side}_hip")], shank)[:, 2]
            assert (back[bend > np.radians(15)] < 0.0).all()
            assert bend.max() < np.radians(165)
            # A forearm bends forwards and inwards of the upper arm: about −y on the left, +y on the right.
            flexion = person.body_pose[:, joint(f"{side}_elbow") - 1, 1] * (-1 if side == "left" else 1)
            assert flexion.min() > np.radians(-15)


@pytest.mark.parametrize("name", sorted(WALKS))
def test_walkers_face_the_way_they_go(name):
    for person in motion(name).people:
        _, turns = world(person)
        facing = turns[:, joint("spine3")] @ np.array([0.0, 0.0, 1.0])
        step = round(FPS / 2)
        going = person.pelvis[step:] - person.pelvis[:-step]
        cosine = (facing[:-step, :2] * going[:, :2]).sum(1)
        cosine /= np.linalg.norm(facing[:-step, :2], axis=1) * np.linalg.norm(going[:, :2], axis=1)
        assert cosine.min() > 0.6


@pytest.mark.parametrize("name", sorted(ON_FEET))
def test_standing_feet_do_not_slide(name):
    for person in motion(name).people:
        points = soles(person)
        speed = np.linalg.norm(np.diff(points, axis=0)[..., :2], axis=2) * FPS
        height = np.maximum(points[1:, :, 2], points[:-1, :, 2])
        # The slowest point of the soles, wherever one is on the ground.
        slowest = np.where(height < 0.02, speed, np.inf).min(axis=1)
        slowest = slowest[np.isfinite(slowest)]
        assert len(slowest) > 0.3 * len(points)
        assert np.median(slowest) < 0.06
        assert np.percentile(slowest, 75) < 0.2


@pytest.mark.parametrize("name", NAMES)
def test_there_is_no_jump_at_any_seam(name):
    for person in motion(name).people:
        pose = np.concatenate([person.global_orient[:, None], person.body_pose], axis=1)
        T = len(pose)
        one, other = (Rotation.from_rotvec(part.reshape(-1, 3)) for part in (pose[:-1], pose[1:]))
        turn = (one.inv() * other).as_rotvec().reshape(T - 1, -1, 3)
        assert np.degrees(np.linalg.norm(turn, axis=2)).max() < 70.0  # a kick: 2100 degrees a second
        assert np.degrees(np.linalg.norm(np.diff(turn, axis=0), axis=2)).max() < 65.0
        joints, _ = world(person)
        # The capture itself reaches 43 m/s² at the pelvis (a kick); a jump of 10 cm in a frame would be 90.
        assert np.linalg.norm(np.diff(joints[:, 0], 2, axis=0), axis=1).max() * FPS**2 < 60.0


def test_the_walk_repeats_seamlessly():
    person = motion("walk").people[0]
    cycle = (person.num_frames - 1) // 6
    pose = person.body_pose[cycle : 5 * cycle]
    assert np.abs(pose[: -2 * cycle] - pose[2 * cycle :]).max() < np.radians(3)
    gone = person.pelvis[-1] - person.pelvis[0]
    assert np.linalg.norm(gone[:2]) > 6.0


@pytest.mark.parametrize("name", sorted(PAIRS))
def test_nobody_walks_through_anybody(name):
    one, other = (touch_points(*world(person)) for person in motion(name).people)
    gap = np.linalg.norm(one[:, :, None] - other[:, None], axis=-1) - TOUCH_RADII[:, None] - TOUCH_RADII
    assert gap.min() > -0.01


def test_the_duet_is_a_mirror_image_face_to_face():
    one, other = motion("duet").people
    (joints, turns), (mirrored, other_turns) = world(one), world(other)
    swap = [
        joint(re.sub("left|right", lambda m: "right" if m[0] == "left" else "left", n)) for n in JOINT_NAMES
    ]
    plane = 0.5 * (joints[:, 0, 1] + mirrored[:, 0, 1])
    assert np.ptp(plane) < 0.01
    reflected = joints[:, swap] * [1.0, -1.0, 1.0] + [0.0, 2.0 * plane.mean(), 0.0]
    np.testing.assert_allclose(mirrored, reflected, atol=0.03)
    ahead = np.array([0.0, 0.0, 1.0])
    assert ((turns[:, 9] @ ahead)[:, 1] * (other_turns[:, 9] @ ahead)[:, 1] < 0).mean() > 0.95


def test_the_nominal_skeleton_is_symmetric():
    swap = [
        joint(re.sub("left|right", lambda m: "right" if m[0] == "left" else "left", n)) for n in JOINT_NAMES
    ]
    np.testing.assert_allclose(REST_JOINTS[swap], REST_JOINTS * [-1.0, 1.0, 1.0])
