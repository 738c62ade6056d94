"""A wall of a room as a surface to put things on and before."""

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from whacamole.stage.pile import Pile
from whacamole.stage.shapes import Solid, Vector, boxes, moved, turned

__all__ = ["THICK", "Rect", "Wall"]

THICK = 0.3
"""Of a wall [m]."""

_TRIES = 24


class Rect(NamedTuple):
    """Part of a wall's surface [m]: along it from its middle, seen from inside, and above the floor."""

    left: float
    right: float
    bottom: float
    top: float

    def meets(self, other: "Rect") -> bool:
        """Whether the two overlap."""
        return (
            self.left < other.right and other.left < self.right
            and self.bottom < other.top and other.bottom < self.top
        )  # fmt: skip


@dataclass
class Wall:
    """One of four. Its own axes: x to the right as seen from inside, y out of the room, z up.

    Attributes:
        name: of its mesh and obstacle.
        middle: (2,) of the inner surface's foot, in the world [m].
        yaw: turns its axes into the world's [rad].
        length, height: of the inner surface [m].
        trim: what is fixed to it, in its own axes.
        openings: doors and windows, cut out of it.
    """

    name: str
    middle: NDArray[np.float64]
    yaw: float
    length: float
    height: float
    trim: Pile = field(default_factory=Pile)
    openings: list[Rect] = field(default_factory=list)
    _taken: list[Rect] = field(default_factory=list)

    def place(self, x: float, away: float = 0.0, z: float = 0.0) -> Vector:
        """Return the point ``away`` [m] before the wall, in the world."""
        c, s = np.cos(self.yaw), np.sin(self.yaw)
        return (float(self.middle[0] + c * x + s * away), float(self.middle[1] + s * x - c * away), z)

    def take(self, rect: Rect) -> None:
        """Keep a part of the surface, and what stands before it, for one thing."""
        self._taken.append(rect)

    def is_free(self, rect: Rect) -> bool:
        """Whether nothing has been put there."""
        return not any(rect.meets(other) for other in self._taken)

    def spot(
        self, rng: np.random.Generator, width: float, bottom: float, top: float, corner: float = 0.1
    ) -> float | None:
        """Draw where the middle of something goes, and keep its place; None where the wall is full."""
        reach = self.length / 2.0 - corner - width / 2.0
        for _ in range(_TRIES):
            x = float(rng.uniform(-1.0, 1.0)) * max(reach, 0.0)
            rect = Rect(x - width / 2.0, x + width / 2.0, bottom, top)
            if reach > 0.0 and self.is_free(rect):
                self.take(rect)
                return x
        return None

    def cut(self, rect: Rect, around: float) -> None:
        """Open the wall, and keep ``around`` [m] of it free on both sides."""
        self.openings.append(rect)
        self.take(Rect(rect.left - around, rect.right + around, rect.bottom, rect.top + around))

    def gaps(self, bottom: float, top: float) -> list[tuple[float, float]]:
        """Return the stretches (left, right) between the openings that reach into a band of heights."""
        left, stretches = -self.length / 2.0, []
        for hole in sorted(self.openings):
            if hole.bottom < top and bottom < hole.top:
                stretches.append((left, hole.left))
                left = hole.right
        return [*stretches, (left, self.length / 2.0)]

    def solid(self) -> Solid:
        """Return the masonry around the openings, in the world; corners overlap those of its neighbours."""
        edge = self.length / 2.0 + THICK
        spans, left = [], -edge
        for hole in sorted(self.openings):
            spans += [(left, hole.left, 0.0, self.height), (hole.left, hole.right, hole.top, self.height)]
            if hole.bottom > 0.0:
                spans.append((hole.left, hole.right, 0.0, hole.bottom))
            left = hole.right
        spans.append((left, edge, 0.0, self.height))
        low = [(x0, 0.0, z0) for x0, _, z0, _ in spans]
        high = [(x1, THICK, z1) for _, x1, _, z1 in spans]
        return self.in_world(boxes(low, high))

    def in_world(self, solid: Solid, x: float = 0.0, away: float = 0.0, z: float = 0.0) -> Solid:
        """Return a solid in the wall's axes, moved along it, in those of the world."""
        local = moved(solid, (x, -away, z))
        return turned(local, (float(self.middle[0]), float(self.middle[1]), 0.0), self.yaw)
