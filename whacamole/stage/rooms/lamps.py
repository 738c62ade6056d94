"""Lamps below a ceiling: what lights the room, and the fixture that looks lit."""

from collections.abc import Callable
from typing import Final

import numpy as np

from render_jobs import Lamp
from whacamole.stage.floor import Floor
from whacamole.stage.pile import Pile
from whacamole.stage.props.pieces import rod
from whacamole.stage.shapes import box, lathe

__all__ = ["FIXTURES", "ceiling_lamps"]

MOST_LAMPS = 12
"""In a room: each costs light samples, and the raster engine takes sixteen lights."""


def _bowl(fixture: Pile) -> None:
    """A shallow bowl of opal glass under a plate."""
    fixture.add("housing", *(lathe([(0.14, -0.03), (0.14, 0.0)], 20),))
    fixture.add("lit-smooth", lathe([(0.05, -0.12), (0.14, -0.105), (0.2, -0.065), (0.21, -0.03)], 24))


def _panel(fixture: Pile) -> None:
    """A square flat panel."""
    fixture.add("housing", box((0.0, 0.0, -0.03), (0.64, 0.64, 0.03)))
    fixture.add("lit", box((0.0, 0.0, -0.034), (0.6, 0.6, 0.01)))


def _tubes(fixture: Pile) -> None:
    """Two tubes under a tray."""
    fixture.add("housing", box((0.0, 0.0, -0.06), (1.56, 0.22, 0.06)))
    for y in (-0.06, 0.06):
        fixture.add("lit-smooth", rod((-0.74, y, -0.085), (0.74, y, -0.085), 0.019))
    for x in (-0.755, 0.755):
        fixture.add("housing", box((x, 0.0, -0.105), (0.03, 0.2, 0.06)))


def _bay(fixture: Pile) -> None:
    """A bell of sheet metal that hangs on a rod."""
    fixture.add("housing", rod((0.0, 0.0, -0.3), (0.0, 0.0, 0.0), 0.012))
    bell = [(0.235, -0.55), (0.225, -0.5), (0.16, -0.4), (0.09, -0.34), (0.07, -0.28)]
    fixture.add("housing", lathe(bell, 20))
    fixture.add("lit", lathe([(0.2, -0.56), (0.2, -0.54)], 20))


FIXTURES: Final[dict[str, tuple[Callable[[Pile], None], float]]] = {
    "bowl": (_bowl, 0.12), "panel": (_panel, 0.034), "tubes": (_tubes, 0.105), "bay": (_bay, 0.56),
}  # fmt: skip
"""Each with how far it reaches below what it hangs from [m]."""


def ceiling_lamps(
    trim: Pile,
    floor: Floor,
    height: float,
    power: float,
    color: tuple[float, float, float],
    spacing: float,
    kind: str,
) -> tuple[Lamp, ...]:
    """Hang lamps and their fixtures ``height`` [m] up, one every ``spacing`` metres or so.

    Args:
        trim: of the room.
        power: of a lamp for each square of the spacing [W].
        kind: one of ``FIXTURES``.
    """
    assert floor.bounds is not None, "lamps hang in a room"
    low, high = floor.bounds
    sides = np.maximum(np.round((high - low) / spacing), 1)
    while sides.prod() > MOST_LAMPS:
        sides[int(np.argmax(sides))] -= 1
    columns, rows = sides.astype(int)
    watts = power * float((high - low).prod()) / spacing**2 / (columns * rows)
    make, drop = FIXTURES[kind]
    lamps = []
    for x in low[0] + (np.arange(columns) + 0.5) * (high[0] - low[0]) / columns:
        for y in low[1] + (np.arange(rows) + 0.5) * (high[1] - low[1]) / rows:
            fixture = Pile()
            make(fixture)
            trim.add_all(fixture, (float(x), float(y), height))
            at = (float(x), float(y), height - drop - 0.02)
            lamps.append(
                Lamp(position=at, target=(float(x), float(y), 0.0), power_w=watts, size=1.2, color=color)
            )
    return tuple(lamps)
