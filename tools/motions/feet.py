"""Feet that stand still: contact found, sliding taken out, the floor kept at zero.

The sole of a foot is a few points, heel and ball. While one rests it is the pivot of the foot; what the pivot
slides is summed up over the stance and taken back, so that it does not slide at all. In the swing the
correction passes smoothly from one stance to the next.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from tools.motions.source import FloatArray

HEIGHT, SPEED = 0.045, 0.45
"""A point of the sole rests below this height [m] and below this speed [m/s]."""
MIN_STANCE = 0.07
"""Shorter contacts [s] are passing touches."""


def correction(sole: FloatArray, fps: float) -> FloatArray:
    """Shift ``(T,3)`` [m] of one foot with ``sole (T,K,3)``: points of heel and ball in the world, y up."""
    T = len(sole)
    pivot, planted = _pivots(sole, fps)
    shift = np.zeros((T, 3))
    stances = _runs(planted)
    for start, stop in stances:
        moved = np.zeros((stop - start, 3))
        for t in range(start + 1, stop):
            # The later frame's pivot: a foot that rolls has the ball down already when it leaves the heel.
            moved[t - start] = moved[t - 1 - start] - (sole[t, pivot[t]] - sole[t - 1, pivot[t]])
        shift[start:stop, [0, 2]] = (moved - moved.mean(axis=0))[:, [0, 2]]
        shift[start:stop, 1] = -sole[np.arange(start, stop), pivot[start:stop], 1]
    _bridge(shift, stances)
    lowest = (sole[..., 1] + shift[:, None, 1]).min(axis=1)
    shift[:, 1] -= np.minimum(lowest, 0.0)
    return shift


def travel(soles: FloatArray, fps: float) -> FloatArray:
    """Shift ``(T,3)`` [m] of the whole body that makes it move by standing: the foot that carries it stays.

    ``soles (2,T,K,3)``: points of heel and ball of either foot. For clips whose root does not fit the
    steps, so that a foot that bears the body slides for long. Only for people on their feet. The correcting
    velocity is minus that of the lower, slower foot; in flight it passes from take-off to landing.
    """
    velocity = np.gradient(soles, axis=1)[..., [0, 2]] * fps
    speed = np.linalg.norm(velocity, axis=-1)
    floor = np.percentile(soles[..., 1].min(axis=(0, 2)), 5.0)
    # A foot bears the body where it is low, does not rise or fall and is no foot in mid-swing.
    low = np.clip((0.10 - soles[..., 1] + floor) / 0.04, 0.0, 1.0)
    calm = np.clip((0.8 - np.abs(np.gradient(soles[..., 1], axis=1)) * fps) / 0.4, 0.0, 1.0)
    load = low * calm * np.clip(2.5 - speed, 0.0, 1.0)
    weight = load / (0.05 + speed**2)
    carried = load.max(axis=(0, 2)) > 0.3
    total = np.maximum(weight.sum(axis=(0, 2)), 1e-9)
    slide = (weight[..., None] * velocity).sum(axis=(0, 2)) / total[:, None]
    t = np.arange(len(slide))
    slide = np.stack([np.interp(t, t[carried], slide[carried, axis]) for axis in range(2)], axis=1)
    path = np.cumsum(gaussian_filter1d(slide, 0.04 * fps, axis=0, mode="nearest"), axis=0) / fps
    height = np.interp(t, t[carried], soles[..., 1].min(axis=(0, 2))[carried])
    height = gaussian_filter1d(height, 0.04 * fps, mode="nearest")
    return np.asarray(-np.stack([path[:, 0], height, path[:, 1]], axis=1))


def planted_mask(sole: FloatArray, fps: float) -> NDArray[np.bool_]:
    """``(T,)``: the foot rests on the ground."""
    return _pivots(sole, fps)[1]


def _pivots(sole: FloatArray, fps: float) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    velocity = np.gradient(sole, axis=0) * fps
    speed = np.linalg.norm(velocity[..., [0, 2]], axis=-1)
    floor = np.percentile(sole[..., 1].min(axis=1), 5.0)
    down = (sole[..., 1] - floor < HEIGHT) & (speed < SPEED)
    planted = down.any(axis=1)
    for start, stop in _runs(planted):
        if stop - start < MIN_STANCE * fps:
            planted[start:stop] = False
    cost = np.where(down, sole[..., 1] + 0.1 * speed, np.inf)
    return cost.argmin(axis=1), planted


def _runs(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[0], mask.astype(np.int8), [0]])))
    return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]


def _bridge(shift: FloatArray, stances: list[tuple[int, int]]) -> None:
    """Fills the swings of ``shift`` in place: smooth between stances, constant outside them."""
    if not stances:
        return
    shift[: stances[0][0]] = shift[stances[0][0]]
    shift[stances[-1][1] :] = shift[stances[-1][1] - 1]
    for (_, end), (start, _) in pairwise(stances):
        u = (np.arange(end, start) - end + 1) / (start - end + 1)
        weight = (u * u * (3.0 - 2.0 * u))[:, None]
        shift[end:start] = (1.0 - weight) * shift[end - 1] + weight * shift[start]
