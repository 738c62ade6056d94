"""Contact with the ground z = 0, from height and velocity."""

from dataclasses import dataclass

import numpy as np

from whacamole.labels.arrays import Bools, Float64s, Floats, Indices
from whacamole.labels.parts import BodyParts


@dataclass(frozen=True)
class ContactThresholds:
    """What counts as contact. Stored with the labels.

    Attributes:
        ground: a vertex this high or lower may touch the ground [m].
        velocity: and does, if it moves no faster than this [m/s]: a foot that skims the floor does not count.
        person: a vertex this close to another person's skin, or inside it, touches that person [m].
    """

    ground: float = 0.03
    velocity: float = 0.5
    person: float = 0.01


def still_speed(
    before: Floats | None,
    now: Floats,
    after: Floats | None,
    fps: float,
) -> Float64s:
    """Speed of each vertex [m/s]: the lower of its mean speeds over the frame interval before and after.

    The lower of the two, so that the first frame in which a foot has landed and the last before it leaves
    count as still. Divided by the frame time, so thresholds hold at any frame rate. Zero if there is no
    neighbour.

    Args:
        before: ``(N, 3)`` one frame earlier, None at the start.
        now: ``(N, 3)`` metres.
        after: ``(N, 3)`` one frame later, None at the end.
        fps: frames per second.
    """
    steps = [
        np.linalg.norm(np.float64(1) * other - now, axis=1) for other in (before, after) if other is not None
    ]
    speed: Float64s = np.min(steps, axis=0) * fps if steps else np.zeros(len(now))
    return speed


def ground_vertices(
    before: Floats | None,
    now: Floats,
    after: Floats | None,
    fps: float,
    limits: ContactThresholds,
) -> Bools:
    """``(V,)`` vertices at rest on the ground: low enough, and slow enough by :func:`still_speed`."""
    touching: Bools = now[:, 2] <= limits.ground
    low = np.flatnonzero(touching)
    around = [None if other is None else other[low] for other in (before, after)]
    touching[low] = still_speed(around[0], now[low], around[1], fps) <= limits.velocity
    return touching


class PartRows:
    """Reduces per-vertex values to parts. Vertices outside every part, and off the skin, take no part.

    Args:
        parts: the C parts.
        skin: ``(n,)`` vertex numbers of the outer skin.
    """

    def __init__(self, parts: BodyParts, skin: Indices) -> None:
        part = parts.vertex_part[skin]
        order = np.argsort(part, kind="stable")
        order = order[part[order] >= 0]
        self.count = len(parts.names)
        self.vertices = skin[order]
        self._part = part[order]
        self._present, self._start = np.unique(self._part, return_index=True)

    def minimum(self, values: Floats, absent: float = np.inf) -> Float64s:
        """``(C,)`` smallest of the values ``(V,)`` in each part; ``absent`` for a part without vertices."""
        smallest = np.full(self.count, absent)
        if len(self._start):
            smallest[self._present] = np.minimum.reduceat(values[self.vertices], self._start)
        return smallest

    def any(self, flags: Bools) -> Bools:
        """``(C,)`` whether any vertex of the part is flagged in ``(V,)``."""
        return np.bincount(self._part[flags[self.vertices]], minlength=self.count) > 0
