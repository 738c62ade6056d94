"""Stages under a roof: rooms as large as the motion needs."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from render_jobs import Environment
from whacamole.stage.floor import Floor
from whacamole.stage.props import HALL, LIVING_ROOM, WAREHOUSE, furnish, paint_finishes
from whacamole.stage.rooms import ceiling_lamps, room
from whacamole.stage.stage import SetBuilder, Stage

__all__ = ["living_room", "sports_hall", "warehouse"]

Paths = NDArray[np.float64]


def living_room(rng: np.random.Generator, paths: Paths, folder: Path | None) -> Stage:
    """A lived-in room with a wooden floor, furniture along the walls and warm lamps."""
    build, floor = SetBuilder(folder), Floor(paths)
    height = float(rng.uniform(2.9, 3.5))
    room(
        build, floor, margin=float(rng.uniform(4.2, 5.2)), height=height, rng=rng,
        floor_texture=("wood", float(rng.uniform(1.4, 2.2))),
        wall_texture=(str(rng.choice(["wallpaper", "plaster", "wallpaper"])), float(rng.uniform(1.2, 2.0))),
    )  # fmt: skip
    surfaces = {
        "wood": (("wood", 0.9), ("wood", 1.3), ("plaster", 1.0)),
        "cloth": (("cloth", 0.8), ("cloth", 0.5)),
    }
    finishes = paint_finishes(build, surfaces, rng)
    furnish(build, floor, LIVING_ROOM, int(rng.integers(8, 13)), finishes, rng, beyond=6.0, clearance=2.2)
    lamps = ceiling_lamps(floor, height, float(rng.uniform(70.0, 110.0)), (1.0, 0.93, 0.84), 3.2)
    return build.stage("living-room", lamps, Environment(color=(0.5, 0.5, 0.5), strength=0.15))


def sports_hall(rng: np.random.Generator, paths: Paths, folder: Path | None) -> Stage:
    """A hall with a marked wooden floor, benches and boxes, evenly lit."""
    build, floor = SetBuilder(folder), Floor(paths)
    height = float(rng.uniform(5.5, 7.0))
    room(
        build, floor, margin=float(rng.uniform(6.0, 9.0)), height=height, rng=rng,
        floor_texture=("wood", float(rng.uniform(2.0, 3.0))),
        wall_texture=(str(rng.choice(["brick", "concrete"])), float(rng.uniform(1.6, 2.6))),
    )  # fmt: skip
    surfaces = {"wood": (("wood", 1.0), ("concrete", 1.5)), "cloth": (("cloth", 0.9),)}
    furnish(build, floor, HALL, int(rng.integers(8, 13)), paint_finishes(build, surfaces, rng), rng)
    lamps = ceiling_lamps(floor, height, float(rng.uniform(260.0, 380.0)), (1.0, 0.98, 0.95), 5.0)
    return build.stage("sports-hall", lamps, Environment(color=(0.6, 0.65, 0.7), strength=0.15))


def warehouse(rng: np.random.Generator, paths: Paths, folder: Path | None) -> Stage:
    """A store with a concrete floor, stacked crates and barrels, cold and uneven light."""
    build, floor = SetBuilder(folder), Floor(paths)
    height = float(rng.uniform(4.5, 6.0))
    room(
        build, floor, margin=float(rng.uniform(5.5, 8.0)), height=height, rng=rng,
        floor_texture=("concrete", float(rng.uniform(2.5, 4.0))),
        wall_texture=(str(rng.choice(["brick", "concrete", "plaster"])), float(rng.uniform(1.8, 2.8))),
    )  # fmt: skip
    surfaces = {
        "wood": (("wood", 1.0), ("wood", 0.7)), "metal": (("plaster", 1.0),), "stone": (("concrete", 1.2),),
    }  # fmt: skip
    finishes = paint_finishes(build, surfaces, rng)
    furnish(build, floor, WAREHOUSE, int(rng.integers(12, 20)), finishes, rng, clearance=2.6)
    lamps = ceiling_lamps(floor, height, float(rng.uniform(240.0, 340.0)), (0.88, 0.94, 1.0), 6.0)
    return build.stage("warehouse", lamps, Environment(color=(0.4, 0.45, 0.5), strength=0.12))
