"""Plants that others can use: potted, in beds, as bushes and hedges."""

from functools import partial

import numpy as np
from numpy.typing import NDArray

from whacamole.stage.props.growth import blades, leafy, limb, on_box, scattered
from whacamole.stage.props.prop import Finishes, Part, Prop, fitted
from whacamole.stage.shapes import Solid, bevelled_box, box, lathe, moved
from whacamole.stage.stage import SetBuilder
from whacamole.stage.textures.foliage import blossom_tones, leaf_tones

__all__ = ["bush", "flower_bed", "hedge", "plant_finishes", "potted", "shrub_in"]

UP = np.array([0.0, 0.0, 1.0])

HEDGE = ((2.5, 6.0), (0.6, 1.0), (0.6, 1.3))
BED = ((1.4, 3.0), (1.0, 1.8))
"""Width, depth and height [m]."""

EDGE = 0.07
"""Width of the stones around a bed [m]."""

LEAVES_A_SQUARE_METRE = 190.0
"""On a hedge."""

FLOWERS_A_SQUARE_METRE = 22.0
"""In a bed."""


def plant_finishes(build: SetBuilder, rng: np.random.Generator, season: str = "summer") -> Finishes:
    """Return what plants are made of: leaf, core (the dark inside), blossom, stem, earth, pot.

    Args:
        season: a key of :data:`whacamole.stage.textures.foliage.SEASONS`; "houseplant" indoors.
    """
    leaves = partial(leaf_tones, season=season)
    pots = ((0.58, 0.33, 0.23), (0.75, 0.73, 0.69), (0.25, 0.26, 0.28))
    return {
        "leaf": (build.material("plant-leaf", leaves, rng, metres=1.0, roughness=0.6),),
        "blossom": tuple(
            build.material(f"plant-blossom-{index}", blossom_tones, rng, metres=1.0) for index in range(2)
        ),
        "core": (build.plain("plant-core", (0.09, 0.13, 0.06), roughness=1.0),),
        "stem": (build.plain("plant-stem", (0.33, 0.26, 0.18), roughness=0.9),),
        "earth": (build.plain("plant-earth", (0.22, 0.17, 0.13), roughness=1.0),),
        "pot": tuple(build.plain(f"plant-pot-{index}", color) for index, color in enumerate(pots)),
    }


def potted(rng: np.random.Generator) -> Prop:
    """A plant in a pot: bushy, a small tree, or a sheaf of long leaves; 0.5 to 1.6 m high."""
    radius, height = float(rng.uniform(0.13, 0.2)), float(rng.uniform(0.24, 0.38))
    pot = lathe(
        [(0.72 * radius, 0.0), (radius, height), (0.93 * radius, height), (0.9 * radius, height - 0.03)], 18
    )
    soil = lathe([(0.88 * radius, height - 0.06), (0.86 * radius, height - 0.02)], 14)
    top = height - 0.02
    kind = int(rng.integers(3))
    if kind == 0:
        growth = shrub_in(rng, (0.0, 0.0, top), float(rng.uniform(0.2, 0.32)), float(rng.uniform(0.3, 0.6)))
    elif kind == 1:
        growth = _small_tree(rng, top)
    else:
        growth = [(_sheaf(rng, top, int(rng.integers(18, 34)), float(rng.uniform(0.5, 0.9))), "leaf")]
    return fitted("potted-plant", [Part(*piece) for piece in [(pot, "pot"), (soil, "earth"), *growth]])


def shrub_in(
    rng: np.random.Generator, base: tuple[float, float, float], radius: float, height: float
) -> list[tuple[Solid, str]]:
    """Return a bushy plant above ``base``: leaves around a few shoots, for pots and planters."""
    count = int(rng.integers(4, 7))
    away = radius * 0.55 * rng.uniform(0.2, 1.0, count)
    angle = rng.uniform(0.0, 2.0 * np.pi, count)
    level = height * rng.uniform(0.35, 0.72, count)
    middle = np.stack([away * np.cos(angle), away * np.sin(angle), level], axis=1)
    size = np.stack(
        [0.5 * radius + 0.0 * level, 0.5 * radius + 0.0 * level, 0.3 * height + 0.0 * level], axis=1
    )
    places, outward = scattered(middle, size, 60, rng)
    places[:, 2] = np.maximum(places[:, 2], 0.03)
    foliage = leafy(places, outward + 0.6 * UP, (0.3 * radius + 0.03, 0.16 * radius + 0.02), rng, 0.3)
    stems = [
        limb(np.array([[0.0, 0.0, 0.0], 0.5 * tip + [0, 0, 0.02], tip]), np.full(3, 0.006), 4)
        for tip in middle
    ]
    lowest = max(0.0, -float(foliage.vertices[:, 2].min()))
    at = (base[0], base[1], base[2] + lowest)
    return [(moved(foliage, at), "leaf"), *((moved(stem, base), "stem") for stem in stems)]


def bush(rng: np.random.Generator) -> Prop:
    """A shrub that stands in a garden: lumps of leaves down to the ground, sometimes in flower."""
    radius, height = float(rng.uniform(0.45, 0.85)), float(rng.uniform(0.7, 1.5))
    count = int(rng.integers(6, 10))
    angle = np.arange(count) * 2.4 + rng.normal(0.0, 0.3, count)
    away, level = radius * 0.5 * rng.uniform(0.3, 1.0, count), height * rng.uniform(0.3, 0.7, count)
    middle = np.stack([away * np.cos(angle), away * np.sin(angle), level], axis=1)
    size = np.column_stack([np.full((count, 2), 0.55 * radius), np.minimum(level, 0.35 * height)])
    places, outward = scattered(middle, size, 130, rng)
    places[:, 2] = np.maximum(places[:, 2], 0.05)
    parts = [(leafy(places, outward + 0.3 * UP, (0.13, 0.07), rng, 0.1), "leaf")]
    parts.append(
        (lathe([(0.3 * radius, 0.0), (0.6 * radius, 0.4 * height), (0.2 * radius, 0.75 * height)], 9), "core")
    )
    if rng.random() < 0.4:
        spots, up = scattered(middle, 1.04 * size, 12, rng)
        spots[:, 2] = np.maximum(spots[:, 2], 0.06)
        parts.append((leafy(spots, up, (0.08, 0.08), rng), "blossom"))
    return fitted("bush", [Part(*piece) for piece in parts])


def hedge(rng: np.random.Generator) -> Prop:
    """A clipped hedge: a dark inside under a coat of leaves with a ragged outline."""
    width, depth, height = (float(rng.uniform(*span)) for span in HEDGE)
    size = np.array([width, depth, height])
    core = bevelled_box((width - 0.08, depth - 0.08, height - 0.04), 0.05)
    places, outward = on_box(size, LEAVES_A_SQUARE_METRE, rng)
    places += rng.normal(0.0, 0.025, places.shape)
    places[:, 2] = np.maximum(places[:, 2], 0.06)
    return fitted(
        "hedge",
        [Part(*piece) for piece in [(core, "core"), (leafy(places, outward, (0.12, 0.065), rng), "leaf")]],
    )


def flower_bed(rng: np.random.Generator) -> Prop:
    """Earth within an edging of stone, and clumps of flowers in it."""
    width, depth = (float(rng.uniform(*span)) for span in BED)
    rim = float(rng.uniform(0.08, 0.14))
    earth = bevelled_box((width - EDGE, depth - EDGE, rim - 0.01), 0.02)
    sides = [box((0.0, sign * (depth - EDGE) / 2, 0.0), (width, EDGE, rim)) for sign in (-1.0, 1.0)]
    sides += [
        box((sign * (width - EDGE) / 2, 0.0, 0.0), (EDGE, depth - 2 * EDGE, rim)) for sign in (-1.0, 1.0)
    ]
    inner = np.array([width, depth]) / 2.0 - EDGE - 0.14
    count = int(FLOWERS_A_SQUARE_METRE * width * depth)
    spot = np.column_stack([rng.uniform(-inner, inner, (count, 2)), np.full(count, rim - 0.01)])
    foliage = _clumps(spot, rng)
    heads = np.repeat(spot, 3, axis=0) + np.column_stack(
        [rng.normal(0.0, 0.035, (3 * count, 2)).clip(-0.08, 0.08), rng.uniform(0.14, 0.3, 3 * count)]
    )
    upward = rng.normal(0.0, 0.4, heads.shape) + UP
    blossom = leafy(heads, upward, (0.075, 0.075), rng)
    parts = [(earth, "earth"), *((side, "stone") for side in sides), (foliage, "leaf"), (blossom, "blossom")]
    return fitted("flower-bed", [Part(*piece) for piece in parts])


def _clumps(spot: NDArray[np.float64], rng: np.random.Generator) -> Solid:
    """Leaves that rise from each spot (N, 3)."""
    base = np.repeat(spot, 9, axis=0)
    lean = rng.normal(0.0, 0.06, (len(base), 2)).clip(-0.12, 0.12)
    tips = base + np.column_stack([lean, rng.uniform(0.1, 0.24, len(base))])
    return blades(base, tips, 0.035, rng)


def _sheaf(rng: np.random.Generator, top: float, count: int, length: float) -> Solid:
    """Long leaves that rise from the pot and lean outwards."""
    angle, lean = rng.uniform(0.0, 2.0 * np.pi, count), rng.uniform(0.05, 0.5, count)
    direction = np.stack([lean * np.cos(angle), lean * np.sin(angle), 1.0 - 0.5 * lean], axis=1)
    base = np.column_stack([0.05 * direction[:, :2], np.full(count, top)])
    return blades(base, base + length * rng.uniform(0.6, 1.0, (count, 1)) * direction, 0.06, rng)


def _small_tree(rng: np.random.Generator, top: float) -> list[tuple[Solid, str]]:
    """A thin stem under a head of leaves."""
    height, radius = float(rng.uniform(0.5, 0.8)), float(rng.uniform(0.2, 0.32))
    bend = rng.normal(0.0, 0.03, (2, 2))
    path = np.array([[0.0, 0.0, top - 0.02], [*bend[0], top + 0.5 * height], [*bend[1], top + height]])
    middle = path[-1] + rng.normal(0.0, 0.35 * radius, (6, 3)) + [0.0, 0.0, 0.1]
    places, outward = scattered(middle, np.full((6, 3), 0.55 * radius), 70, rng)
    head = leafy(places, outward + 0.5 * UP, (0.1, 0.05), rng, 0.4)
    return [(limb(path, np.array([0.016, 0.013, 0.009]), 7), "stem"), (head, "leaf")]
