"""People who have nothing to do with each other, placed so that nobody walks through anybody.

What counts is the whole take, not its first frame: paths may cross if they are walked at different times.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from whacamole.body import Posed

__all__ = ["Footprint", "Placement", "gap_over_time", "place_crowd"]

PERSONAL_SPACE = 0.25
"""Gap between the footprints of two people, at least [m]."""

FIRST_RADIUS = 2.0
"""Newcomers are first tried within this distance of the middle of the scene [m]; crowds look like crowds."""

GROWTH = 1.15
"""Each round of tries without success widens the circle by this factor."""

_TRIES_A_ROUND = 16
_ROUNDS = 24


@dataclass(frozen=True)
class Footprint:
    """Where a person is, seen from above: a disc for each frame that holds all of the body.

    Attributes:
        center: (T, 2) [m].
        radius: (T,) [m].
    """

    center: NDArray[np.float64]
    radius: NDArray[np.float64]

    @classmethod
    def of(cls, posed: Posed) -> "Footprint":
        """Return the footprint of posed vertices (T, V, 3)."""
        flat = posed.vertices[..., :2].astype(np.float64)
        center = (flat.min(axis=1) + flat.max(axis=1)) / 2.0
        return cls(center, np.linalg.norm(flat - center[:, None], axis=2).max(axis=1))

    def moved(self, placement: "Placement") -> "Footprint":
        """Return the footprint after a turn about the origin and a shift."""
        c, s = np.cos(placement.yaw), np.sin(placement.yaw)
        turned = self.center @ np.array([[c, s], [-s, c]])
        return Footprint(turned + np.array(placement.shift), self.radius)


@dataclass(frozen=True)
class Placement:
    """A turn about the vertical axis through the origin [rad], then a shift on the ground [m]."""

    yaw: float
    shift: tuple[float, float]

    def as_transform(self) -> NDArray[np.float64]:
        """Return the 4×4 world transform."""
        c, s = np.cos(self.yaw), np.sin(self.yaw)
        transform = np.eye(4)
        transform[:2, :2] = [[c, -s], [s, c]]
        transform[:2, 3] = self.shift
        return transform


def gap_over_time(one: Footprint, other: Footprint) -> float:
    """Return the smallest gap [m] between two people over all frames; negative where their discs overlap."""
    apart = np.linalg.norm(one.center - other.center, axis=1)
    return float((apart - one.radius - other.radius).min())


def place_crowd(
    present: list[Footprint],
    newcomers: list[Footprint],
    rng: np.random.Generator,
    allows: Callable[[Footprint], bool] = lambda _: True,
) -> list[Placement | None]:
    """Place each newcomer among those present and those placed before.

    Args:
        present: people whose place is fixed.
        newcomers: T frames each, anywhere; the middle of their path is moved to the place drawn.
        allows: whether the ground is free under a footprint.

    Returns:
        One placement a newcomer, None where no free place was found within the tries.
    """
    everybody = list(present)
    placements: list[Placement | None] = []
    for newcomer in newcomers:
        placement = _free_place(everybody, newcomer, rng, allows)
        placements.append(placement)
        if placement is not None:
            everybody.append(newcomer.moved(placement))
    return placements


def _free_place(
    everybody: list[Footprint],
    newcomer: Footprint,
    rng: np.random.Generator,
    allows: Callable[[Footprint], bool],
) -> Placement | None:
    middle = (newcomer.center.min(axis=0) + newcomer.center.max(axis=0)) / 2.0
    reach = FIRST_RADIUS
    for _ in range(_ROUNDS):
        for _ in range(_TRIES_A_ROUND):
            yaw, bearing = rng.uniform(0.0, 2.0 * np.pi, 2)
            distance = reach * np.sqrt(rng.random())
            c, s = np.cos(yaw), np.sin(yaw)
            turned = np.array([c * middle[0] - s * middle[1], s * middle[0] + c * middle[1]])
            shift = distance * np.array([np.cos(bearing), np.sin(bearing)]) - turned
            placement = Placement(float(yaw), (float(shift[0]), float(shift[1])))
            moved = newcomer.moved(placement)
            apart = all(gap_over_time(moved, other) > PERSONAL_SPACE for other in everybody)
            if apart and allows(moved):
                return placement
        reach *= GROWTH
    return None
