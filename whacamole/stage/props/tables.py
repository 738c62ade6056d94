"""Tables, and what lies on them."""

import numpy as np

from whacamole.stage.props.pieces import box_part, in_cells, legs
from whacamole.stage.props.prop import Part, Prop, drawn, fitted
from whacamole.stage.shapes import Solid, bevelled_box, boxes, lathe, moved, turned
from whacamole.stage.textures.interiors import CELLS

__all__ = ["coffee_table", "desk", "dining_table", "some_things", "vase"]

TABLE = 0.74
"""Height of a table [m]."""


def vase(rng: np.random.Generator, height: float) -> Solid:
    """Return a vase or a jug, its foot about the origin."""
    r = height * float(rng.uniform(0.2, 0.4))
    profile = [
        (0.55 * r, 0.0),
        (r, 0.35 * height),
        (0.8 * r, 0.6 * height),
        (0.35 * r, 0.85 * height),
        (0.45 * r, height),
    ]
    solid = lathe(profile, 16)
    return in_cells(solid, rng.integers(0, CELLS**2, 1), len(solid.faces))


def _pile_of_books(rng: np.random.Generator) -> Solid:
    count = int(rng.integers(2, 5))
    thick, w, d = (
        rng.uniform(0.015, 0.04, count),
        rng.uniform(0.15, 0.22, count),
        rng.uniform(0.2, 0.28, count),
    )
    z = np.concatenate([[0.0], thick.cumsum()])
    shift = rng.uniform(-0.01, 0.01, count)
    low = np.column_stack([-w / 2 + shift, -d / 2, z[:-1]])
    return in_cells(boxes(low, low + np.column_stack([w, d, thick])), rng.integers(0, CELLS**2, count), 6)


def some_things(rng: np.random.Generator, width: float, depth: float, z: float, count: int) -> list[Part]:
    """Return small things on a board: vases, bowls, piles of books."""
    parts = []
    for index in range(count):
        x = float((index + rng.uniform(0.3, 0.7)) / count - 0.5) * (width - 0.24)
        place = (x, float(rng.uniform(-0.12, 0.12)) * depth, z)
        kind = rng.random()
        if kind < 0.4:
            solid = vase(rng, float(rng.uniform(0.14, 0.32)))
        elif kind < 0.6:
            solid = lathe([(0.05, 0.0), (0.1, 0.03), (0.13, 0.07), (0.12, 0.07), (0.04, 0.02)], 20)
            solid = in_cells(solid, rng.integers(0, CELLS**2, 1), len(solid.faces))
        else:
            solid = turned(_pile_of_books(rng), (0.0, 0.0, 0.0), float(rng.uniform(-0.4, 0.4)))
        parts.append(Part(moved(solid, place), "things", smooth=kind < 0.4))
    return parts


def _apron(width: float, depth: float, bottom: float, top: float) -> Part:
    x, y = width / 2, depth / 2
    return box_part(
        "wood",
        (-x, -y, bottom, x, -y + 0.02, top),
        (-x, y - 0.02, bottom, x, y, top),
        (-x, -y, bottom, -x + 0.02, y, top),
        (x - 0.02, -y, bottom, x, y, top),
    )


def dining_table(rng: np.random.Generator) -> Prop:
    """A top on four legs and an apron, with a few things on it."""
    width, depth, leg = drawn(rng, (1.5, 2.1), (0.85, 0.95), (0.025, 0.035))
    parts = [Part(moved(bevelled_box((width, depth, 0.032), 0.006), (0.0, 0.0, TABLE - 0.032)), "wood")]
    parts += [Part(solid, "wood") for solid in legs(width - 0.08, depth - 0.08, TABLE - 0.03, leg, 0.02)]
    parts.append(_apron(width - 0.2, depth - 0.2, TABLE - 0.11, TABLE - 0.032))
    return fitted("table", parts + some_things(rng, 0.7 * width, depth, TABLE, int(rng.integers(1, 4))))


def coffee_table(rng: np.random.Generator) -> Prop:
    """A low top, a shelf below, books and a bowl."""
    width, depth, height = drawn(rng, (0.9, 1.2), (0.5, 0.65), (0.36, 0.44))
    parts = [Part(moved(bevelled_box((width, depth, 0.03), 0.006), (0.0, 0.0, height - 0.03)), "wood")]
    parts += [Part(solid, "wood") for solid in legs(width - 0.04, depth - 0.04, height - 0.02, 0.02, 0.015)]
    x, y = width / 2 - 0.06, depth / 2 - 0.06
    parts.append(box_part("wood", (-x, -y, 0.13, x, y, 0.15)))
    return fitted("table", parts + some_things(rng, width, depth, height, int(rng.integers(1, 4))))


def desk(rng: np.random.Generator) -> Prop:
    """A desk with drawers under one end, a screen and a keyboard."""
    width, depth = drawn(rng, (1.2, 1.6), (0.6, 0.75))
    x, y, top = width / 2, depth / 2, TABLE
    parts = [box_part("wood", (-x, -y, top - 0.03, x, y, top), (-x, -y, 0.0, -x + 0.03, y, top - 0.03))]
    parts.append(box_part("white", (x - 0.42, -y + 0.03, 0.0, x, y, top - 0.03)))
    drawers = [
        (x - 0.41, -y + 0.015, 0.03 + 0.225 * k, x - 0.01, -y + 0.03, 0.245 + 0.225 * k) for k in range(3)
    ]
    parts.append(box_part("white", *drawers))
    parts.append(
        box_part(
            "dark",
            *[(x - 0.27, -y, z + 0.17, x - 0.15, -y + 0.015, z + 0.18) for _, _, z, _, _, _ in drawers],
        )
    )
    parts.append(
        box_part(
            "dark",
            (-0.3, 0.08, top + 0.1, 0.3, 0.11, top + 0.46),
            (-0.03, 0.1, top, 0.03, 0.13, top + 0.2),
            (-0.12, 0.02, top, 0.12, 0.2, top + 0.01),
            (-0.22, -0.2, top, 0.22, -0.06, top + 0.02),
        )
    )
    return fitted("desk", parts)
