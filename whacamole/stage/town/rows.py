"""Rows of houses on the four sides of a place, with gaps between them where streets lead off."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render_jobs import Sun
from whacamole.stage.floor import Floor
from whacamole.stage.pile import Pile
from whacamole.stage.stage import SetBuilder
from whacamole.stage.town.finishes import TownFinishes
from whacamole.stage.town.front import build_house
from whacamole.stage.town.house import Town, draw_house

__all__ = ["FRONT_DISTANCE", "Square", "line_with_houses", "square_around"]

FRONT_DISTANCE = (13.0, 21.0)
"""From the people's paths to a house front [m]: beyond the reach of a long shot's camera."""

FAR_DISTANCE = (34.0, 52.0)
"""The same on a side that is left open."""

HOUSE_WIDTH = (7.0, 13.0)
"""Of a house front [m]."""

STREET = (5.0, 8.0)
"""Width of a street between houses [m]."""

CORNER = 11.0
"""How far rows along y reach past the corners [m]: as deep as the deepest house."""

PAVEMENT, PAVEMENT_HEIGHT, KERB = 2.6, 0.12, 0.15
"""Width and height of the pavement before the fronts, width of its kerb [m]."""

OUTWARD = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
"""Direction of each side: +x, +y, −x, −y."""

FACING = np.radians([-90.0, 0.0, 90.0, 180.0])
"""How a house, whose front looks along −y, is turned on each side."""


@dataclass(frozen=True)
class Square:
    """The space between four rows of houses.

    Attributes:
        low, high: (2,) corners [m].
    """

    low: NDArray[np.float64]
    high: NDArray[np.float64]


def square_around(
    floor: Floor, near: NDArray[np.bool_], rng: np.random.Generator, sun: Sun | None, tallest: float
) -> Square:
    """Draw how far off the houses stand, on the ``near`` sides (+x, +y, −x, −y) and on the others.

    Towards the ``sun`` they stand farther off, so that the shadow of the ``tallest`` [m] ends before it
    reaches the people.
    """
    shadow = np.zeros(2) if sun is None else -np.asarray(sun.direction[:2]) / -sun.direction[2] * tallest
    reach = np.where(near, rng.uniform(*FRONT_DISTANCE, 4), rng.uniform(*FAR_DISTANCE, 4))
    reach = np.maximum(reach, FRONT_DISTANCE[0] + np.maximum(OUTWARD @ shadow, 0.0))
    return Square(floor.low - reach[2:], floor.high + reach[:2])


def line_with_houses(
    build: SetBuilder,
    square: Square,
    town: Town,
    rng: np.random.Generator,
    *,
    streets: bool,
    glow: float = 0.0,
) -> None:
    """Build houses along all sides of a square.

    Args:
        streets: whether a street leads off on every side.
        glow: of lit windows.
    """
    finishes = TownFinishes(build, rng, glow)
    for side in range(4):
        axis = side % 2
        size = square.high - square.low
        # Rows along y reach past the corners, rows along x fit in between.
        length = float(size[1 - axis]) + (2.0 * CORNER if axis == 0 else 0.0)
        place = (square.low + square.high) / 2.0 + OUTWARD[side] * size / 2.0
        houses = _widths(length, rng, streets)
        _row(build, f"house-{side}", place, float(FACING[side]), houses, town, finishes, rng)
    for finish, solid in _pavement(square).merged():
        build.add(f"pavement.{finish}", solid, finishes[finish])


def _pavement(square: Square) -> Pile:
    """A raised strip of slabs along the fronts on all sides, with its kerb."""
    laid, size = Pile(), square.high - square.low
    for side in range(4):
        axis, strip = side % 2, Pile()
        half = float(size[1 - axis]) / 2.0 - (0.0 if axis == 0 else PAVEMENT)
        strip.add_boxes("slabs", (-half, KERB - PAVEMENT, 0.0), (half, 0.0, PAVEMENT_HEIGHT))
        x = np.arange(-half, half - 1.0, 1.0)
        low = np.column_stack([x, 0 * x - PAVEMENT, 0 * x])
        strip.add_boxes("stone", low, low + np.array([0.985, KERB, PAVEMENT_HEIGHT + 0.005]))
        place = (square.low + square.high) / 2.0 + OUTWARD[side] * size / 2.0
        laid.add_all(strip, (float(place[0]), float(place[1]), 0.0), float(FACING[side]))
    return laid


def _widths(length: float, rng: np.random.Generator, street: bool) -> list[tuple[float, float]]:
    """Divide a row into houses: start and width [m] of each; a gap between two is a street."""
    gap = float(rng.uniform(*STREET)) if street and length > 40.0 else 0.0
    count = max(2, round((length - gap) / float(rng.uniform(*HOUSE_WIDTH))))
    share = rng.uniform(0.75, 1.25, count)
    width = share / share.sum() * (length - gap)
    start = np.concatenate([[0.0], width.cumsum()[:-1]]) - length / 2.0
    start[int(rng.integers(1, count)) :] += gap
    return [(float(x), float(w)) for x, w in zip(start, width, strict=True)]


def _row(
    build: SetBuilder,
    name: str,
    place: NDArray[np.float64],
    yaw: float,
    houses: list[tuple[float, float]],
    town: Town,
    finishes: TownFinishes,
    rng: np.random.Generator,
) -> None:
    """Build one row about ``place`` on its line of fronts; what is on the walls is one mesh a finish."""
    along, into = np.array([np.cos(yaw), np.sin(yaw)]), np.array([-np.sin(yaw), np.cos(yaw)])
    row = Pile()
    for index, (start, width) in enumerate(houses):
        house = draw_house(rng, width, town)
        walls, details = build_house(house, rng)
        corner = place + start * along
        base = (float(corner[0]), float(corner[1]), 0.0)
        stood = Pile()
        stood.add_all(walls, base, yaw)
        for finish, solid in stood.merged():
            build.add(f"{name}-{index}.{finish}", solid, finishes.wall(finish, f"{name}-{index}", rng))
        middle = corner + width / 2 * along + house.depth / 2 * into
        box = (width, house.depth, house.height)
        build.keep_out(f"{name}-{index}", (float(middle[0]), float(middle[1]), 0.0), box, yaw)
        row.add_all(details, base, yaw)
    for finish, solid in row.merged():
        build.add(f"fronts-{name}.{finish}", solid, finishes[finish])
