"""A room: floor, four walls that can be opened, a ceiling, and the trim that is fixed to them."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from render_jobs import Lamp, Material
from whacamole.stage.floor import Floor
from whacamole.stage.pile import Pile
from whacamole.stage.rooms.wall import THICK, Rect, Wall
from whacamole.stage.shapes import Solid, box, ground_grid
from whacamole.stage.stage import SetBuilder

__all__ = ["Room", "daylight_lamps", "room"]

OUTWARD = (("wall-x", 0.0), ("wall-y", 90.0), ("wall-minus-x", 180.0), ("wall-minus-y", 270.0))
"""Each wall, and which way out of the room it is [°]."""

SMOOTH = "-smooth"
"""A finish that ends so is shaded as round."""


@dataclass
class Room:
    """The shell of a room while it is fitted out.

    Attributes:
        walls: four, anticlockwise from +x.
        height: of the ceiling [m].
        trim: what is fixed to the ceiling or lies on the floor, in the world.
    """

    walls: list[Wall]
    height: float
    trim: Pile = field(default_factory=Pile)

    def finish(
        self,
        build: SetBuilder,
        floor: Floor,
        ground: Material,
        walls: list[Material],
        finishes: Mapping[str, Material],
        clear_of_ceiling: float,
    ) -> None:
        """Put the room on the set.

        Args:
            ground: of the floor.
            walls: one for each wall.
            finishes: of the trim.
            clear_of_ceiling: how far below the ceiling the camera stays [m]: lamps and beams are there.
        """
        assert floor.bounds is not None
        low, high = floor.bounds
        build.bounds = (
            (float(low[0]), float(low[1]), 0.0),
            (float(high[0]), float(high[1]), self.height - clear_of_ceiling),
        )
        build.add("floor", ground_grid(float(np.abs(floor.bounds).max()) + 1.0), ground)
        for wall, material in zip(self.walls, walls, strict=True):
            build.add(wall.name, wall.solid(), material)
            build.keep_out(wall.name, wall.place(0.0, -THICK / 2), _size(wall), wall.yaw)
            self.trim.add_all(wall.trim, wall.place(0.0), wall.yaw)
        middle, length = (low + high) / 2.0, high - low
        top = (float(middle[0]), float(middle[1]), self.height)
        size = (float(length[0]) + 0.6, float(length[1]) + 0.6, 0.2)
        build.add_box("ceiling", top, size, finishes["ceiling"])
        for finish, solid in self.trim.merged():
            smooth = finish.endswith(SMOOTH)
            build.add(f"room-{finish}", solid, finishes[finish.removesuffix(SMOOTH)], smooth=smooth)


def _size(wall: Wall) -> tuple[float, float, float]:
    return wall.length + 2 * THICK, THICK, wall.height


def room(floor: Floor, *, margin: float, height: float) -> Room:
    """Bound the floor by a room.

    Args:
        margin: from the people's paths to a wall [m].
        height: of the ceiling [m].
    """
    low, high = floor.low - margin, floor.high + margin
    floor.bounds = np.stack([low, high])
    middle, half = (low + high) / 2.0, (high - low) / 2.0
    walls = []
    for name, degrees in OUTWARD:
        angle = np.radians(degrees)
        out = np.array([np.cos(angle), np.sin(angle)])
        across = 1 if abs(out[0]) > 0.5 else 0
        foot = middle + out * float(half @ np.abs(out))
        walls.append(Wall(name, foot, float(angle - np.pi / 2), 2.0 * float(half[across]), height))
    return Room(walls, height)


def daylight_lamps(
    wall: Wall, windows: list[Rect], power: float, color: tuple[float, float, float]
) -> list[Lamp]:
    """Return the light of at most three of a wall's windows, ``power`` [W] for all of them."""
    chosen = windows if len(windows) <= 3 else [windows[0], windows[len(windows) // 2], windows[-1]]
    return [
        Lamp(
            position=wall.place((rect.left + rect.right) / 2, 0.12, (rect.bottom + rect.top) / 2),
            target=wall.place((rect.left + rect.right) / 2, 5.0, 0.9),
            power_w=power / len(chosen),
            size=min(rect.right - rect.left, rect.top - rect.bottom),
            color=color,
        )
        for rect in chosen
    ]


def beams(shell: Room, floor: Floor, size: tuple[float, float], every: float) -> None:
    """Span beams of a width and a height [m] below the ceiling, across the shorter way."""
    assert floor.bounds is not None
    (x0, y0), (x1, y1) = floor.bounds
    width, deep = size
    long, start, end = (0, x0, x1) if x1 - x0 > y1 - y0 else (1, y0, y1)
    count = max(2, round(float(end - start) / every))
    solids: list[Solid] = []
    for at in start + (np.arange(count) + 0.5) * (end - start) / count - every / 2 + 0.6:
        middle = (float(at), float(y0 + y1) / 2) if long == 0 else (float(x0 + x1) / 2, float(at))
        span = (width, float(y1 - y0), deep) if long == 0 else (float(x1 - x0), width, deep)
        solids.append(box((*middle, shell.height - deep), span))
    shell.trim.add("beam", *solids)
