"""What a park has besides its trees: a gravel path, grass in tufts, hedges, flower beds, benches, fences."""

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from whacamole.stage.floor import Floor
from whacamole.stage.props import Finishes, furnish
from whacamole.stage.props.growth import blades
from whacamole.stage.props.park_furniture import bench, bin_, fence, lamp_post
from whacamole.stage.props.plants import bush, flower_bed, hedge, plant_finishes
from whacamole.stage.shapes import box, joined, strip
from whacamole.stage.stage import SetBuilder
from whacamole.stage.textures import TEXTURES
from whacamole.stage.textures.foliage import leaf_tones

__all__ = ["lay_out_garden"]

WALKWAY = (1.6, 2.6)
"""Width of the gravel path [m]."""

ASIDE = (1.2, 3.0)
"""From the people's paths to the edge of the gravel [m]."""

WALKWAY_HEIGHT = 0.01
"""Of the gravel over the grass [m]; nobody treads on it."""

EDGING = (0.06, 0.05)
"""Width and height of the stones along the path [m]."""

TUFTS_A_SQUARE_METRE = 5.0
MOST_TUFTS = 3200
BLADES = 5
"""Of grass in a tuft."""

TUFTS_BEYOND = 8.0
"""How far outside the rectangle of the paths [m]; farther off they cannot be told from the painted grass."""

UNTRODDEN = 0.6
"""From the people's paths to the nearest tuft [m]."""


@dataclass(frozen=True, eq=False)
class Walkway:
    """A straight path: all places whose product with ``normal`` (2,) is ``offset`` ± ``width`` / 2 [m]."""

    normal: NDArray[np.float64]
    offset: float
    width: float


def lay_out_garden(build: SetBuilder, floor: Floor, rng: np.random.Generator) -> None:
    """Lay a path beside the people and stand the furniture of a park around them."""
    walkway = _walkway(build, floor, rng)
    _tufts(build, floor, walkway, rng)
    finishes: Finishes = {
        **plant_finishes(build, rng),
        "planks": (build.material("planks", TEXTURES["wood"], rng, metres=0.9),),
        "iron": (build.plain("iron", (0.15, 0.17, 0.16), roughness=0.5, metallic=0.4),),
        "lantern": (build.plain("lantern", (0.86, 0.86, 0.80), roughness=0.15),),
        "stone": (build.material("bed-stone", TEXTURES["concrete"], rng, metres=1.2),),
    }
    for makers, fewest, most, beyond in (
        ((hedge,), 4, 8, 11.0),
        ((flower_bed,), 4, 8, 6.0),
        ((bench,), 2, 5, 6.0),
        ((bush,), 5, 10, 9.0),
        ((lamp_post, bin_), 2, 5, 6.0),
        ((fence,), 2, 5, 13.0),
    ):
        furnish(build, floor, makers, int(rng.integers(fewest, most)), finishes, rng, beyond=beyond)


def _walkway(build: SetBuilder, floor: Floor, rng: np.random.Generator) -> Walkway:
    """A straight path of gravel past the people, edged with stone, kept free of everything that stands."""
    gravel = build.material("gravel", TEXTURES["gravel"], rng, metres=2.2)
    angle, width = float(rng.uniform(0.0, 2.0 * np.pi)), float(rng.uniform(*WALKWAY))
    normal = np.array([np.cos(angle), np.sin(angle)])
    along = np.array([-normal[1], normal[0]])
    offset = float((floor.paths @ normal).max() + rng.uniform(*ASIDE) + width / 2.0)
    reach = floor.reach + 40.0
    build.add("walkway", strip(normal * offset, along, 2.0 * reach, width, WALKWAY_HEIGHT), gravel)
    stones = []
    for side in (-1.0, 1.0):
        x, y = normal * (offset + side * (width + EDGING[0]) / 2.0)
        stones.append(box((float(x), float(y), 0.0), (EDGING[0], 2.0 * reach, EDGING[1]), angle))
    edging = build.material("edging", TEXTURES["concrete"], rng, metres=0.8)
    build.add("edging", joined(stones), edging)
    for step in np.arange(-reach, reach, width):
        floor.reserve(normal * offset + step * along, width / 2.0)
    return Walkway(normal, offset, width)


def _tufts(build: SetBuilder, floor: Floor, walkway: Walkway, rng: np.random.Generator) -> None:
    """Grow tufts of grass under 10 cm where nobody treads."""
    low, high = floor.low - TUFTS_BEYOND, floor.high + TUFTS_BEYOND
    count = min(MOST_TUFTS, int(TUFTS_A_SQUARE_METRE * np.prod(high - low)))
    place = rng.uniform(low, high, (count, 2))
    grown = cKDTree(floor.paths).query(place)[0] > UNTRODDEN
    grown &= np.abs(place @ walkway.normal - walkway.offset) > walkway.width / 2.0 + 0.15
    place = place[grown]
    size = rng.uniform(0.5, 1.0, len(place))
    base = np.repeat(place, BLADES, axis=0) + rng.normal(0.0, 0.018, (BLADES * len(place), 2))
    height = np.repeat(size, BLADES) * rng.uniform(0.04, 0.09, len(base))
    lean = rng.normal(0.0, 0.45, (len(base), 2)) * height[:, None]
    foot, tips = np.column_stack([base, 0.0 * height]), np.column_stack([base + lean, height])
    tones = build.material("tufts", partial(leaf_tones, season="grass"), rng, metres=1.0, roughness=0.8)
    build.add("tufts", blades(foot, tips, 0.009, rng), tones)
