"""Fitting out a room: windows in rows, pictures where walls are bare, furniture against walls."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from whacamole.stage.floor import Floor
from whacamole.stage.props import Finishes, Prop, put
from whacamole.stage.rooms.openings import WindowKind, door, window
from whacamole.stage.rooms.trim import picture
from whacamole.stage.rooms.wall import Rect, Wall
from whacamole.stage.stage import SetBuilder

__all__ = ["Piece", "door_in", "hang_pictures", "row_of_windows", "stand_against"]

GAP = 0.03
"""Between a wall and what stands against it [m]: its skirting."""

_TRIES = 14


@dataclass(frozen=True, eq=False)
class Piece:
    """A prop in a group before a wall.

    Attributes:
        prop: the thing.
        x: of its middle along the wall, from the middle of the group [m].
        away: from the wall to its middle [m]; None sets its back against the wall.
        turn: from facing the room [rad].
    """

    prop: Prop
    x: float = 0.0
    away: float | None = None
    turn: float = 0.0

    @property
    def distance(self) -> float:
        """From the wall to its middle [m]."""
        return self.prop.size[1] / 2.0 + GAP if self.away is None else self.away

    @property
    def half(self) -> tuple[float, float]:
        """Half its width along the wall and half its depth, turned as it is [m]."""
        c, s = abs(np.cos(self.turn)), abs(np.sin(self.turn))
        w, d, _ = self.prop.size
        return float(c * w + s * d) / 2.0, float(s * w + c * d) / 2.0


def stand_against(
    build: SetBuilder,
    floor: Floor,
    wall: Wall,
    name: str,
    pieces: list[Piece],
    finishes: Finishes,
    rng: np.random.Generator,
    *,
    clearance: float,
    corner: float = 0.15,
) -> float | None:
    """Stand a group of props before a wall where there is room, facing away from it.

    Args:
        clearance: to the people's paths [m].
        corner: to the next wall [m].

    Returns:
        The middle of the group along the wall, or None where it did not fit.
    """
    left = min(piece.x - piece.half[0] for piece in pieces)
    right = max(piece.x + piece.half[0] for piece in pieces)
    tall = max((piece.prop.size[2] for piece in pieces if piece.distance < 0.8), default=0.5)
    room = wall.length - 2.0 * corner - (right - left)
    for _ in range(_TRIES if room > 0.0 else 0):
        middle = -wall.length / 2.0 + corner - left + float(rng.uniform(0.0, room))
        rect = Rect(middle + left, middle + right, 0.0, tall)
        discs = [disc for piece in pieces for disc in _discs(wall, piece, middle)]
        if wall.is_free(rect) and all(floor.is_free(*disc, clearance) for disc in discs):
            break
    else:
        return None
    wall.take(rect)
    for disc in discs:
        floor.reserve(*disc)
    for index, piece in enumerate(pieces):
        place = wall.place(middle + piece.x, piece.distance)
        put(build, f"{name}-{index}", piece.prop, place, wall.yaw + piece.turn, finishes, rng)
    return middle


def _discs(wall: Wall, piece: Piece, middle: float) -> list[tuple[NDArray[np.float64], float]]:
    """Cover the footprint of a piece with discs: their places in the world, and their radius [m]."""
    wide, deep = piece.half
    long, short = (wide, deep) if wide > deep else (deep, wide)
    count = max(1, int(np.ceil(long / short)))
    step = long / count
    radius = float(np.hypot(step, short))
    found = []
    for offset in -long + step * (2 * np.arange(count) + 1):
        dx, dy = (offset, 0.0) if wide > deep else (0.0, offset)
        at = wall.place(middle + piece.x + dx, piece.distance + dy)
        found.append((np.asarray(at[:2]), radius))
    return found


def door_in(wall: Wall, floor: Floor, x: float, leaves: int = 1, finish: str = "leaf") -> None:
    """Cut a door and keep the floor before it free."""
    door(wall, x, leaves, finish)
    floor.reserve(np.asarray(wall.place(x, 0.5)[:2]), 0.5 + 0.25 * leaves)


def row_of_windows(
    wall: Wall, width: float, gap: float, kind: WindowKind, rng: np.random.Generator
) -> list[Rect]:
    """Cut windows evenly along a wall, leaving out what meets another opening."""
    count = max(1, int((wall.length - 0.8) / (width + gap)))
    pitch = wall.length / count
    rects = []
    for index in range(count):
        x = (index + 0.5) * pitch - wall.length / 2.0
        if wall.is_free(Rect(x - width / 2 - 0.1, x + width / 2 + 0.1, kind.bottom, kind.top)):
            rects.append(window(wall, x, width, kind, rng))
    return rects


def hang_pictures(wall: Wall, count: int, rng: np.random.Generator) -> None:
    """Hang pictures at eye level, over what is low and beside what is tall."""
    for _ in range(count):
        tall = float(rng.uniform(0.3, 0.75))
        wide = tall * float(rng.choice([0.72, 1.0, 1.4]))
        bottom = 1.55 - tall / 2.0
        x = wall.spot(rng, wide + 0.16, bottom, bottom + tall, 0.3)
        if x is not None:
            picture(wall, Rect(x - wide / 2, x + wide / 2, bottom, bottom + tall), rng)
