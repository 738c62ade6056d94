"""Ground floors: doors, shop windows with their boards and awnings, gates, plain windows."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from whacamole.stage.pile import Pile
from whacamole.stage.shapes import Solid
from whacamole.stage.textures.windows import SHOPS, SIGNS
from whacamole.stage.town.house import House
from whacamole.stage.town.walls import Rectangles, bars, panes, pierced
from whacamole.stage.town.windows import set_windows

__all__ = ["build_ground_floor"]

DOOR = (1.0, 2.75)
"""Width and height of the opening of a front door with the light over it [m]."""

LEAF = 2.1
"""Height of a door's leaf [m]."""

THRESHOLD = 0.16
"""Height of a door's threshold [m]."""

STALL_RISER = 0.5
"""From the street to the glass of a shop window [m]."""

SHOP_HEAD = 2.75
"""To the head of a shop window [m]."""

PLINTH = 0.45
"""Height of the stone at the foot of a wall [m]."""


def build_ground_floor(pile: Pile, house: House, rng: np.random.Generator) -> None:
    """Build the wall of the ground floor and what is set into it."""
    door = int(rng.integers(house.bays))
    others = np.delete(house.middles, door)
    doors = _holes(house.middles[[door]], (THRESHOLD, THRESHOLD + DOOR[1] - 0.16), DOOR[0])
    if house.shop:
        openings = _holes(others, (STALL_RISER, SHOP_HEAD), house.bay - 0.4)
        _shop(pile, house, openings, rng)
    else:
        bottom = max(house.sill, PLINTH + 0.1) + 0.2
        openings = _holes(
            others, (bottom, min(bottom + house.window[1], house.ground - 0.35)), house.window[0]
        )
        set_windows(pile, house, openings, rng)
    _doors(pile, house, doors)
    holes = np.concatenate([doors, openings])
    pierced(pile, house.base, (0.0, 0.0, house.width, house.ground), holes)
    _plinth(pile, house, openings if house.shop else holes[:0], doors)


def _holes(middle: NDArray[np.float64], heights: tuple[float, float], width: float) -> Rectangles:
    low, high = (np.full(len(middle), height) for height in heights)
    return np.stack([middle - width / 2, low, middle + width / 2, high], axis=1)


def _plinth(pile: Pile, house: House, shops: Rectangles, doors: Rectangles) -> None:
    """A course of stone along the foot of the wall, but for the doors."""
    cuts = np.sort(doors[:, [0, 2]], axis=0).ravel()
    edges = np.concatenate([[0.0], cuts, [house.width]]).reshape(-1, 2)
    level = np.full(len(edges), PLINTH)
    bars(pile, "stone", np.stack([edges[:, 0], 0 * level, edges[:, 1], level], axis=1), (-0.05, 0.0))


def _doors(pile: Pile, house: House, holes: Rectangles) -> None:
    """A leaf with panels, a light over it, a frame, a handle and a step."""
    for left, bottom, right, top in holes:
        head = bottom + LEAF
        bars(pile, house.door, np.array([[left, bottom, right, head]]), (0.13, 0.19))
        middle = (left + right) / 2
        for x0, x1 in ((left + 0.12, middle - 0.05), (middle + 0.05, right - 0.12)):
            panels = np.array([[x0, bottom + 0.2, x1, bottom + 0.85], [x0, bottom + 1.0, x1, head - 0.15]])
            bars(pile, house.door, panels, (0.105, 0.13))
        bars(pile, house.frame, np.array([[left, head, right, head + 0.06]]), (0.1, 0.19))
        pile.add(
            "pane", panes(np.array([[left, head + 0.06, right, top]]), 0.16, np.zeros(1, np.int64), (4, 4))
        )
        jambs = [
            [left - 0.14, 0.0, left, top + 0.14],
            [right, 0.0, right + 0.14, top + 0.14],
            [left, top, right, top + 0.14],
        ]
        bars(pile, house.trim, np.array(jambs), (-0.06, 0.04))
        bars(
            pile, "metal", np.array([[right - 0.11, bottom + 1.0, right - 0.07, bottom + 1.14]]), (0.06, 0.13)
        )
        bars(pile, "stone", np.array([[left - 0.2, 0.0, right + 0.2, bottom]]), (-0.34, 0.2))


def _shop(pile: Pile, house: House, holes: Rectangles, rng: np.random.Generator) -> None:
    """Windows to the floor of the display, a board over them, on some houses an awning."""
    left, bottom, right, top = holes.T
    finish = "shop-lit" if rng.random() < 2.0 * house.lit else "shop"
    pile.add(finish, panes(holes, 0.15, rng.integers(SHOPS**2, size=len(holes)), (SHOPS, SHOPS)))
    for x0, x1 in (
        (left, left + 0.07),
        (right - 0.07, right),
        ((left + right) / 2 - 0.025, (left + right) / 2 + 0.025),
    ):
        bars(pile, house.door, np.stack([x0, bottom, x1, top], axis=1), (0.06, 0.18))
    for z0, z1 in ((bottom, bottom + 0.08), (top - 0.08, top), (top - 0.55, top - 0.5)):
        bars(pile, house.door, np.stack([left, z0, right, z1], axis=1), (0.06, 0.18))
    bars(pile, house.door, np.stack([left - 0.06, 0.0 * bottom, right + 0.06, bottom], axis=1), (-0.07, 0.0))
    _board(pile, house, rng)
    if rng.random() < 0.45:
        pile.add("awning", *(_awning(float(x0) - 0.1, float(x1) + 0.1) for x0, x1 in holes[:, [0, 2]]))


def _board(pile: Pile, house: House, rng: np.random.Generator) -> None:
    """The name of the shop over its windows."""
    tall = min(0.55, house.ground - SHOP_HEAD - 0.3)
    long = min(8.0 * tall, house.width - 1.0)
    bottom, middle = SHOP_HEAD + 0.15, house.width / 2
    field = np.array([[0.25, bottom - 0.06, house.width - 0.25, bottom + tall + 0.06]])
    bars(pile, house.door, field, (-0.08, 0.0))
    sign = np.array([[middle - long / 2, bottom, middle + long / 2, bottom + tall]])
    pile.add("sign", panes(sign, -0.085, rng.integers(SIGNS, size=1), (SIGNS, 1)))


def _awning(left: float, right: float) -> Solid:
    """Cloth from the wall down over the pavement, with a strip that hangs from its edge; above all heads."""
    section = [(0.0, 2.98), (-1.15, 2.5), (-1.15, 2.28)]
    vertices = np.array([(x, y, z) for y, z in section for x in (left, right)])
    faces = np.array([[0, 2, 3, 1], [2, 4, 5, 3]], np.int32)
    down = np.array([0.0, 1.25, 1.47])
    uv = np.array([[(0, a), (0, b), (right - left, b), (right - left, a)] for a, b in pairwise(down)])
    return Solid(vertices.astype(np.float32), faces, uv.astype(np.float32))
