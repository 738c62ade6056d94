"""Solids sorted by what they are made of, so that many things become few meshes."""

from collections.abc import Iterator
from dataclasses import dataclass, field

from numpy.typing import ArrayLike

from whacamole.stage.shapes import Solid, Vector, boxes, joined, turned

__all__ = ["Pile"]


@dataclass
class Pile:
    """Solids by finish."""

    _solids: dict[str, list[Solid]] = field(default_factory=dict)

    def add(self, finish: str, *solids: Solid) -> None:
        """Lay solids on the pile."""
        self._solids.setdefault(finish, []).extend(solids)

    def add_boxes(self, finish: str, low: ArrayLike, high: ArrayLike, *, backless: bool = True) -> None:
        """Lay level boxes (N, 3) on the pile, without the faces towards +y unless these are wanted."""
        self.add(finish, boxes(low, high, backless=backless))

    def add_all(self, other: "Pile", place: Vector, yaw: float = 0.0) -> None:
        """Lay another pile on this one, turned about z [rad] and put at a place."""
        for finish, solid in other.merged():
            self.add(finish, turned(solid, place, yaw))

    def merged(self) -> Iterator[tuple[str, Solid]]:
        """Go through the finishes, each with all its solids as one."""
        for finish, solids in self._solids.items():
            if solids:
                yield finish, joined(solids)
