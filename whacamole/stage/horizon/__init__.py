"""What closes the view where a stage ends: a town, woods, hills, or the roofs below a roof.

All of it lies beyond everything people and cameras get to, so nothing of it is an obstacle; and so low that
no sun a stage draws throws its shadow on the people.
"""

from typing import Literal

import numpy as np

from whacamole.stage.floor import Floor
from whacamole.stage.horizon.land import hills, tree_line
from whacamole.stage.horizon.town import lit_windows, roofs, town
from whacamole.stage.stage import SetBuilder

__all__ = ["Prospect", "horizon"]

Prospect = Literal["town", "night-town", "country", "roofs"]
"""Kinds of view."""


def horizon(build: SetBuilder, floor: Floor, prospect: Prospect, rng: np.random.Generator) -> None:
    """Close the view all around."""
    center = (floor.low + floor.high) / 2.0
    reach = float(np.hypot(*(floor.high - floor.low)) / 2.0)
    behind = float(rng.random())
    if prospect == "roofs":
        roofs(build, center, reach, rng)
        if behind < 0.5:
            hills(build, center, reach + 230.0, rng)
    elif prospect == "country":
        tree_line(build, center, reach, rng)
        if behind < 0.4:
            town(build, center, reach + 60.0, rng)
        elif behind < 0.8:
            hills(build, center, reach + 150.0, rng)
    else:
        houses = town(build, center, reach, rng)
        if prospect == "night-town":
            lit_windows(build, houses, rng)
        elif behind < 0.5:
            hills(build, center, reach + 170.0, rng)
