"""What stands against the walls of a home: bookcases, sideboards, a television on its bench, a kitchen."""

import itertools

import numpy as np

from whacamole.stage.props.pieces import box_part, in_cells, legs, rod
from whacamole.stage.props.prop import Part, Prop, drawn, fitted
from whacamole.stage.props.tables import some_things, vase
from whacamole.stage.shapes import Solid, boxes, moved
from whacamole.stage.textures.interiors import CELLS

__all__ = ["bookcase", "kitchen", "sideboard", "television"]

BOARD = 0.022
"""Thickness of a shelf [m]."""


def books(
    rng: np.random.Generator, start: float, end: float, z: float, tallest: float, front: float
) -> Solid | None:
    """Return a row of books between two places along x, their backs ``front`` of y; None where none fits."""
    thick = rng.uniform(0.018, 0.05, int((end - start) / 0.018))
    thick = thick[thick.cumsum() < end - start]
    if not len(thick):
        return None
    right = start + thick.cumsum()
    tall = np.minimum(rng.uniform(0.17, 0.3, len(thick)), tallest)
    deep = rng.uniform(0.13, 0.21, len(thick))
    inset = rng.uniform(0.0, 0.02, len(thick))
    low = np.column_stack([right - thick, front + inset, np.full(len(thick), z)])
    high = np.column_stack([right - 0.001, front + deep, z + tall])
    return in_cells(boxes(low, high), rng.integers(0, CELLS**2, len(thick)), 6)


def bookcase(rng: np.random.Generator) -> Prop:
    """One to three bays of shelves with books and a few other things."""
    bays, finish = int(rng.integers(1, 4)), str(rng.choice(["wood", "wood", "white"]))
    bay, depth, height = drawn(rng, (0.76, 0.95), (0.28, 0.34), (1.75, 2.15))
    width = bays * bay + BOARD
    x, y = width / 2, depth / 2
    uprights = [(-x + k * bay, -y, 0.0, -x + k * bay + BOARD, y, height) for k in range(bays + 1)]
    levels = np.linspace(0.08, height - BOARD, int(rng.integers(6, 8)))
    shelves = [(-x, -y + 0.004, float(z), x, y, float(z) + BOARD) for z in levels]
    parts = [
        box_part(
            finish,
            *uprights,
            *shelves,
            (-x, y - 0.01, 0.0, x, y, height),
            (-x, -y + 0.03, 0.0, x, -y + 0.05, 0.08),
        )
    ]
    clear = float(levels[1] - levels[0]) - BOARD
    for k in range(bays):
        left, right = -x + k * bay + BOARD + 0.005, -x + (k + 1) * bay - 0.005
        for z in levels[:-1]:
            parts += _on_shelf(rng, left, right, float(z) + BOARD, clear - 0.02, -y + 0.05)
    return fitted("bookcase", parts)


def _on_shelf(
    rng: np.random.Generator, left: float, right: float, z: float, clear: float, front: float
) -> list[Part]:
    parts = []
    start = left + float(rng.uniform(0.0, 0.15))
    end = start + (right - start) * float(rng.uniform(0.45, 1.0))
    row = books(rng, start, end, z, clear, front)
    if row is not None:
        parts.append(Part(row, "things"))
    if right - end > 0.22:
        thing = vase(rng, min(clear, float(rng.uniform(0.14, 0.26))))
        parts.append(Part(moved(thing, ((end + right) / 2, front + 0.1, z)), "things", smooth=True))
    return parts


def _fronts(
    finish: str, left: float, right: float, bottom: float, top: float, y: float, count: int
) -> list[Part]:
    """Doors side by side with gaps between them, and their handles, before the plane ``y``."""
    edges = np.linspace(left, right, count + 1)
    doors = [
        (float(a) + 0.003, y - 0.018, bottom + 0.003, float(b) - 0.003, y, top - 0.003)
        for a, b in itertools.pairwise(edges)
    ]
    grips = [
        (
            b - 0.06 if k % 2 == 0 else a + 0.045,
            y - 0.035,
            top - 0.2,
            b - 0.045 if k % 2 == 0 else a + 0.06,
            y - 0.018,
            top - 0.07,
        )
        for k, (a, _, _, b, _, _) in enumerate(doors)
    ]
    return [box_part(finish, *doors), box_part("metal", *grips)]


def sideboard(rng: np.random.Generator) -> Prop:
    """A long low cupboard on legs, with a lamp and other things on top."""
    width, depth, height, foot = drawn(rng, (1.3, 1.9), (0.4, 0.46), (0.68, 0.85), (0.08, 0.2))
    finish = str(rng.choice(["wood", "wood", "white"]))
    x, y = width / 2, depth / 2
    parts = [box_part(finish, (-x, -y + 0.02, foot, x, y, height))]
    parts += _fronts(finish, -x, x, foot + 0.01, height - 0.02, -y + 0.02, int(rng.integers(2, 5)))
    parts += [Part(leg, "wood") for leg in legs(width - 0.1, depth - 0.08, foot, 0.02)]
    parts += some_things(rng, width, depth, height, int(rng.integers(2, 5)))
    return fitted("sideboard", parts)


def television(rng: np.random.Generator) -> Prop:
    """A screen on a low bench."""
    width, depth, height = drawn(rng, (1.5, 2.0), (0.38, 0.44), (0.42, 0.52))
    wide = float(rng.uniform(1.05, 1.35))
    tall, x, y = wide * 0.57, width / 2, depth / 2
    z = height + 0.07
    parts = [
        box_part("wood", (-x, -y + 0.02, 0.06, x, y, height)),
        box_part("dark", (-x + 0.06, -y + 0.06, 0.0, x - 0.06, y - 0.04, 0.06)),
    ]
    parts += _fronts("wood", -x, x, 0.07, height - 0.02, -y + 0.02, 3)
    parts.append(
        box_part(
            "dark",
            (-wide / 2, 0.02, z, wide / 2, 0.06, z + tall),
            (-0.2, -0.06, height, 0.2, 0.12, height + 0.012),
            (-0.03, 0.03, height, 0.03, 0.055, z),
        )
    )
    parts.append(
        box_part("screen", (-wide / 2 + 0.012, 0.014, z + 0.012, wide / 2 - 0.012, 0.02, z + tall - 0.012))
    )
    return fitted("television", parts)


def kitchen(rng: np.random.Generator) -> Prop:
    """A row of cupboards under a worktop with sink and hob, cupboards above, a fridge at one end."""
    units = int(rng.integers(3, 6))
    x, y = 0.6 * units / 2, 0.3
    end = x + 0.62
    parts = [
        box_part("white", (-x, -y + 0.02, 0.1, x, y, 0.87), (-x, y - 0.34, 1.42, x, y, 2.1)),
        box_part(
            "dark", (-x, -y + 0.07, 0.0, x, y, 0.1), (-x + 0.7, -y + 0.08, 0.905, -x + 1.25, y - 0.1, 0.912)
        ),
        box_part("wood", (-x, -y - 0.01, 0.87, x, y, 0.905)),
    ]
    parts += _fronts("white", -x, x, 0.12, 0.86, -y + 0.02, units)
    parts += _fronts("white", -x, x, 1.42, 2.1, y - 0.34, units)
    parts.append(
        box_part(
            "metal",
            (x, -y, 0.04, end, y, 1.85),
            (x + 0.01, -y - 0.02, 0.05, end - 0.01, -y, 1.2),
            (x + 0.01, -y - 0.02, 1.22, end - 0.01, -y, 1.84),
        )
    )
    parts.append(
        box_part(
            "dark",
            (x + 0.05, -y - 0.045, 0.8, x + 0.07, -y - 0.02, 1.15),
            (x + 0.05, -y - 0.045, 1.27, x + 0.07, -y - 0.02, 1.6),
        )
    )
    tap = x - 0.5
    parts += [
        Part(rod((tap, y - 0.1, 0.9), (tap, y - 0.1, 1.17), 0.012), "metal"),
        Part(rod((tap, y - 0.1, 1.165), (tap, y - 0.3, 1.165), 0.01), "metal"),
    ]
    parts += [
        Part(moved(part.solid, (0.2, 0.1, 0.0)), part.finish, part.smooth)
        for part in some_things(rng, 2 * x - 0.9, 0.3, 0.905, 2)
    ]
    return fitted("kitchen", parts)
