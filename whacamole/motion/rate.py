"""From any frame rate to another: rates as exact fractions, rotations by slerp, positions linearly."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
from scipy.spatial.transform import Rotation

from whacamole.motion.data import FPS, FloatArray

MIN_RATE, MAX_RATE = 1, 1000

FILM_RATE = Fraction(int(FPS))
"""The rate of a motion unless another is asked for."""


def rational_rate(rate: float) -> Fraction:
    """The exact rate [1/s] meant by a stored float.

    Motion files carry rates such as 120.00004577 (a rounded frame time, inverted) or 59.94. A rate within
    1e-5 of a whole number is that number, one as near to n·1000/1001 is that (NTSC), any other the nearest
    fraction with a denominator up to 1000. Raises :class:`ValueError` outside [1, 1000].
    """
    if not (math.isfinite(rate) and MIN_RATE <= rate <= MAX_RATE):
        raise ValueError(f"the frame rate is {rate:g}, expected {MIN_RATE} to {MAX_RATE} fps")
    whole = round(rate)
    for candidate in (Fraction(whole), Fraction(math.ceil(rate) * 1000, 1001)):
        if abs(rate / float(candidate) - 1.0) < 1e-5:
            return candidate
    return Fraction(rate).limit_denominator(1000)


def resampled_length(num_frames: int, rate: Fraction, fps: Fraction = FILM_RATE) -> int:
    """Number of frames at ``fps`` that lie within ``num_frames`` frames at ``rate`` (no extrapolation)."""
    return int((num_frames - 1) * fps / rate) + 1 if num_frames else 0


class Resampler:
    """Maps series of ``num_frames`` at ``rate`` to ``fps``.

    Frame k lies at source position k·rate/fps, computed in fractions: where the ratio is whole, frames are
    copied and not a bit changes.
    """

    def __init__(self, num_frames: int, rate: Fraction, fps: Fraction = FILM_RATE) -> None:
        step = rate / fps
        at = [k * step for k in range(resampled_length(num_frames, rate, fps))]
        self._low = np.array([int(s) for s in at], dtype=np.intp)
        self._fraction = np.array([float(s - int(s)) for s in at])
        self._high = np.minimum(self._low + 1, num_frames - 1)

    @property
    def num_frames(self) -> int:
        """Length of the result."""
        return len(self._low)

    def linear(self, values: FloatArray) -> FloatArray:
        """``values (T,...)`` interpolated linearly."""
        low = values[self._low]
        between = self._fraction > 0
        weight = self._fraction[between].reshape(-1, *([1] * (values.ndim - 1)))
        low[between] += weight * (values[self._high[between]] - low[between])
        return low

    def rotations(self, rotvec: FloatArray) -> FloatArray:
        """``rotvec (T,...,3)`` axis-angle [rad] interpolated by slerp: R₀ exp(f · log(R₀⁻¹ R₁))."""
        result = rotvec[self._low]
        between = self._fraction > 0
        if not between.any():
            return result
        shape = result[between].shape
        first = Rotation.from_rotvec(result[between].reshape(-1, 3))
        last = Rotation.from_rotvec(rotvec[self._high[between]].reshape(-1, 3))
        per_frame = first.as_rotvec().shape[0] // int(between.sum())
        fraction = np.repeat(self._fraction[between], per_frame)
        turn = (first.inv() * last).as_rotvec() * fraction[:, None]
        result[between] = (first * Rotation.from_rotvec(turn)).as_rotvec().reshape(shape)
        return result
