"""Steps of no one in particular: legs that swing at random, on feet that stand.

What the velocimeter has to know above all is that a standing foot stays where it is. Motion capture that may
be shipped shows that for a few seconds of a few people. So people are made who walk, sidestep, turn, hop and
shuffle with random legs; the root moves so that the lowest foot rests. They teach the rule, real motions the
rest (flight, falls).
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

from whacamole.baseline.clips import Clip, clip_of
from whacamole.baseline.rigid import FloatArray
from whacamole.baseline.velocimeter import FPS
from whacamole.body import JOINT_INDEX, BodyModel, BodyParams

GAIT_FRAMES = 128

_SIDES = ("left", "right")
_SOLES = {"ankle": 0.07, "foot": 0.02}
"""Joints of the foot and their height [m] over the ground when it stands."""

_SOFTNESS = 0.015  # metres above the lower end of a foot at which the other end bears 1/e
_INERTIA = 1.2  # frames, σ of the low-pass of the root's path; bridges the flights of a run


def gait_rand(rng: np.random.Generator, body: BodyModel, betas: FloatArray) -> Clip:
    """Somebody of shape ``betas`` (10,) on the move for :data:`GAIT_FRAMES` frames."""
    frames = GAIT_FRAMES
    wave = _waves(rng, frames)
    pose = np.zeros((frames, 21, 3))
    for joint, spread in (
        ("spine1", 0.12),
        ("spine2", 0.08),
        ("spine3", 0.08),
        ("neck", 0.2),
        ("head", 0.15),
    ):
        pose[:, JOINT_INDEX[joint] - 1] = wave(spread)
    bearing = _legs_rand(rng, pose, wave)
    _arms_rand(rng, pose, wave)
    params = replace(BodyParams.zeros(frames, betas), body_pose=pose, global_orient=_root_rand(rng, wave))
    joints = body.pose_joints(params)
    moved = replace(params, transl=_path(joints, bearing))
    return clip_of(moved, body, "")


def _waves(rng: np.random.Generator, frames: int) -> Callable[[float], FloatArray]:
    """A source of smooth random rotation vectors (frames, 3) with standard deviation ``spread`` [rad]."""

    def wave(spread: float) -> FloatArray:
        seconds = np.exp(rng.uniform(np.log(0.2), np.log(1.2)))
        noise = gaussian_filter1d(rng.normal(size=(frames + 200, 3)), seconds * FPS, axis=0)[100:-100]
        around: FloatArray = noise / noise.std(axis=0) * spread * rng.uniform(0.2, 1.0)
        return around

    return wave


def _legs_rand(rng: np.random.Generator, pose: FloatArray, wave: Callable[[float], FloatArray]) -> FloatArray:
    """Steps in a random direction, both legs in turn (or together: hops), over legs that wander.

    Returns:
        How much each leg bears (frames, 2), from 0 to 1: it does while it swings back. Both may at once, as
        in walking, or none, as in running.
    """
    rate = np.exp(rng.uniform(np.log(0.5), np.log(1.7)))
    phase = 2.0 * np.pi * np.cumsum(rate * (1.0 + wave(0.15)[:, 0])) / FPS + rng.uniform(0.0, 2.0 * np.pi)
    apart = 0.0 if rng.random() < 0.1 else np.pi * (1.0 + 0.05 * rng.normal())
    heading = rng.normal(scale=0.4) if rng.random() < 0.7 else rng.uniform(-np.pi, np.pi)
    swing = rng.uniform(0.05, 0.75) * np.clip(1.0 + wave(0.3)[:, 0], 0.0, None)
    bent, lift = rng.uniform(0.0, 0.5), rng.uniform(0.5, 1.3)
    loose = np.exp(rng.uniform(np.log(0.01), np.log(0.25)))
    sharp, short = rng.uniform(4.0, 12.0), rng.uniform(-0.3, 0.5)
    bearing = []
    for side, lag in zip(_SIDES, (0.0, apart), strict=True):
        forward, rising = np.sin(phase + lag), np.maximum(np.cos(phase + lag), 0.0)
        hip, knee, ankle = (JOINT_INDEX[f"{side}_{name}"] - 1 for name in ("hip", "knee", "ankle"))
        pose[:, hip] = wave(loose)
        # About x a negative angle lifts the thigh forward; about z a positive one swings both legs to the
        # left.
        raised = lift * rising * (0.3 + swing)
        pose[:, hip, 0] += -0.5 * bent - swing * forward * np.cos(heading) - 0.4 * raised
        pose[:, hip, 2] += 0.6 * swing * forward * np.sin(heading)
        pose[:, knee, 0] = bent + raised + np.abs(wave(loose)[:, 0])
        pose[:, ankle, 0] = -0.5 * bent + 0.3 * swing * rng.uniform(-1.0, 1.0) * forward
        pose[:, ankle] += wave(0.5 * loose)
        bearing.append(1.0 / (1.0 + np.exp(sharp * (np.cos(phase + lag) + short))))
    return np.stack(bearing, axis=1)


def _arms_rand(rng: np.random.Generator, pose: FloatArray, wave: Callable[[float], FloatArray]) -> None:
    """Arms hanging, spread or raised, wandering."""
    hang = rng.uniform(-0.3, 1.3)
    for side, sign in zip(_SIDES, (-1.0, 1.0), strict=True):
        pose[:, JOINT_INDEX[f"{side}_shoulder"] - 1] = wave(0.5) + np.array([0.0, 0.0, sign * hang])
        pose[:, JOINT_INDEX[f"{side}_elbow"] - 1] = wave(0.5) + np.array(
            [0.0, sign * rng.uniform(0, 1.2), 0.0]
        )


def _root_rand(rng: np.random.Generator, wave: Callable[[float], FloatArray]) -> FloatArray:
    """Root orientation (frames, 3): upright up to a lean, turning."""
    lean = wave(0.15)
    yaw = np.cumsum(wave(np.radians(30.0))[:, 2]) / FPS + rng.uniform(0.0, 2.0 * np.pi)
    upright = Rotation.from_euler("x", 90.0, degrees=True)
    turned = (
        Rotation.from_rotvec(yaw[:, None] * np.array([0.0, 0.0, 1.0])) * upright * Rotation.from_rotvec(lean)
    )
    orient: FloatArray = turned.as_rotvec()
    return orient


def _path(joints: FloatArray, bearing: FloatArray) -> FloatArray:
    """Root path (frames, 3) [m] on which the bearing feet rest, from joints about a fixed root.

    Args:
        joints: (frames, 55, 3) [m].
        bearing: (frames, 2) how much each leg bears.
    """
    rows = [[JOINT_INDEX[f"{side}_{name}"] for name in _SOLES] for side in _SIDES]
    soles = joints[:, rows] - np.array([[0.0, 0.0, height] for height in _SOLES.values()])
    height = soles[..., 2]
    weight = np.exp((height.min(axis=-1, keepdims=True) - height) / _SOFTNESS)
    weight *= (bearing + 1e-6)[..., None] / weight.sum(axis=-1, keepdims=True)
    total = _smooth(weight.sum(axis=(1, 2)))[:, None]
    steps = np.diff(soles, axis=0, prepend=soles[:1])
    velocity = -_smooth((weight[..., None] * steps).sum(axis=(1, 2))) / total
    path = np.cumsum(velocity, axis=0)
    path[:, 2] = -_smooth((weight * height).sum(axis=(1, 2))) / total[:, 0]
    return path


def _smooth(values: FloatArray) -> FloatArray:
    smooth: FloatArray = gaussian_filter1d(values, _INERTIA, axis=0)
    return smooth
