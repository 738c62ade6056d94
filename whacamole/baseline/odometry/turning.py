"""Two views without translation: the turn that explains most, and what it leaves unexplained (parallax)."""

from dataclasses import dataclass

import numpy as np

from whacamole.baseline.odometry.features import PointTracks, rays
from whacamole.baseline.rigid import BoolArray, FloatArray, rigid

_ROUNDS = 6


def turn_between(first: FloatArray, second: FloatArray, focal: float) -> tuple[FloatArray, float]:
    """The rotation (3, 3) from rays (n, 3) to rays (n, 3), and the median miss [px] of the rays it turns.

    Kabsch's rotation between unit rays, those that miss weighted down (Cauchy, at 1.5 medians).
    """
    a, b = (ray / np.linalg.norm(ray, axis=-1, keepdims=True) for ray in (first, second))
    weight = np.ones(len(a))
    R, miss = np.eye(3), np.zeros(len(a))
    for _ in range(_ROUNDS):
        U, _, Vt = np.linalg.svd((weight[:, None] * b).T @ a)
        R = U @ np.diag([1.0, 1.0, np.linalg.det(U @ Vt)]) @ Vt
        miss = np.linalg.norm(a @ R.T - b, axis=-1) * focal
        spread = max(1.5 * float(np.median(miss)), 0.1)
        weight = 1.0 / (1.0 + (miss / spread) ** 2)
    return R, float(np.median(miss))


def shared_rays(tracks: PointTracks, K: FloatArray, i: int, j: int) -> tuple[FloatArray, FloatArray]:
    """Rays (n, 3) of the points followed in both frames, in each of the two."""
    both = tracks.tracked[i] & tracks.tracked[j]
    pixels = tracks.pixels[[i, j]][:, both].astype(np.float64)
    return rays(pixels[0], K[i]), rays(pixels[1], K[j])


@dataclass(frozen=True, eq=False)
class Turning:
    """A camera that only turns.

    Attributes:
        T_world_camera: (T, 4, 4) without translation.
        reached: (T,) frames linked to frame 0 without a gap.
    """

    T_world_camera: FloatArray
    reached: BoolArray


def turning_only(tracks: PointTracks, K: FloatArray, fewest: int) -> Turning:
    """The camera's turns from frame to frame, as far as at least ``fewest`` points link the frames."""
    T = len(K)
    R = np.tile(np.eye(3), (T, 1, 1))
    reached = np.zeros(T, dtype=bool)
    reached[0] = True
    for frame in range(1, T):
        first, second = shared_rays(tracks, K, frame - 1, frame)
        if len(first) < fewest:
            break
        turn, _ = turn_between(first, second, float(K[frame, 0, 0]))
        R[frame] = R[frame - 1] @ turn.T
        reached[frame] = True
    return Turning(rigid(R, np.zeros((T, 3))), reached)


def widest_pair(
    tracks: PointTracks, K: FloatArray, fewest: int, enough: float
) -> tuple[int, int, float] | None:
    """The two frames to start a map from, and the parallax [px] between them.

    Of frames that share ``fewest`` points, the pair whose points move most beyond what a turn explains; the
    search ends early at ``enough`` pixels.
    """
    T, best = len(K), None
    for gap in (4, 8, 12, 18, 26, 38, 54, 80):
        for i in range(0, max(T - gap, 0), max(4, gap // 2)):
            first, second = shared_rays(tracks, K, i, i + gap)
            if len(first) < fewest:
                continue
            _, parallax = turn_between(first, second, float(K[i, 0, 0]))
            if best is None or parallax > best[2]:
                best = (i, i + gap, parallax)
        if best is not None and best[2] > enough:
            break
    return best
