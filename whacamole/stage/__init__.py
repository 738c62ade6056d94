"""Places to film in: geometry, light, and what a camera or a person may not enter."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from whacamole.stage.light import DAY, Hdri, lit_by
from whacamole.stage.living import living_room
from whacamole.stage.outdoors import courtyard, market, night_street, plaza, rooftop
from whacamole.stage.own import OwnStage
from whacamole.stage.parks import park
from whacamole.stage.places import Places, find_places
from whacamole.stage.sports import sports_hall
from whacamole.stage.stage import SetBuilder, Stage
from whacamole.stage.survey import Ground
from whacamole.stage.warehouses import warehouse

__all__ = [
    "DAY",
    "STAGES",
    "Ground",
    "Hdri",
    "OwnStage",
    "Places",
    "SetBuilder",
    "Stage",
    "find_places",
    "lit_by",
]

STAGES: dict[str, Callable[[np.random.Generator, NDArray[np.float64], Path | None], Stage]] = {
    "plaza": plaza,
    "park": park,
    "market": market,
    "courtyard": courtyard,
    "rooftop": rooftop,
    "night-street": night_street,
    "living-room": living_room,
    "sports-hall": sports_hall,
    "warehouse": warehouse,
}
"""Every stage by name: each draws itself from a generator around the people's paths (N, 2) [m]."""
