"""Roofs: pitched ones of tiles with dormers and chimneys, flat ones behind a parapet."""

import numpy as np

from whacamole.stage.pile import Pile
from whacamole.stage.shapes import Solid, Vector
from whacamole.stage.textures.windows import PANES
from whacamole.stage.town.house import House
from whacamole.stage.town.walls import bars, panes

__all__ = ["build_roof", "gable", "ridge"]

EAVES = 0.35
"""How far a roof juts out over front and back [m]."""

PITCH = (0.65, 0.95)
"""Rise of a roof over its run."""

PARAPET = (0.4, 0.9)
"""Height of a parapet [m]."""


def build_roof(pile: Pile, house: House, rng: np.random.Generator) -> None:
    """Put a roof on the house."""
    if house.pitched:
        pitch = float(rng.uniform(*PITCH))
        roof = f"roof-{int(rng.integers(2))}"
        pile.add(roof, ridge((0.0, -EAVES, house.height), (house.width, house.depth + 2 * EAVES), pitch))
        pile.add(
            house.trim, gable((0.0, 0.0, house.height - pitch * EAVES), (house.width, house.depth), pitch)
        )
        bars(
            pile,
            "metal",
            np.array([[0.0, house.height - 0.02, house.width, house.height + 0.1]]),
            (-EAVES - 0.1, 0.04 - EAVES),
        )
        if rng.random() < 0.6:
            _dormers(pile, house, pitch, roof, rng)
        rise = pitch * (house.depth / 2 + EAVES)
        _chimneys(pile, house, house.height + rise - 0.9, 1.8, rng)
    else:
        height = float(rng.uniform(*PARAPET))
        _parapet(pile, house, height)
        _chimneys(pile, house, house.height, float(rng.uniform(1.2, 2.0)), rng)


def ridge(corner: Vector, size: tuple[float, float], pitch: float) -> Solid:
    """Return the two slopes of a roof, its ridge along x; ``corner`` is the lower left one at the front."""
    (x, y, z), (width, depth) = corner, size
    rise, run = pitch * depth / 2, depth / 2
    vertices = np.array(
        [(x + a, y + b, z + c) for b, c in ((0.0, 0.0), (run, rise), (depth, 0.0)) for a in (0.0, width)]
    )
    faces = np.array([[0, 1, 3, 2], [2, 3, 5, 4]], np.int32)
    slope = float(np.hypot(rise, run))
    uv = np.array(
        [[(0, 0), (width, 0), (width, slope), (0, slope)], [(0, slope), (width, slope), (width, 0), (0, 0)]]
    )
    return Solid(vertices.astype(np.float32), faces, uv.astype(np.float32))


def gable(corner: Vector, size: tuple[float, float], pitch: float) -> Solid:
    """Return the two triangles of wall under a ridge."""
    (x, y, z), (width, depth) = corner, size
    triangle = np.array([(0.0, 0.0), (depth, 0.0), (depth / 2, pitch * depth / 2)])
    ends = [
        np.column_stack([np.full(3, x + a), y + triangle[:, 0], z + triangle[:, 1]])
        for a in (0.01, width - 0.01)
    ]
    faces = np.array([[0, 2, 1], [3, 4, 5]], np.int32)
    uv = np.stack([triangle[[0, 2, 1]], triangle])
    return Solid(np.concatenate(ends).astype(np.float32), faces, uv.astype(np.float32))


def _dormers(pile: Pile, house: House, pitch: float, roof: str, rng: np.random.Generator) -> None:
    """Windows that stand out of the slope, each under its own small roof."""
    front, wide, tall = 0.35, 0.62, 1.35
    foot = house.height + pitch * (front + EAVES) - 0.1
    for x in house.middles[int(rng.integers(2)) :: 2]:
        back = front + (tall + 0.3) / pitch
        pile.add_boxes(house.trim, (x - wide, front, foot), (x + wide, back, foot + tall))
        hole = np.array([[x - wide + 0.14, foot + 0.22, x + wide - 0.14, foot + tall - 0.1]])
        pile.add("pane", panes(hole, front - 0.005, rng.integers(PANES**2, size=1), (PANES, PANES)))
        middle = np.array([[x - 0.03, foot + 0.22, x + 0.03, foot + tall - 0.1]])
        bars(pile, house.frame, middle, (front - 0.03, front))
        pile.add_boxes(
            roof, (x - wide - 0.1, front - 0.15, foot + tall), (x + wide + 0.1, back + 0.2, foot + tall + 0.1)
        )


def _parapet(pile: Pile, house: House, height: float) -> None:
    """A low wall around a flat roof, with a coping."""
    bottom, top, (w, d) = house.height, house.height + height, (house.width, house.depth)
    low = np.array([[0, 0, bottom], [0, d - 0.2, bottom], [0, 0.2, bottom], [w - 0.2, 0.2, bottom]])
    high = np.array([[w, 0.2, top], [w, d, top], [0.2, d - 0.2, top], [w, d - 0.2, top]])
    pile.add_boxes(house.trim, low, high, backless=False)
    pile.add_boxes("stone", (0.0, -0.06, top), (w, 0.27, top + 0.07))


def _chimneys(pile: Pile, house: House, bottom: float, height: float, rng: np.random.Generator) -> None:
    """One or two stacks near the walls to the neighbours, with pots."""
    for side in rng.permutation(2)[: int(rng.integers(1, 3))]:
        x = 0.6 if side == 0 else house.width - 0.6
        y = house.depth / 2
        pile.add_boxes(
            "brick", (x - 0.35, y - 0.55, bottom), (x + 0.35, y + 0.55, bottom + height), backless=False
        )
        pile.add_boxes(
            "stone", (x - 0.42, y - 0.62, bottom + height), (x + 0.42, y + 0.62, bottom + height + 0.1)
        )
        pots = np.array(
            [[x - 0.11, y + offset - 0.11, bottom + height + 0.1] for offset in (-0.3, 0.05, 0.3)]
        )
        pile.add_boxes("pot", pots, pots + np.array([0.22, 0.22, 0.4]))
