"""Parks: a meadow with what grows and stands on it."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from whacamole.stage.floor import CLEARANCE, Floor
from whacamole.stage.garden import lay_out_garden
from whacamole.stage.horizon import horizon
from whacamole.stage.props import block, furnish, paint_finishes, plant_trees
from whacamole.stage.stage import SetBuilder, Stage
from whacamole.stage.surroundings import daylight, ground

__all__ = ["park"]


def park(rng: np.random.Generator, paths: NDArray[np.float64], folder: Path | None) -> Stage:
    """A meadow with trees near and far, a gravel path, hedges, flower beds, benches and fences."""
    build, floor = SetBuilder(folder), Floor(paths)
    ground(build, floor, "grass", float(rng.uniform(3.0, 4.5)), rng)
    lay_out_garden(build, floor, rng)
    walls = (block("wall", "stone", (1.5, 3.0), (0.2, 0.3), (0.9, 1.8)),)
    stone = paint_finishes(build, {"stone": (("concrete", 1.5), ("brick", 1.6), ("plaster", 2.0))}, rng)
    furnish(build, floor, walls, int(rng.integers(2, 5)), stone, rng)
    rings = ((int(rng.integers(6, 10)), CLEARANCE + 1.0, 14.0), (int(rng.integers(10, 16)), 14.0, 30.0))
    sun, sky = daylight(rng, (25.0, 65.0))
    plant_trees(build, floor, rings, sun, rng)
    horizon(build, floor, "country", rng)
    return build.stage("park", (sun,), sky, exposure=0.7)
