"""Which stage a take is set on, and where on it."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from whacamole.errors import TakeError
from whacamole.stage import STAGES, Ground, Hdri, OwnStage, Places, Stage, lit_by
from whacamole.stage.survey import CELL
from whacamole.take.crowd import Footprint, Placement

__all__ = ["Location", "choose_location", "free_spot"]

AIR = 0.1
"""Gap between a footprint and what cannot be walked on, at least [m]."""

ROOMY = 3.0
"""More room than this around people makes no place better [m]."""

_TURNS = 24
_GRID = 0.25
_LOOKED_AT = 60


@dataclass(frozen=True, eq=False)
class Location:
    """A stage and the place of the scene on it.

    Attributes:
        build: makes the stage around the people's paths (N, 2) [m]; textures go to the folder.
        ground: where one can walk; None where the stage is built around the people.
        spot: takes the scene, which lies about the origin, to its place on the ground.
    """

    build: Callable[[NDArray[np.float64], Path | None], Stage]
    ground: Ground | None = None
    spot: Placement | None = None

    def allows(self, footprint: Footprint) -> bool:
        """Whether somebody of the scene is on free ground all the time."""
        if self.ground is None or self.spot is None:
            return True
        return _holds(self.ground, footprint.moved(self.spot))


def choose_location(rng: np.random.Generator, places: Places, scene: list[Footprint]) -> Location:
    """Draw a stage; one of the user's own without room for the scene is passed over.

    Args:
        places: what to choose from; without names and files, all built-in stages.
        scene: the people whose places relative to each other are fixed.

    Raises:
        TakeError: no stage has room.
    """
    choices: tuple[str | Path, ...] = (*places.names, *places.files) or tuple(STAGES)
    first = int(rng.integers(len(choices)))
    for choice in (*choices[first:], *choices[:first]):
        if isinstance(choice, str):
            return Location(partial(_built, choice, rng, places.hdris))
        own = places.own(choice)
        spot = free_spot(own.ground, scene, rng)
        if spot is not None:
            return Location(partial(_own, own, rng, places.hdris), own.ground, spot)
    low = np.min([(person.center - person.radius[:, None]).min(axis=0) for person in scene], axis=0)
    high = np.max([(person.center + person.radius[:, None]).max(axis=0) for person in scene], axis=0)
    width, depth = high - low
    names = ", ".join(str(choice) for choice in choices)
    raise TakeError(
        f"needs {width:.1f} × {depth:.1f} m of free floor, which no stage has ({names}); "
        "take fewer --frames, or add a larger stage"
    )


def free_spot(ground: Ground, scene: list[Footprint], rng: np.random.Generator) -> Placement | None:
    """Draw a turn and a shift that put everybody on free ground in every frame, or None.

    Of the shifts that a turn allows, one with nearly the most room is taken: the camera needs some, too.
    """
    low = ground.low
    high = low + CELL * np.array(ground.clearance.shape)
    grid = np.stack(
        np.meshgrid(*(np.arange(a, b, _GRID) for a, b in zip(low, high, strict=True)), indexing="ij"), axis=-1
    ).reshape(-1, 2)
    grid = grid[ground.room(grid) > 0.0]
    for _ in range(_TURNS):
        yaw = float(rng.uniform(0.0, 2.0 * np.pi))
        turned = [person.moved(Placement(yaw, (0.0, 0.0))) for person in scene]
        middle = turned[0].center[len(turned[0].center) // 2]
        shifts = grid - middle
        margin = np.full(len(shifts), np.inf)
        for person in turned:
            step = max(len(person.center) // _LOOKED_AT, 1)
            for center, radius in zip(person.center[::step], person.radius[::step], strict=True):
                left = margin > AIR
                margin[left] = np.minimum(margin[left], ground.room(shifts[left] + center) - radius)
        margin = np.minimum(margin, ROOMY)
        good = np.flatnonzero((margin > AIR) & (margin >= 0.7 * margin.max(initial=0.0)))
        for index in rng.permutation(good)[:8]:
            spot = Placement(yaw, (float(shifts[index, 0]), float(shifts[index, 1])))
            if all(_holds(ground, person.moved(spot)) for person in scene):
                return spot
    return None


def _holds(ground: Ground, footprint: Footprint) -> bool:
    return bool((ground.room(footprint.center) > footprint.radius + AIR).all())


def _built(
    name: str,
    rng: np.random.Generator,
    hdris: tuple[Hdri, ...],
    paths: NDArray[np.float64],
    folder: Path | None,
) -> Stage:
    return lit_by(STAGES[name](rng, paths, folder), hdris, rng)


def _own(
    stage: OwnStage,
    rng: np.random.Generator,
    hdris: tuple[Hdri, ...],
    paths: NDArray[np.float64],
    folder: Path | None,
) -> Stage:
    return stage.stage(rng, paths, hdris)
