"""Signals over time: smoothing without lag, easing, and directions that are undefined for moments."""

import numpy as np
from scipy.ndimage import gaussian_filter1d

from camera_rigs.spherical import Array

_TRUNCATE = 4.0


def smooth(signal: Array, seconds: float, fps: float) -> Array:
    """Low-pass `signal` (T, …) with a Gaussian of standard deviation `seconds`, without lag.

    The ends are continued by odd reflection: a straight walk stays a straight walk up to its first and last frame,
    where repeating the end value would let the camera lag behind.
    """
    signal = np.asarray(signal, float)
    sigma = seconds * fps
    if len(signal) < 2 or sigma <= 0.0:
        return signal.copy()
    margin = int(np.ceil(_TRUNCATE * sigma))
    pad = [(margin, margin)] + [(0, 0)] * (signal.ndim - 1)
    padded = np.pad(signal, pad, mode="reflect", reflect_type="odd")
    filtered: Array = gaussian_filter1d(padded, sigma, axis=0, truncate=_TRUNCATE)
    return filtered[margin : margin + len(signal)]


def smootherstep(u: Array) -> Array:
    """The step 6u⁵ − 15u⁴ + 10u³ from 0 to 1, flat outside [0, 1]: position, velocity and acceleration continuous."""
    u = np.clip(np.asarray(u, float), 0.0, 1.0)
    step: Array = u * u * u * (u * (u * 6.0 - 15.0) + 10.0)
    return step


def heading_of(direction: Array, seconds: float, fps: float) -> Array:
    """The smoothed azimuth (T,) [rad], unwrapped, of horizontal directions (T, 2) whose length is their certainty.

    A direction that is undefined for moments (someone lies, tumbles or spins faster than the window) has almost no
    length after the smoothing; there the azimuth is bridged between the frames that are sure of it.
    """
    smoothed = smooth(direction, seconds, fps)
    certain = np.linalg.norm(smoothed, axis=-1) > 0.25
    if not certain.any():
        overall = direction.sum(axis=0)
        return np.full(len(direction), np.arctan2(overall[1], overall[0]))
    frames = np.arange(len(direction), dtype=float)
    azimuth = np.unwrap(np.arctan2(smoothed[certain, 1], smoothed[certain, 0]))
    return smooth(np.interp(frames, frames[certain], azimuth), seconds, fps)
