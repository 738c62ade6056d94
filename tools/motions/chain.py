"""Joining clips end to end: each starts where the last one ended, facing the way it faced, without a jump.

A seam is healed on both sides. Each joint's difference between the end of one clip and the start of the
next is halved, and either half fades out over ``blend`` seconds with zero slope at both ends, so that the
velocities at the seam stay those of the capture.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.spatial.transform import Rotation

from tools.motions.source import NAMES, Clip, FloatArray


def azimuth_between(first: Rotation, second: Rotation) -> float:
    """The turn [rad] about the vertical (y) that brings ``second`` closest to ``first``.

    It is the twist of their difference, which also exists for a body that lies and faces no way in
    particular.
    """
    _, y, _, w = (first * second.inv()).as_quat()
    return float(2.0 * np.arctan2(y, w))


def turn(clip: Clip, azimuth: float, to: FloatArray) -> Clip:
    """``clip`` turned by ``azimuth`` [rad] about the vertical; its first root moves to ``to (2,)``: x, z."""
    about = Rotation.from_rotvec([0.0, azimuth, 0.0])
    start = clip.root[0] * np.array([1.0, 0.0, 1.0])
    root = about.apply(clip.root - start) + np.array([to[0], 0.0, to[1]])
    return Clip(clip.local | {"root": about * clip.local["root"]}, root, clip.fps, clip.wraps)


def chain(clips: Sequence[Clip], *, straight: bool = False, blend: float = 0.25) -> Clip:
    """The clips one after the other; the last frame of one is the first of the next.

    ``straight`` keeps the direction that each clip has by itself: a cycle whose ends differ by a few
    degrees then goes on straight instead of along a circle.
    """
    result = clips[0]
    for following in clips[1:]:
        result = _join(result, following, straight, blend)
    return result


def _join(first: Clip, second: Clip, straight: bool, blend: float) -> Clip:
    azimuth = 0.0 if straight else azimuth_between(first.local["root"][-1], second.local["root"][0])
    second = turn(second, azimuth, first.root[-1, [0, 2]])
    fade_out = _fade(first.num_frames, round(blend * first.fps))[::-1]
    fade_in = _fade(second.num_frames, round(blend * first.fps))
    gap = second.root[0] - first.root[-1]
    root = np.concatenate(
        [first.root + 0.5 * fade_out[:, None] * gap, second.root[1:] - 0.5 * fade_in[1:, None] * gap]
    )
    local = {}
    for name in NAMES:
        gap = (first.local[name][-1].inv() * second.local[name][0]).as_rotvec()
        before = first.local[name] * Rotation.from_rotvec(0.5 * fade_out[:, None] * gap)
        after = second.local[name] * Rotation.from_rotvec(-0.5 * fade_in[:, None] * gap)
        local[name] = Rotation.concatenate([before, after[1:]])
    return Clip(local, root, first.fps, second.wraps)


def _fade(count: int, length: int) -> FloatArray:
    """One at the first frame, zero from frame ``length`` on."""
    u = np.minimum(np.arange(count) / length, 1.0)
    return np.asarray(1.0 - u**3 * (10.0 - 15.0 * u + 6.0 * u**2), dtype=np.float64)


def mirror(clip: Clip) -> Clip:
    """The clip as seen in a mirror: left and right change places."""
    swapped = {
        name: name.replace("left", "?").replace("right", "left").replace("?", "right") for name in NAMES
    }
    local = {
        swapped[name]: Rotation.from_rotvec(clip.local[name].as_rotvec() * [1.0, -1.0, -1.0])
        for name in NAMES
    }
    return Clip(local, clip.root * [-1.0, 1.0, 1.0], clip.fps, clip.wraps)
