"""What stands on a market."""

from itertools import pairwise
from typing import Final

import numpy as np

from whacamole.stage.props.prop import Part, Prop, PropMaker, drawn, fitted
from whacamole.stage.shapes import Solid, box, boxes, cylinder, joined, lathe, moved

__all__ = ["MARKET"]

TABLE = 0.82
"""Height of a stall's table [m]."""

FRUITS = ("fruit-red", "fruit-orange", "fruit-green", "fruit-yellow", "fruit-purple")


def _stall(rng: np.random.Generator) -> Prop:
    """A table with a cloth to the ground and crates of fruit, four posts, a roof of cloth."""
    width, depth, eaves = drawn(rng, (2.0, 3.0), (1.1, 1.4), (2.1, 2.3))
    x, y = width / 2 - 0.03, depth / 2 - 0.03
    posts = joined(
        [box((side * x, end * y, 0.0), (0.05, 0.05, eaves)) for side in (-1, 1) for end in (-1, 1)]
    )
    table = box((0.0, -0.1, TABLE - 0.03), (width - 0.12, depth - 0.3, 0.03))
    skirt = box((0.0, 0.05 - depth / 2, 0.05), (width - 0.12, 0.02, TABLE - 0.05))
    cloth = str(rng.choice(["awning-0", "awning-1"]))
    parts = [
        Part(posts, "planks"),
        Part(table, "planks"),
        Part(skirt, cloth),
        Part(_canopy(width, depth, eaves), cloth),
    ]
    kinds = rng.permutation(FRUITS)[:2].tolist()
    along = np.arange(-x + 0.33, x - 0.2, 0.5)
    for place in along[:5]:
        fruit = kinds[int(rng.integers(2))]
        for row in (-0.28, 0.12):
            at = (float(place), row, TABLE)
            parts += [Part(moved(_tray(), at), "planks"), Part(moved(_heap(rng), at), fruit)]
    return fitted("stall", parts)


def _canopy(width: float, depth: float, eaves: float) -> Solid:
    """Two slopes of cloth with a strip that hangs down in front."""
    x, y, rise = width / 2 + 0.15, depth / 2 + 0.25, 0.4
    section = [(-y, eaves - 0.2), (-y, eaves), (0.0, eaves + rise), (y, eaves), (y, eaves - 0.2)]
    vertices = np.array([(end, a, b) for a, b in section for end in (-x, x)])
    first = 2 * np.arange(4)[:, None]
    faces = (first + np.array([[0, 1, 3, 2]])).astype(np.int32)
    down = np.concatenate([[0.0], np.linalg.norm(np.diff(np.array(section), axis=0), axis=1).cumsum()])
    uv = np.array([[(0, a), (2 * x, a), (2 * x, b), (0, b)] for a, b in pairwise(down)])
    return Solid(vertices.astype(np.float32), faces, uv.astype(np.float32))


def _tray(width: float = 0.46, depth: float = 0.36, height: float = 0.12) -> Solid:
    """An open crate of boards."""
    x, y = width / 2, depth / 2
    low = [(-x, -y, 0.0), (-x, -y, 0.02), (-x, y - 0.012, 0.02), (-x, -y, 0.02), (x - 0.012, -y, 0.02)]
    high = [(x, y, 0.012), (x, 0.012 - y, height), (x, y, height), (0.012 - x, y, height), (x, y, height)]
    return boxes(low, high)


def _heap(rng: np.random.Generator) -> Solid:
    """Fruit in two layers, as much as a tray holds."""
    radius = float(rng.uniform(0.036, 0.05))
    ball = lathe(
        [
            (0.5 * radius, 0.1 * radius),
            (radius, 0.9 * radius),
            (0.72 * radius, 1.6 * radius),
            (0.2 * radius, 1.95 * radius),
        ],
        6,
    )
    found = []
    for layer, inset in enumerate((0.06, 0.11)):
        for x in np.arange(-0.23 + inset, 0.24 - inset, 2.05 * radius):
            for y in np.arange(-0.18 + inset, 0.19 - inset, 2.05 * radius):
                jitter = rng.uniform(-0.006, 0.006, 2)
                found.append(moved(ball, (x + jitter[0], y + jitter[1], 0.03 + layer * 1.3 * radius)))
    return joined(found)


def _crates(rng: np.random.Generator) -> Prop:
    """Stacked crates of boards with gaps, the uppermost open."""
    count, (width, depth) = int(rng.integers(1, 5)), drawn(rng, (0.5, 0.7), (0.35, 0.45))
    one = _crate(width, depth, 0.3)
    slip = rng.uniform(-0.02, 0.02, (count, 2))
    stack = [moved(one, (float(x), float(y), 0.31 * level)) for level, (x, y) in enumerate(slip)]
    parts = [Part(joined(stack), "planks")]
    if rng.random() < 0.6:
        top = (0.0, 0.0, 0.31 * count - 0.14)
        parts.append(Part(moved(_heap(rng), top), FRUITS[int(rng.integers(len(FRUITS)))]))
    return fitted("crates", parts)


def _crate(width: float, depth: float, height: float) -> Solid:
    """Three boards a side on corner posts, and a floor."""
    x, y, thick = width / 2, depth / 2, 0.014
    low, high = [(-x, -y, 0.0)], [(x, y, thick)]
    for z in np.linspace(0.02, height - 0.08, 3):
        low += [(-x, -y, z), (-x, y - thick, z), (-x, -y, z), (x - thick, -y, z)]
        high += [(x, thick - y, z + 0.08), (x, y, z + 0.08), (thick - x, y, z + 0.08), (x, y, z + 0.08)]
    for a in (-x + thick, x - 0.04 - thick):
        for b in (-y + thick, y - 0.04 - thick):
            low.append((a, b, 0.0))
            high.append((a + 0.04, b + 0.04, height))
    return boxes(low, high)


def _barrel(rng: np.random.Generator) -> Prop:
    """Staves that bulge, held by four hoops."""
    radius, height = drawn(rng, (0.26, 0.33), (0.8, 0.95))

    def bulge(z: float) -> float:
        return radius * (1.0 - 0.16 * (2.0 * z / height - 1.0) ** 2)

    levels = np.linspace(0.0, height, 9)
    staves = lathe(
        [(bulge(float(z)), float(z)) for z in levels]
        + [(0.9 * bulge(0.0), height), (0.9 * bulge(0.0), height - 0.03)],
        20,
    )
    hoops = [
        lathe(
            [
                (bulge(z) + 0.004, z),
                (bulge(z) + 0.008, z),
                (bulge(z + 0.04) + 0.008, z + 0.04),
                (bulge(z + 0.04) + 0.004, z + 0.04),
            ],
            20,
        )
        for z in (0.06, 0.26 * height, 0.70 * height, height - 0.1)
    ]
    return fitted("barrel", [Part(staves, "planks"), Part(joined(hoops), "metal")])


def _parasol(rng: np.random.Generator) -> Prop:
    """A sunshade over a round table with stools."""
    radius, height = drawn(rng, (1.1, 1.4), (2.5, 2.7))
    pole = joined(
        [cylinder((0.0, 0.0, 0.0), 0.025, height, 8), lathe([(0.28, 0.0), (0.28, 0.06), (0.05, 0.1)], 14)]
    )
    shade = moved(lathe([(radius, 0.0), (0.97 * radius, 0.06), (0.05, 0.5)], 10), (0.0, 0.0, height - 0.5))
    table = joined([cylinder((0.0, 0.0, 0.71), 0.4, 0.03, 20), cylinder((0.0, 0.0, 0.0), 0.04, 0.71, 8)])
    stools = []
    for turn in 2 * np.pi * (np.arange(3) + rng.uniform()) / 3:
        x, y = 0.75 * np.cos(turn), 0.75 * np.sin(turn)
        stools += [
            cylinder((x, y, 0.43), 0.18, 0.03, 14),
            *(
                cylinder((x + a, y + b, 0.0), 0.015, 0.43, 6)
                for a, b in ((0.11, 0.11), (-0.11, 0.11), (0.11, -0.11), (-0.11, -0.11))
            ),
        ]
    cloth = str(rng.choice(["awning-0", "awning-1"]))
    return fitted(
        "parasol", [Part(pole, "steel"), Part(shade, cloth), Part(joined([table, *stools]), "planks")]
    )


def _baskets(rng: np.random.Generator) -> Prop:
    """Two or three baskets, heaped."""
    parts = []
    fruit = FRUITS[int(rng.integers(len(FRUITS)))]
    for index in range(int(rng.integers(2, 4))):
        at = (0.55 * index, float(rng.uniform(-0.08, 0.08)), 0.0)
        basket = lathe([(0.2, 0.0), (0.25, 0.25), (0.27, 0.28), (0.24, 0.28), (0.22, 0.2)], 16)
        parts += [Part(moved(basket, at), "wicker"), Part(moved(_heap(rng), (at[0], at[1], 0.18)), fruit)]
    return fitted("baskets", parts)


MARKET: Final[tuple[PropMaker, ...]] = (
    _stall,
    _stall,
    _stall,
    _stall,
    _crates,
    _crates,
    _barrel,
    _parasol,
    _baskets,
)
