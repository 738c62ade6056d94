"""Signals over time: smoothing without lag, easing, and directions that are undefined for moments."""

import numpy as np
from numpy.typing import ArrayLike
from scipy.ndimage import gaussian_filter1d

from camera_rigs.spherical import Array

_TRUNCATE = 4.0

CERTAIN = 0.25
"""A smoothed unit direction shorter than this has turned too much within the window to mean anything."""


def smooth(signal: Array, seconds: float, fps: float, *, travels: bool = True) -> Array:
    """Low-pass `signal` (T, …) with a Gaussian of standard deviation `seconds`, without lag.

    What `travels` is continued beyond its ends by odd reflection, so that a straight walk stays one up to its
    first and last frame; repeating the end value would let the camera lag behind there. A bounded signal,
    such as a direction, is mirrored.
    """
    signal = np.asarray(signal, float)
    sigma = seconds * fps
    if len(signal) < 2 or sigma <= 0.0:
        return signal.copy()
    margin = int(np.ceil(_TRUNCATE * sigma))
    pad = [(margin, margin)] + [(0, 0)] * (signal.ndim - 1)
    padded = np.pad(signal, pad, mode="reflect", reflect_type="odd" if travels else "even")
    filtered: Array = gaussian_filter1d(padded, sigma, axis=0, truncate=_TRUNCATE)
    return filtered[margin : margin + len(signal)]


def smootherstep(u: ArrayLike) -> Array:
    """The step 6u⁵ − 15u⁴ + 10u³ from 0 to 1, held outside: velocity and acceleration are continuous."""
    u = np.clip(np.asarray(u, float), 0.0, 1.0)
    step: Array = u * u * u * (u * (u * 6.0 - 15.0) + 10.0)
    return step


def smootherstep_integral(u: ArrayLike) -> Array:
    """The integral u⁶ − 3u⁵ + 2.5u⁴ of `smootherstep` from 0 to u in [0, 1]; it ends at 1/2."""
    u = np.clip(np.asarray(u, float), 0.0, 1.0)
    integral: Array = u**4 * (u * (u - 3.0) + 2.5)
    return integral


def cushioned(time: ArrayLike, length: float, ease_in: float, ease_out: float) -> Array:
    """Progress 0 … 1 of a movement over `length` that gathers and loses its speed within the two cushions.

    Between the cushions the speed is constant. `ease_in` = `ease_out` = 0 is linear, half the length each
    is the softest ease. Held outside; any unit of time, the same for all arguments.
    """
    time = np.clip(np.asarray(time, float), 0.0, length)
    total = length - 0.5 * (ease_in + ease_out)
    position = time - 0.5 * ease_in
    if ease_in > 0.0:
        position = np.where(time < ease_in, ease_in * smootherstep_integral(time / ease_in), position)
    if ease_out > 0.0:
        left = length - time
        position = np.where(
            left < ease_out, total - ease_out * smootherstep_integral(left / ease_out), position
        )
    return position / total


def through(times: ArrayLike, values: ArrayLike, frames: ArrayLike) -> Array:
    """`values` (n, …) at `times` (n,) joined by smoothersteps: met exactly, no overshoot, held outside.

    The signal rests at every keyframe; its velocity and acceleration are continuous.
    """
    times, values, frames = (np.asarray(a, float) for a in (times, values, frames))
    if len(times) == 1:
        return np.broadcast_to(values[0], frames.shape + values.shape[1:]).copy()
    index = np.clip(np.searchsorted(times, frames, side="right") - 1, 0, len(times) - 2)
    u = smootherstep((frames - times[index]) / np.maximum(times[index + 1] - times[index], 1e-9))
    u = u.reshape(u.shape + (1,) * (values.ndim - 1))
    joined: Array = (1.0 - u) * values[index] + u * values[index + 1]
    return joined


def at(signal: Array, frame: ArrayLike) -> Array:
    """`signal` (T, …) at frames between its own and beyond: linear inside, held outside."""
    frame = np.clip(np.asarray(frame, float), 0.0, len(signal) - 1.0)
    before = np.minimum(frame.astype(int), max(len(signal) - 2, 0))
    after = np.minimum(before + 1, len(signal) - 1)
    part = (frame - before).reshape(frame.shape + (1,) * (signal.ndim - 1))
    value: Array = (1.0 - part) * signal[before] + part * signal[after]
    return value


def rate_of_change(signal: Array, order: int, fps: float) -> Array:
    """Length (T − order,) of the finite difference of `signal` (T, 3) of that order, per second^order."""
    if len(signal) <= order:
        return np.zeros(0)
    change: Array = np.linalg.norm(np.diff(signal, n=order, axis=0), axis=-1) * fps**order
    return change


def heading_of(direction: Array, seconds: float, fps: float) -> Array:
    """The smoothed azimuth (T,) [rad], unwrapped, of directions (T, 2) whose length is their certainty, 0 …
    1.

    A direction that is undefined for moments (someone lies, tumbles or spins faster than the window) has
    almost no length after the smoothing; there the azimuth is bridged between the frames that are sure of
    it.
    """
    smoothed = smooth(direction, seconds, fps, travels=False)
    certain = np.linalg.norm(smoothed, axis=-1) > CERTAIN
    if not certain.any():
        overall = direction.sum(axis=0)
        return np.full(len(direction), float(np.arctan2(overall[1], overall[0])))
    frames = np.arange(len(direction), dtype=float)
    azimuth = np.unwrap(np.arctan2(smoothed[certain, 1], smoothed[certain, 0]))
    return smooth(np.interp(frames, frames[certain], azimuth), seconds, fps)
