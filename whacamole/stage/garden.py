"""What a park has besides its trees: a gravel path, benches, clipped hedges, flower beds, fences."""

import numpy as np

from whacamole.stage.floor import Floor
from whacamole.stage.props import Finishes, Part, Prop, block, furnish
from whacamole.stage.shapes import box, strip
from whacamole.stage.stage import SetBuilder
from whacamole.stage.textures import TEXTURES

__all__ = ["lay_out_garden"]

WALKWAY = (1.6, 2.6)
"""Width of the gravel path [m]."""

ASIDE = (1.2, 3.0)
"""From the people's paths to the edge of the gravel [m]."""

WALKWAY_HEIGHT = 0.01
"""Of the gravel over the grass [m]; nobody treads on it."""

BENCH = (1.5, 0.5, 0.85)
HEDGE = ((2.5, 6.0), (0.6, 1.0), (0.6, 1.3))
BED = ((1.4, 3.0), (1.0, 1.8), (0.1, 0.22))
FENCE_LENGTH = (4.0, 9.0)
"""Sizes of what stands there: width, depth and height [m]."""


def lay_out_garden(build: SetBuilder, floor: Floor, rng: np.random.Generator) -> None:
    """Lay a path beside the people and stand the furniture of a park around them."""
    _walkway(build, floor, rng)
    finishes: Finishes = {
        "hedge": (build.material("hedge", TEXTURES["leaves"], rng, metres=1.0, roughness=0.9),),
        "blossom": (build.material("blossom", TEXTURES["flowers"], rng, metres=1.5, roughness=0.9),),
        "planks": (build.material("planks", TEXTURES["wood"], rng, metres=0.5),),
    }
    furnish(
        build, floor, (block("hedge", "hedge", *HEDGE),), int(rng.integers(4, 8)), finishes, rng, beyond=11.0
    )
    beds = (block("flower-bed", "blossom", *BED),)
    furnish(build, floor, beds, int(rng.integers(4, 8)), finishes, rng, beyond=6.0)
    furnish(build, floor, (_bench,), int(rng.integers(2, 5)), finishes, rng, beyond=6.0)
    furnish(build, floor, (_fence,), int(rng.integers(2, 5)), finishes, rng, beyond=13.0)


def _walkway(build: SetBuilder, floor: Floor, rng: np.random.Generator) -> None:
    """A straight path of gravel past the people, kept free of everything that stands."""
    gravel = build.material("gravel", TEXTURES["gravel"], rng, metres=2.2)
    angle, width = float(rng.uniform(0.0, 2.0 * np.pi)), float(rng.uniform(*WALKWAY))
    normal = np.array([np.cos(angle), np.sin(angle)])
    along = np.array([-normal[1], normal[0]])
    offset = float((floor.paths @ normal).max() + rng.uniform(*ASIDE) + width / 2.0)
    reach = floor.reach + 40.0
    build.add("walkway", strip(normal * offset, along, 2.0 * reach, width, WALKWAY_HEIGHT), gravel)
    for step in np.arange(-reach, reach, width):
        floor.reserve(normal * offset + step * along, width / 2.0)


def _bench(rng: np.random.Generator) -> Prop:
    """A seat and a back of planks on two ends."""
    width, depth, height = BENCH
    aside, rear = width / 2 - 0.03, depth / 2 - 0.0125
    ends = [box((side * aside, 0.0, 0.0), (0.06, depth, 0.41)) for side in (-1.0, 1.0)]
    posts = [box((side * aside, rear, 0.45), (0.06, 0.025, height - 0.45)) for side in (-1.0, 1.0)]
    seat = box((0.0, 0.0, 0.41), (width, depth, 0.04))
    backs = [box((0.0, rear, z), (width, 0.025, 0.1)) for z in (0.58, height - 0.1)]
    return Prop("bench", BENCH, tuple(Part(solid, "planks") for solid in (*ends, *posts, seat, *backs)))


def _fence(rng: np.random.Generator) -> Prop:
    """Posts a metre and a half apart with three rails."""
    length, depth, height = float(rng.uniform(*FENCE_LENGTH)), 0.06, 1.0
    spots = np.linspace(-length / 2 + 0.04, length / 2 - 0.04, max(2, round(length / 1.5)))
    posts = [box((float(x), 0.0, 0.0), (0.08, depth, height)) for x in spots]
    rails = [box((0.0, 0.0, z), (length, 0.03, 0.1)) for z in (0.2, 0.5, 0.8)]
    return Prop("fence", (length, depth, height), tuple(Part(solid, "planks") for solid in (*posts, *rails)))
