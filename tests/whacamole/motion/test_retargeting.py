"""The tool that makes the embedded motions: seams, mirror images, standing feet, limbs."""

import json

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tools.motions.chain import azimuth_between, chain, mirror, turn
from tools.motions.feet import correction, travel
from tools.motions.retarget import arc, retarget
from tools.motions.source import FRAME_WIDTH, NAMES, Clip, forward, load
from whacamole.motion.skeleton import JOINT_NAMES
from whacamole.motion.skeleton import forward as pose_skeleton

FPS = 60.0
AHEAD = np.array([0.0, 0.0, 0.18])
"""From the heel to the ball of a foot [m]."""


def clip(seed: int, frames: int = 61, speed: float = 1.0) -> Clip:
    """Someone who glides along z, limbs waving smoothly."""
    rng = np.random.default_rng(seed)
    t = np.arange(frames) / FPS
    local = {
        name: Rotation.from_rotvec(0.2 * np.sin(t[:, None] * 3.0 + rng.uniform(0, 6, 3)) * [1.0, 0.3, 0.3])
        for name in NAMES
    }
    root = np.stack([0.02 * np.sin(t), 0.88 + 0.0 * t, speed * t], axis=1)
    return Clip(local, root, FPS, wraps=True)


def test_a_mirror_image_of_a_mirror_image_is_the_clip():
    original = clip(0)
    twice = mirror(mirror(original))
    np.testing.assert_allclose(twice.root, original.root)
    for name in NAMES:
        assert (twice.local[name].inv() * original.local[name]).magnitude().max() < 1e-12


def test_a_mirror_image_reflects_every_joint():
    original = clip(1)
    (positions, _), (reflected, _) = forward(original), forward(mirror(original))
    np.testing.assert_allclose(reflected["left_ankle"], positions["right_ankle"] * [-1, 1, 1], atol=1e-12)
    np.testing.assert_allclose(reflected["right_elbow"], positions["left_elbow"] * [-1, 1, 1], atol=1e-12)


@pytest.mark.parametrize("straight", [False, True])
def test_a_chain_has_no_jump_and_every_frame_once(straight):
    parts = [clip(seed) for seed in range(3)]
    whole = chain(parts, straight=straight)
    assert whole.num_frames == 3 * 60 + 1
    inside = max(np.abs(np.diff(part.root, axis=0)).max() for part in parts)
    assert np.abs(np.diff(whole.root, axis=0)).max() < 1.3 * inside
    for name in NAMES:
        steps = (whole.local[name][:-1].inv() * whole.local[name][1:]).magnitude()
        assert steps.max() < np.radians(6.0)


def test_turning_a_clip_turns_everything_about_the_vertical():
    original = clip(2)
    turned = turn(original, 0.7, np.array([3.0, -1.0]))
    assert azimuth_between(turned.local["root"][0], original.local["root"][0]) == pytest.approx(0.7)
    np.testing.assert_allclose(turned.root[0], [3.0, original.root[0, 1], -1.0])
    (before, _), (after, _) = forward(original), forward(turned)
    about = Rotation.from_rotvec([0.0, 0.7, 0.0])
    moved = about.apply(before["left_ankle"] - original.root[0]) + turned.root[0]
    np.testing.assert_allclose(after["left_ankle"], moved, atol=1e-12)


def sliding_foot(slide: float) -> np.ndarray:
    """Heel and ball (T,2,3): swing, one second flat on the ground while sliding, swing."""
    t = np.arange(150) / FPS
    height = np.clip(np.abs(t - 1.25) - 0.5, 0.0, None) * 0.8
    ahead = slide * np.clip(t - 0.75, 0.0, 1.0) + np.where(height > 0, np.sign(t - 1.25) * height * 2.0, 0.0)
    heel = np.stack([np.zeros_like(t), height + 0.01, ahead], axis=1)
    return np.stack([heel, heel + AHEAD], axis=1)


def test_a_resting_foot_is_held_still_on_the_floor():
    sole = sliding_foot(0.3)
    fixed = sole + correction(sole, FPS)[:, None]
    resting = fixed[50:100]
    assert np.ptp(resting[..., [0, 2]], axis=0).max() < 1e-9
    np.testing.assert_allclose(resting[..., 1], 0.0, atol=1e-12)
    assert fixed[..., 1].min() >= 0.0
    assert np.abs(np.diff(fixed, axis=0)).max() < 1.2 * np.abs(np.diff(sole, axis=0)).max() + 0.01


def test_a_body_travels_by_the_foot_that_bears_it():
    # One foot slides back at 1 m/s under a root that stays: in truth the root goes forward at 1 m/s.
    t = np.arange(60) / FPS
    foot = np.stack([np.zeros_like(t), np.zeros_like(t), -1.0 * t], axis=1)
    standing = np.stack([foot, foot + AHEAD], axis=1)
    lifted = standing + np.array([0.0, 0.4, 0.0])
    shift = travel(np.stack([standing, lifted]), FPS)
    np.testing.assert_allclose(np.diff(shift[:, 2]) * FPS, 1.0, atol=1e-6)
    np.testing.assert_allclose(shift[:, :2], 0.0, atol=1e-9)


def test_the_shortest_turn_between_directions():
    rng = np.random.default_rng(0)
    one, other = rng.normal(size=(50, 3)), rng.normal(size=(50, 3))
    found = arc(one, other)
    unit = [v / np.linalg.norm(v, axis=1, keepdims=True) for v in (one, other)]
    np.testing.assert_allclose(found.apply(unit[0]), unit[1], atol=1e-12)
    np.testing.assert_allclose(
        found.magnitude(), np.arccos(np.clip((unit[0] * unit[1]).sum(1), -1, 1)), atol=1e-7
    )


def test_retargeted_limbs_point_where_the_source_points():
    source = clip(3, speed=0.0)
    positions, _ = forward(source)
    person = retarget(source)
    joints, _ = pose_skeleton(person.pose[:, 0], person.pose[:, 1:], person.pelvis)
    for one, other in (("left_shoulder", "left_elbow"), ("right_shoulder", "right_elbow")):
        wanted = positions[other] - positions[one]
        found = joints[:, JOINT_NAMES.index(other)] - joints[:, JOINT_NAMES.index(one)]
        wanted /= np.linalg.norm(wanted, axis=1, keepdims=True)
        found /= np.linalg.norm(found, axis=1, keepdims=True)
        np.testing.assert_allclose(found, wanted, atol=1e-9)


def test_a_clip_is_read_with_its_own_timing(tmp_path):
    frame = [0.0] * FRAME_WIDTH
    quaternions = [4, 8, 12, 16, 21, 25, 30, 35, 39]
    for at in quaternions:
        frame[at] = 1.0
    frames = [[0.05, 0.1 * k, 0.9, 0.0, *frame[4:]] for k in range(3)]
    path = tmp_path / "clip.txt"
    path.write_text(json.dumps({"Loop": "none", "Frames": frames}))
    found = load(path, 60.0)
    assert found.num_frames == 7
    # x forward in the source is z forward in the target.
    np.testing.assert_allclose(found.root[:, 2], np.linspace(0.0, 0.2, 7), atol=1e-12)
    np.testing.assert_allclose(found.root[:, 1], 0.9)
    path.write_text(json.dumps({"Loop": "none", "Frames": [[0.0] * 5] * 2}))
    with pytest.raises(ValueError, match="expected 44 values"):
        load(path, 60.0)
