"""What encloses a stage under the sky: the ground, daylight, houses."""

import numpy as np
from numpy.typing import NDArray

from render_jobs import Environment, Material, Sun
from whacamole.stage.floor import Floor
from whacamole.stage.shapes import ground_grid
from whacamole.stage.stage import SetBuilder
from whacamole.stage.textures import TEXTURES

__all__ = ["FRONT_DISTANCE", "daylight", "ground", "house_fronts"]

FRONT_DISTANCE = (13.0, 21.0)
"""From the people's paths to a house front [m]: beyond the reach of a long shot's camera."""

FRONT_KINDS = 4
"""Different house fronts on one square."""

MOST_STOREYS = 4
"""Of a house."""

OUTWARD = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]])
"""Direction of each side."""

HORIZON = 260.0
"""How far the ground reaches beyond the people's paths [m]: under the foot of the farthest hills."""


def ground(
    build: SetBuilder,
    floor: Floor,
    texture: str,
    metres: float,
    rng: np.random.Generator,
    beyond: float = HORIZON,
) -> None:
    """Lay the ground, ``beyond`` metres farther than the people's paths reach.

    Args:
        texture, metres: name, and metres after which it repeats.
    """
    material = build.material("ground", TEXTURES[texture], rng, metres=metres)
    build.add("ground", ground_grid(floor.reach + beyond), material)


def daylight(rng: np.random.Generator, elevation: tuple[float, float]) -> tuple[Sun, Environment]:
    """Draw a sun between two elevations [degrees] and the sky that goes with it; a low sun is warmer."""
    height, azimuth = float(rng.uniform(*elevation)), float(rng.uniform(0.0, 360.0))
    up, around = np.radians(height), np.radians(azimuth)
    warmth = float(np.clip((40.0 - height) / 40.0, 0.0, 1.0))
    sun = Sun(
        direction=(-np.cos(up) * np.cos(around), -np.cos(up) * np.sin(around), -np.sin(up)),
        strength=float(rng.uniform(2.2, 3.6)),
        angle=1.0,
        color=(1.0, 0.97 - 0.07 * warmth, 0.92 - 0.2 * warmth),
    )
    sky = Environment(
        kind="sky", sun_elevation=height, rotation=azimuth, strength=float(rng.uniform(1.0, 1.5))
    )
    return sun, sky


def house_fronts(
    build: SetBuilder,
    floor: Floor,
    sides: NDArray[np.bool_],
    rng: np.random.Generator,
    sun: Sun | None = None,
) -> None:
    """Line the given sides (+x, +y, −x, −y) with houses of varied height.

    Towards the ``sun`` they stand farther off, so that their shadow ends before it reaches the people.
    """
    storeys = [float(rng.uniform(2.9, 3.4)) for _ in range(FRONT_KINDS)]
    fronts = [
        build.material(f"front-{index}", TEXTURES["facade"], rng, metres=storey, roughness=0.7)
        for index, storey in enumerate(storeys)
    ]
    shadow = np.zeros(2) if sun is None else -np.asarray(sun.direction[:2]) / -sun.direction[2] * max(storeys)
    for side in np.flatnonzero(sides):
        towards = shadow @ OUTWARD[side] * MOST_STOREYS
        _street_side(build, floor, int(side), max(0.0, float(towards)), storeys, fronts, rng)


def _street_side(
    build: SetBuilder,
    floor: Floor,
    side: int,
    farther: float,
    storeys: list[float],
    fronts: list[Material],
    rng: np.random.Generator,
) -> None:
    center, half = (floor.low + floor.high) / 2.0, (floor.high - floor.low) / 2.0
    axis, sign = side % 2, 1.0 if side < 2 else -1.0
    distance = half[axis] + rng.uniform(*FRONT_DISTANCE) + farther
    spread = 16.0 + 0.6 * farther
    along, stop = -half[1 - axis] - spread, half[1 - axis] + spread
    index = 0
    while along < stop:
        kind = int(rng.integers(FRONT_KINDS))
        width, depth = storeys[kind] * int(rng.integers(2, 5)), float(rng.uniform(7.0, 11.0))
        place = center.copy()
        place[axis] += sign * (distance + depth / 2.0)
        place[1 - axis] += along + width / 2.0
        footprint = (depth, width) if axis == 0 else (width, depth)
        height = storeys[kind] * int(rng.integers(2, MOST_STOREYS + 1))
        base = (float(place[0]), float(place[1]), 0.0)
        build.add_box(f"house-{side}-{index}", base, (*footprint, height), fronts[kind])
        along += width
        index += 1
