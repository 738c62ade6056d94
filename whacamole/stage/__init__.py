"""Places to film in: geometry, light, and what a camera or a person may not enter."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from whacamole.stage.indoors import living_room, sports_hall, warehouse
from whacamole.stage.outdoors import courtyard, market, night_street, park, plaza, rooftop
from whacamole.stage.stage import SetBuilder, Stage

__all__ = ["STAGES", "SetBuilder", "Stage", "stage_rand"]

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


def stage_rand(
    rng: np.random.Generator, paths: NDArray[np.float64], folder: Path | None, names: tuple[str, ...] = ()
) -> Stage:
    """Draw one of the stages ``names`` (none: any of them) around ``paths``.

    Args:
        paths: (N, 2) ground positions that people will have [m].
        folder: where textures are written; None paints none.
    """
    choice = names or tuple(STAGES)
    return STAGES[choice[int(rng.integers(len(choice)))]](rng, paths, folder)
