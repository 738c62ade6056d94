"""New motions from few: other bodies, other strides, other paces, the other hand.

Free motion capture is scarce, so each motion is performed again and again with changes after which one still
knows how fast the root must have moved: whoever takes longer strides at the same pace moves on faster by what
the standing foot tells.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

from whacamole.baseline.clips import Clip, Performance, clip_of
from whacamole.baseline.method import VELOCIMETER_JOINTS
from whacamole.baseline.resampling import Resampling
from whacamole.baseline.rigid import FloatArray
from whacamole.baseline.velocimeter import FPS
from whacamole.body import JOINT_INDEX, MIRROR_JOINTS, BodyModel

_LEGS = [JOINT_INDEX[f"{side}_{name}"] - 1 for side in ("left", "right") for name in ("hip", "knee", "ankle")]
"""Rows of ``body_pose`` whose swing makes a stride."""

_ANKLES = [VELOCIMETER_JOINTS.index(JOINT_INDEX[f"{side}_ankle"]) for side in ("left", "right")]

_SWAPPED = [VELOCIMETER_JOINTS.index(MIRROR_JOINTS[joint]) for joint in VELOCIMETER_JOINTS]

STANDING_SPEED = 0.25
"""Speed of an ankle [m/s] at which it counts for half of one that rests."""

_SMOOTHING = 2.0  # frames, σ of the low-pass of the correction


@dataclass(frozen=True)
class Variation:
    """How one performance differs from the motion it comes from.

    Attributes:
        betas: (10,) shape.
        stride: factor on the swing of the legs about their mean pose.
        pace: factor on the speed of time.
        mirrored: left and right exchanged.
    """

    betas: FloatArray
    stride: float = 1.0
    pace: float = 1.0
    mirrored: bool = False


def variation_rand(rng: np.random.Generator, spread: float) -> Variation:
    """Draw a variation; ``spread`` 0 leaves the motion as it is, 1 is what the bundled weights were made
    with."""
    return Variation(
        betas=(0.8 * spread * rng.normal(size=10)).clip(-2.0, 2.0),
        stride=float(np.exp(spread * rng.uniform(-0.6, 0.4))),
        pace=float(np.exp(spread * rng.uniform(-0.35, 0.35))),
        mirrored=bool(rng.random() < 0.5 * spread),
    )


def perform(performance: Performance, variation: Variation, body: BodyModel) -> Clip:
    """The clip of a performance under a variation."""
    clip = clip_of(performance.params(body, variation.betas), body, performance.motion)
    if variation.stride != 1.0:
        clip = _stride(performance, variation, body, clip)
    if variation.pace != 1.0:
        clip = _at_pace(clip, variation.pace)
    return mirrored(clip) if variation.mirrored else clip


def mirrored(clip: Clip) -> Clip:
    """The clip in a mirror, x ↔ −x, left joints and right ones exchanged."""
    flip = np.diag([-1.0, 1.0, 1.0])
    # The body's own left-right axis is its x at rest, so the mirrored root is F R F.
    return replace(
        clip, joints=clip.joints[:, _SWAPPED] @ flip, orient=flip @ clip.orient @ flip, camera=None
    )


def _at_pace(clip: Clip, pace: float) -> Clip:
    even = Resampling(clip.num_frames, FPS * pace, FPS)
    return replace(clip, joints=even.points(clip.joints), orient=even.rotations(clip.orient), camera=None)


def _stride(performance: Performance, variation: Variation, body: BodyModel, plain: Clip) -> Clip:
    """Scale the swing of the legs; move the root so that the standing foot moves as it did before."""
    pose = performance.person.body_pose.copy()
    legs = pose[:, _LEGS]
    middle = Rotation.from_rotvec(legs.reshape(-1, 3)).as_matrix().reshape(*legs.shape[:2], 3, 3)
    for column in range(len(_LEGS)):
        mean = Rotation.from_matrix(middle[:, column]).mean()
        swing = (mean.inv() * Rotation.from_matrix(middle[:, column])).as_rotvec()
        legs[:, column] = (mean * Rotation.from_rotvec(variation.stride * swing)).as_rotvec()
    pose[:, _LEGS] = legs
    moved = clip_of(performance.params(body, variation.betas, pose), body, performance.motion)
    before, after = (_steps(clip.joints[:, _ANKLES]) for clip in (plain, moved))
    # Both have the same root path, so the difference of an ankle's steps is what the root has to make up for.
    weight = 1.0 / (1.0 + (np.linalg.norm(before, axis=-1) * FPS / STANDING_SPEED) ** 2) ** 2
    total = gaussian_filter1d(weight.sum(axis=1), _SMOOTHING, axis=0)
    owed = gaussian_filter1d((weight[..., None] * (before - after)).sum(axis=1), _SMOOTHING, axis=0)
    correction = owed / np.maximum(total, 1e-3)[:, None]
    return replace(moved, joints=moved.joints + np.cumsum(correction, axis=0)[:, None])


def _steps(points: FloatArray) -> FloatArray:
    """Differences (n, …) from the frame before; zero at frame 0."""
    return np.diff(points, axis=0, prepend=points[:1])
