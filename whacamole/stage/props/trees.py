"""Trees: a trunk that blocks the way, branches and a crown above the heads that do not."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from render_jobs import Material, Sun
from whacamole.stage.floor import Floor
from whacamole.stage.props.growth import leafy, limb, scattered
from whacamole.stage.shapes import Solid, Vector, joined, moved
from whacamole.stage.stage import SetBuilder
from whacamole.stage.textures import TEXTURES
from whacamole.stage.textures.foliage import leaf_tones

__all__ = ["HEADROOM", "plant_trees"]

Floats = NDArray[np.float64]

HEADROOM = 2.65
"""No leaf or branch hangs lower [m]."""

TRUNK = 2.4
"""Of a trunk so much is in the way of people and cameras [m]; the rest is above their heads."""

FAR = 14.0
"""Trees planted from here on [m] have fewer, larger leaves."""

FACE_HEIGHT = 1.5
"""Where faces are [m]."""

IN_THE_SUN = 0.8
"""From the people's paths to the shadow of a crown [m]."""

_TRIES = 5
_SPARSE = 16

CLUMP_OF_FAR = 1.6
"""How much larger."""


@dataclass(frozen=True)
class Kind:
    """How a kind of tree grows.

    Attributes:
        crown: radius and half height of the crown, each a range [m].
        leaf: length and width of a leaf, or of a spray of small ones [m].
        leaves: of a near tree.
        boughs: fewest and most masses of leaves that make the crown.
        droop: of the leaves, 0 any way round to 1 down.
        taper: how much narrower the crown is at its top than at its foot.
        seasons: tones it may have.
    """

    crown: tuple[tuple[float, float], tuple[float, float]]
    leaf: tuple[float, float]
    leaves: int
    boughs: tuple[int, int]
    droop: float
    taper: float
    seasons: tuple[str, ...]


BROAD = ("summer", "summer", "spring", "autumn")
KINDS = (
    Kind(((1.9, 2.9), (1.5, 2.3)), (0.28, 0.165), 2300, (13, 20), 0.2, 0.25, BROAD),
    Kind(((1.6, 2.4), (1.9, 2.8)), (0.26, 0.155), 2200, (13, 20), 0.3, 0.4, BROAD),
    Kind(((0.8, 1.2), (2.8, 4.2)), (0.21, 0.14), 2000, (14, 20), 0.1, 0.5, BROAD),
    Kind(((1.5, 2.1), (2.4, 3.8)), (0.42, 0.11), 2100, (18, 26), 0.6, 0.9, ("conifer",)),
)
"""Round, high-crowned, poplar, conifer."""


def plant_trees(
    build: SetBuilder,
    floor: Floor,
    rings: Sequence[tuple[int, float, float]],
    sun: Sun,
    rng: np.random.Generator,
) -> None:
    """Plant trees of two or three kinds, where their crowns leave the people's faces in the sun.

    Args:
        rings: how many, from how near the paths, to how far outside their rectangle [m].
    """
    bark = build.material("bark", TEXTURES["bark"], rng, metres=0.8, roughness=0.95)
    kinds = [KINDS[index] for index in rng.choice(len(KINDS), int(rng.integers(2, 4)), replace=False)]
    crowns = [_tones(build, index, kind, rng) for index, kind in enumerate(kinds)]
    woods: list[Solid] = []
    foliage: list[list[Solid]] = [[] for _ in kinds]
    spans = [(nearest, beyond) for count, nearest, beyond in rings for _ in range(count)]
    for index, (nearest, beyond) in enumerate(spans):
        girth, which = float(rng.uniform(0.11, 0.2)), int(rng.integers(len(kinds)))
        trunk, branches, crown = _grown(kinds[which], girth, nearest >= FAR, rng)
        place = _sunny_spot(floor, crown, girth + 0.7, (nearest, beyond), sun, rng)
        if place is None:
            continue
        _stand(build, f"trunk-{index}", moved(trunk, place), bark)
        woods.append(moved(branches, place))
        foliage[which].append(moved(crown, place))
    # One mesh for all crowns of a kind: fewer, larger meshes cost a renderer less.
    if woods:
        build.add("branches", joined(woods), bark, smooth=True)
    for index, (tone, solids) in enumerate(zip(crowns, foliage, strict=True)):
        if solids:
            build.add(f"crowns-{index}", joined(solids), tone)


def _sunny_spot(
    floor: Floor,
    crown: Solid,
    footprint: float,
    span: tuple[float, float],
    sun: Sun,
    rng: np.random.Generator,
) -> Vector | None:
    """Draw a place from which the crown's shadow, at the height of faces, stays off the people's paths."""
    leaves = crown.vertices[::_SPARSE].astype(np.float64)
    fall = (leaves[:, 2:] - FACE_HEIGHT) / -sun.direction[2]
    shadow = leaves[:, :2] + fall * np.asarray(sun.direction[:2])
    people = cKDTree(floor.paths)
    for _ in range(_TRIES):
        place = floor.spot(rng, footprint, span[1], span[0])
        if place is None:
            return None
        if np.min(people.query(shadow + place)[0]) > IN_THE_SUN:
            return (*place, 0.0)
    return None


def _tones(build: SetBuilder, index: int, kind: Kind, rng: np.random.Generator) -> Material:
    season = str(rng.choice(kind.seasons))
    return build.material(
        f"crown-{index}", partial(leaf_tones, season=season), rng, metres=1.0, roughness=0.7
    )


def _stand(build: SetBuilder, name: str, trunk: Solid, bark: Material) -> None:
    """Put a trunk on the set, with the box around it to keep out of."""
    low, high = trunk.vertices.min(axis=0).astype(float), trunk.vertices.max(axis=0).astype(float)
    middle, size = (low + high) / 2.0, high - low
    build.add(name, trunk, bark, smooth=True)
    build.keep_out(name, (middle[0], middle[1], low[2]), (size[0], size[1], size[2]), 0.0)


def _grown(kind: Kind, girth: float, far: bool, rng: np.random.Generator) -> tuple[Solid, Solid, Solid]:
    """Grow a tree at the origin: its trunk up to ``TRUNK``, the rest of its wood, its leaves."""
    radius, half = float(rng.uniform(*kind.crown[0])), float(rng.uniform(*kind.crown[1]))
    middle = HEADROOM + 0.25 + half
    lean = rng.normal(0.0, 0.12, 2)
    height = np.array([0.0, 0.12, 0.4, 1.0, 1.7, TRUNK])
    stem = np.column_stack([np.outer((height / middle) ** 2, lean), height])
    flare = girth * np.array([1.7, 1.3, 1.08, 1.0, 0.95, 0.9])
    upper = np.linspace(TRUNK, middle + 0.6 * half, 5)
    spine = np.column_stack([np.outer((upper / middle) ** 2, lean), upper])
    spine[1:, :2] += rng.normal(0.0, 0.05, (4, 2))
    boughs, size = _boughs(kind, radius, half, rng)
    boughs += [*lean, middle]
    wood = [limb(spine, girth * np.linspace(0.9, 0.15, 5), 6)]
    wood += [_branch(spine, bough, 0.35 * girth, rng) for bough in boughs[:: 3 if far else 2]]
    scale = CLUMP_OF_FAR if far else 1.0
    count = int(kind.leaves / scale**2 / len(boughs))
    places, outward = scattered(boughs, size, count, rng)
    outward = outward / np.linalg.norm(outward, axis=1, keepdims=True)
    outward += 0.6 * (places - [*lean, middle]) / [radius, radius, half] + [0.0, 0.0, 0.25]
    length, width = scale * kind.leaf[0], scale * kind.leaf[1]
    places[:, 2] = np.maximum(places[:, 2], HEADROOM + 0.65 * length)
    return limb(stem, flare, 9), joined(wood), leafy(places, outward, (length, width), rng, kind.droop)


def _boughs(kind: Kind, radius: float, half: float, rng: np.random.Generator) -> tuple[Floats, Floats]:
    """Draw masses of leaves that fill a crown about the origin: middles and radii, (N, 3) each."""
    count = int(rng.integers(*kind.boughs))
    # Evenly over the height and around (golden angle), then shaken.
    level = np.linspace(-0.8, 0.85, count) + rng.normal(0.0, 0.06, count)
    level = np.clip(level, -0.85, 0.9)
    angle = np.arange(count) * 2.39996 + rng.normal(0.0, 0.3, count)
    round_off = np.sqrt(1.0 - level**2)
    cone = 0.62 * (1.0 - level) + 0.12
    reach = (1.0 - kind.taper) * round_off + kind.taper * cone
    away = radius * 0.68 * reach * rng.uniform(0.75, 1.05, count)
    middle = np.stack([away * np.cos(angle), away * np.sin(angle), half * level * 0.8], axis=1)
    size = radius * (0.26 + 0.22 * reach) * rng.uniform(0.85, 1.15, count)
    flat = 0.5 if kind.taper > 0.8 else 0.8
    return middle, np.stack([size, size, flat * size], axis=1)


def _branch(spine: Floats, bough: Floats, girth: float, rng: np.random.Generator) -> Solid:
    """A branch from the trunk up into a bough."""
    start_z = np.clip(bough[2] - 0.5 * np.hypot(bough[0], bough[1]), spine[0, 2] + 0.3, spine[-1, 2])
    start = np.array([*(np.interp(start_z, spine[:, 2], spine[:, axis]) for axis in (0, 1)), start_z])
    bend = (start + bough) / 2.0 + [0.0, 0.0, -0.08] + rng.normal(0.0, 0.04, 3)
    bough = np.array([bough[0], bough[1], max(bough[2], HEADROOM + 0.1)])
    bend[2] = max(bend[2], HEADROOM + 0.1)
    return limb(np.stack([start, bend, bough]), girth * np.array([1.0, 0.7, 0.3]), 5)
