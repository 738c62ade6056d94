"""Between frame rates: the velocimeter lives at 30 fps, videos do not."""

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from whacamole.baseline.rigid import FloatArray


class Resampling:
    """Frames of one rate seen at another, over the same stretch of time.

    Args:
        num_frames: n frames, at least one.
        fps: their rate.
        other: the rate wanted.
    """

    def __init__(self, num_frames: int, fps: float, other: float) -> None:
        self._times = np.arange(num_frames) / fps
        count = 1 + int(np.floor(self._times[-1] * other + 1e-9))
        # A rate that is nearly the same (29.97) keeps its frames: nothing is gained by moving them by a hair.
        self.same = abs(fps - other) < 0.005 * other
        self.times = self._times if self.same else np.arange(count) / other

    def points(self, values: FloatArray) -> FloatArray:
        """Values (n, …) at the other rate, linearly."""
        return values if self.same else _interpolate(self._times, values, self.times)

    def back(self, values: FloatArray) -> FloatArray:
        """Values at the other rate (m, …) at the n frames again; beyond the last, as it was going there."""
        if self.same:
            return values
        if len(values) == 1:
            return np.repeat(values, len(self._times), axis=0)
        ahead = 2.0 * values[-1:] - values[-2:-1]
        times = np.append(self.times, 2.0 * self.times[-1] - self.times[-2])
        return _interpolate(times, np.concatenate([values, ahead]), self._times)

    def rotations(self, values: FloatArray) -> FloatArray:
        """Rotations (n, 3, 3) at the other rate, along the shortest arcs."""
        if self.same or len(values) == 1:
            return values
        turned: FloatArray = Slerp(self._times, Rotation.from_matrix(values))(self.times).as_matrix()
        return turned


def _interpolate(times: FloatArray, values: FloatArray, at: FloatArray) -> FloatArray:
    place = np.clip(np.searchsorted(times, at, side="right") - 1, 0, max(len(times) - 2, 0))
    after = np.minimum(place + 1, len(times) - 1)
    step = np.where(after > place, times[after] - times[place], 1.0)
    share = ((at - times[place]) / step).reshape(-1, *(1,) * (values.ndim - 1))
    between: FloatArray = values[place] * (1.0 - share) + values[after] * share
    return between
