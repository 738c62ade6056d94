"""What stands on flat roofs."""

from typing import Final

import numpy as np

from whacamole.stage.props.prop import Part, Prop, PropMaker, drawn, fitted
from whacamole.stage.shapes import bevelled_box, box, boxes, cylinder, joined, lathe, moved, tilted, turned

__all__ = ["ROOF", "stair_house"]


def _air_conditioner(rng: np.random.Generator) -> Prop:
    """A casing on feet with a grille on its front and a fan behind a ring on top or in front."""
    width, depth, height = drawn(rng, (0.9, 1.6), (0.6, 0.9), (0.7, 1.2))
    casing = moved(bevelled_box((width, depth, height), 0.015), (0.0, 0.0, 0.12))
    feet = joined([box((x, 0.0, 0.0), (0.08, depth, 0.12)) for x in (-width / 2 + 0.15, width / 2 - 0.15)])
    z = np.arange(0.2, height + 0.02, 0.05)
    x0, x1 = (-width / 2 + 0.06, width / 2 - 0.06)
    slats = boxes(
        np.column_stack([0 * z + x0, 0 * z - depth / 2 - 0.015, z]),
        np.column_stack([0 * z + x1, 0 * z - depth / 2 + 0.005, z + 0.022]),
    )
    radius = 0.42 * min(width, depth)
    ring = moved(
        lathe([(radius + 0.03, 0.0), (radius + 0.03, 0.06), (radius, 0.06), (radius, 0.01)], 20),
        (0.0, 0.0, height + 0.12),
    )
    blades = [
        box((0.0, 0.0, height + 0.14), (2 * radius - 0.02, 0.11, 0.015), turn)
        for turn in np.pi / 3 * np.arange(3)
    ]
    parts = [Part(joined([casing]), "casing"), Part(joined([feet, slats, ring, *blades]), "metal")]
    return fitted("air-conditioner", parts)


def _vent(rng: np.random.Generator) -> Prop:
    """A pipe or several with a hood."""
    parts = []
    for index in range(int(rng.integers(1, 4))):
        radius, height = drawn(rng, (0.08, 0.2), (0.5, 1.3))
        pipe = [
            cylinder((0.55 * index, 0.0, 0.0), radius, height, 14),
            lathe([(2 * radius, 0.0), (1.2 * radius, 0.06)], 14),
        ]
        hood = moved(
            lathe([(1.8 * radius, 0.0), (1.8 * radius, 0.03), (0.2 * radius, 0.6 * radius)], 14),
            (0.55 * index, 0.0, height + 0.05),
        )
        stay = box((0.55 * index, 0.0, height), (0.03, 0.03, 0.06))
        parts += [pipe[0], moved(pipe[1], (0.55 * index, 0.0, 0.0)), hood, stay]
    return fitted("vent", [Part(joined(parts), "steel")])


def _roof_light(rng: np.random.Generator) -> Prop:
    """A pitched roof of glass on a kerb, with bars."""
    length, width, rise = drawn(rng, (1.2, 2.6), (0.9, 1.3), (0.25, 0.4))
    kerb = box((0.0, 0.0, 0.0), (length, width, 0.3))
    half = width / 2 - 0.04
    slope, pitch = float(np.hypot(half, rise)), float(np.arctan2(rise, half))
    x = np.linspace(-length / 2 + 0.05, length / 2 - 0.05, max(3, round(length / 0.5)))
    glass, bars = [], [box((0.0, 0.0, 0.28 + rise), (length - 0.06, 0.1, 0.04))]
    for turn in (0.0, np.pi):
        lean = ((pitch, 0.0, 0.0), (0.0, -half, 0.3))
        sheet = boxes((0.05 - length / 2, -half, 0.29), (length / 2 - 0.05, slope - half, 0.3))
        rows = boxes(
            np.column_stack([x - 0.02, 0 * x - half, 0 * x + 0.29]),
            np.column_stack([x + 0.02, 0 * x + slope - half, 0 * x + 0.325]),
        )
        glass.append(turned(tilted(sheet, *lean), (0.0, 0.0, 0.0), turn))
        bars.append(turned(tilted(rows, *lean), (0.0, 0.0, 0.0), turn))
    return fitted(
        "roof-light", [Part(kerb, "felt"), Part(joined(glass), "glass"), Part(joined(bars), "metal")]
    )


def _pipes(rng: np.random.Generator) -> Prop:
    """Two or three pipes side by side on blocks, with a valve box."""
    length, count = drawn(rng, (2.0, 4.0))[0], int(rng.integers(2, 4))
    tubes = []
    for index in range(count):
        radius = float(rng.uniform(0.05, 0.09))
        tube = tilted(lathe([(radius, 0.0), (radius, length)], 12), (0.0, np.pi / 2, 0.0))
        tubes.append(moved(tube, (-length / 2, 0.25 * index, 0.2)))
    spots = np.linspace(-length / 2 + 0.2, length / 2 - 0.2, max(2, round(length / 1.2)))
    width = 0.25 * (count - 1)
    blocks = [box((float(x), width / 2, 0.0), (0.15, width + 0.24, 0.13)) for x in spots]
    valve = box((0.3, width / 2, 0.1), (0.4, width + 0.26, 0.42))
    return fitted(
        "pipes", [Part(joined(tubes), "steel"), Part(joined(blocks), "stone"), Part(valve, "casing")]
    )


def _aerial(rng: np.random.Generator) -> Prop:
    """A mast with the rods of an aerial and a foot."""
    height, long = drawn(rng, (2.2, 3.2), (0.9, 1.3))
    mast = cylinder((0.0, 0.0, 0.0), 0.025, height, 8)
    boom = box((0.0, 0.0, height - 0.15), (long, 0.025, 0.025))
    rods = [
        box((float(x), 0.0, height - 0.13), (0.012, float(w), 0.012))
        for x, w in zip(
            np.linspace(-long / 2 + 0.05, long / 2 - 0.05, 7), np.linspace(0.7, 0.35, 7), strict=True
        )
    ]
    foot = bevelled_box((0.5, 0.5, 0.12), 0.02)
    return fitted("aerial", [Part(joined([mast, boom, *rods]), "steel"), Part(foot, "stone")])


def _tank(rng: np.random.Generator) -> Prop:
    """A round tank of staves or sheet on a frame of legs."""
    radius, height = drawn(rng, (0.7, 1.0), (1.2, 1.6))
    body = moved(lathe([(radius, 0.0), (radius, height)], 24), (0.0, 0.0, 0.7))
    roof = moved(lathe([(radius + 0.06, 0.0), (0.05, 0.35)], 24), (0.0, 0.0, 0.7 + height))
    hoops = [
        moved(
            lathe(
                [(radius + 0.005, 0.0), (radius + 0.02, 0.0), (radius + 0.02, 0.05), (radius + 0.005, 0.05)],
                24,
            ),
            (0.0, 0.0, z),
        )
        for z in 0.7 + height * np.array([0.1, 0.4, 0.7, 0.93])
    ]
    at = 0.6 * radius
    legs = [box((x, y, 0.0), (0.1, 0.1, 0.62)) for x in (-at, at) for y in (-at, at)]
    deck = box((0.0, 0.0, 0.6), (1.7 * radius, 1.7 * radius, 0.1))
    return fitted("tank", [Part(body, "planks"), Part(joined([roof, *hoops, *legs, deck]), "metal")])


def stair_house(rng: np.random.Generator) -> Prop:
    """The head of the stairs: walls under a slab, a steel door with a frame and a lamp over it, a pipe."""
    width, depth, height = drawn(rng, (2.6, 3.6), (2.4, 3.2), (2.5, 2.8))
    wall = box((0.0, 0.0, 0.0), (width, depth, height))
    slab = moved(bevelled_box((width + 0.3, depth + 0.3, 0.16), 0.02), (0.0, 0.0, height))
    x, front = float(rng.uniform(-0.4, 0.4)), -depth / 2
    frame = boxes(
        [(x - 0.52, front - 0.04, 0.0), (x + 0.45, front - 0.04, 0.0), (x - 0.52, front - 0.04, 2.06)],
        [(x - 0.45, front, 2.13), (x + 0.52, front, 2.13), (x + 0.52, front, 2.13)],
    )
    door = box((x, front - 0.01, 0.02), (0.9, 0.03, 2.04))
    fittings = [
        box((x + 0.36, front - 0.05, 1.0), (0.03, 0.06, 0.14)),
        frame,
        cylinder((width / 2 - 0.15, front - 0.05, 0.0), 0.04, height, 8),
        box((x, front - 0.1, 2.25), (0.24, 0.2, 0.1)),
    ]
    finish = str(rng.choice(["brick", "stone", "render"]))
    return fitted(
        "stair-house",
        [Part(wall, finish), Part(slab, "stone"), Part(door, "paint"), Part(joined(fittings), "metal")],
    )


ROOF: Final[tuple[PropMaker, ...]] = (
    _air_conditioner,
    _air_conditioner,
    _air_conditioner,
    _vent,
    _vent,
    _roof_light,
    _pipes,
    _aerial,
    _tank,
)
