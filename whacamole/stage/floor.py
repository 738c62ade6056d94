"""Finding room on a floor for things that are not to be in the way of people or of each other."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

__all__ = ["CLEARANCE", "Floor"]

CLEARANCE = 3.2
"""Nothing stands nearer than this to the people's paths [m]: arms swing, and the camera passes between."""

_TRIES = 40


@dataclass
class Floor:
    """The ground around the people's paths.

    Attributes:
        paths: (N, 2) ground positions that people will have [m].
        bounds: (2, 2) low and high corner of a room; None outdoors.
    """

    paths: NDArray[np.float64]
    bounds: NDArray[np.float64] | None = None
    _taken: list[tuple[NDArray[np.float64], float]] = field(default_factory=list)

    @property
    def low(self) -> NDArray[np.float64]:
        """(2,) low corner of the rectangle around the paths [m]."""
        return np.asarray(self.paths.min(axis=0))

    @property
    def high(self) -> NDArray[np.float64]:
        """(2,) high corner of the rectangle around the paths [m]."""
        return np.asarray(self.paths.max(axis=0))

    @property
    def reach(self) -> float:
        """Farthest that a path gets from the origin along an axis [m]."""
        return float(max(np.abs(self.low).max(), np.abs(self.high).max()))

    def reserve(self, place: NDArray[np.float64], radius: float) -> None:
        """Keep a disc [m] free of everything that is yet to stand."""
        self._taken.append((place, radius))

    def is_free(self, place: NDArray[np.float64], radius: float, clearance: float) -> bool:
        """Whether a disc [m] meets nothing that stands, and keeps a gap [m] to the paths."""
        from_people = np.hypot(*(self.paths - place).T).min()
        apart = all(np.hypot(*(place - other)) > radius + taken for other, taken in self._taken)
        return bool(from_people > clearance + radius and apart)

    def spot(
        self, rng: np.random.Generator, footprint: float, beyond: float, clearance: float = CLEARANCE
    ) -> tuple[float, float] | None:
        """Draw a free place for something of radius ``footprint`` [m], and keep it free of others.

        Args:
            beyond: how far outside the rectangle of the paths it may stand [m].
            clearance: gap to the paths [m].

        Returns:
            (x, y), or None where the floor is full.
        """
        low, high = self.low - beyond, self.high + beyond
        if self.bounds is not None:
            low = np.maximum(low, self.bounds[0] + footprint)
            high = np.minimum(high, self.bounds[1] - footprint)
        for _ in range(_TRIES):
            place = rng.uniform(low, high)
            if self.is_free(place, footprint, clearance):
                self._taken.append((place, footprint))
                return float(place[0]), float(place[1])
        return None
