"""A whole house: its front storey by storey, the block behind it, what runs along and down the front."""

import numpy as np

from whacamole.stage.pile import Pile
from whacamole.stage.shapes import cylinder
from whacamole.stage.town.ground_floor import build_ground_floor
from whacamole.stage.town.house import House
from whacamole.stage.town.roofs import build_roof
from whacamole.stage.town.walls import THICK, bars, pierced, rectangles
from whacamole.stage.town.windows import set_windows

__all__ = ["build_house"]

BALCONY = 1.0
"""How far a balcony juts out [m]."""

RAILING = 1.0
"""Height of its railing [m]."""

RAIL_SPACING = 0.14
"""From bar to bar of a railing [m]."""


def build_house(house: House, rng: np.random.Generator) -> tuple[Pile, Pile]:
    """Build a house: its walls, which fill its width, depth and height, and all that is on them."""
    walls, details = Pile(), Pile()
    on_walls = Pile()
    build_ground_floor(on_walls, house, rng)
    holes = rectangles(house.middles, house.floors + house.sill, house.window)
    for floor in house.floors:
        wall = (0.0, float(floor), house.width, float(floor) + house.storey)
        pierced(on_walls, house.wall, wall, rectangles(house.middles, floor + house.sill, house.window))
    set_windows(details, house, holes, rng)
    for finish, solid in on_walls.merged():
        (walls if finish in (house.wall, house.base) else details).add(finish, solid)
    walls.add_boxes(house.wall, (0.0, THICK, 0.0), (house.width, house.depth, house.height), backless=False)
    _bands(details, house)
    if house.quoins:
        _quoins(details, house)
    if house.balcony >= 0:
        _balconies(details, house)
    _drain_pipe(details, house)
    build_roof(details, house, rng)
    return walls, details


def _bands(pile: Pile, house: House) -> None:
    """A string course over the ground floor and a cornice of three steps under the eaves."""
    over = house.ground
    bars(pile, house.trim, np.array([[0.0, over - 0.12, house.width, over + 0.06]]), (-0.07, 0.0))
    top = house.height
    for rise, out in ((0.42, 0.05), (0.28, 0.14), (0.14, 0.24)):
        bars(pile, house.trim, np.array([[0.0, top - rise, house.width, top - rise + 0.14]]), (-out, 0.0))


def _quoins(pile: Pile, house: House) -> None:
    """Cut stones at both corners, long and short by turns."""
    bottom = np.arange(house.ground + 0.08, house.height - 0.75, 0.36)
    wide = np.where(np.arange(len(bottom)) % 2, 0.28, 0.45)
    left = np.stack([0.0 * bottom, bottom, wide, bottom + 0.33], axis=1)
    right = np.stack([house.width - wide, bottom, 0.0 * bottom + house.width, bottom + 0.33], axis=1)
    bars(pile, house.trim, np.concatenate([left, right]), (-0.03, 0.0))


def _balconies(pile: Pile, house: House) -> None:
    """A slab with a railing before one window of every storey."""
    middle, half = house.middles[house.balcony], min(house.window[0] / 2 + 0.45, house.bay / 2)
    left, right, front = middle - half, middle + half, -BALCONY
    x = np.arange(left + 0.03, right, RAIL_SPACING)
    y = np.arange(front + 0.03, 0.0, 2 * RAIL_SPACING)
    foot = [(x, np.full(len(x), front + 0.03))]
    foot += [(np.full(len(y), side), y) for side in (left + 0.02, right - 0.04)]
    posts = np.concatenate([np.column_stack([*place, 0.0 * place[0]]) for place in foot])
    rails = np.array([[left, front, RAILING], [left, front, RAILING], [right - 0.05, front, RAILING]])
    ends = np.array([[right, front + 0.06, 1.04], [left + 0.05, 0.0, 1.04], [right, 0.0, 1.04]])
    for floor in house.floors:
        up = np.array([0.0, 0.0, floor])
        pile.add_boxes(house.trim, (left, front, floor - 0.14), (right, 0.0, floor))
        pile.add_boxes("metal", posts + up, posts + up + np.array([0.018, 0.018, RAILING]))
        pile.add_boxes("metal", rails + up, ends + up)


def _drain_pipe(pile: Pile, house: House) -> None:
    """From the gutter down to the pavement at the right corner."""
    x = house.width - 0.14
    pile.add("metal", cylinder((x, -0.12, 0.0), 0.05, house.height - 0.1, sides=8))
    levels = np.arange(1.0, house.height - 0.6, 2.2)
    low = np.column_stack([np.full(len(levels), x - 0.06), np.full(len(levels), -0.17), levels])
    pile.add_boxes("metal", low, low + np.array([0.12, 0.17, 0.05]))
