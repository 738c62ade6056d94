"""A town square by day: paved ground, house fronts, and street furniture that gives the camera parallax."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from render_jobs import Environment, Sun
from whacamole.stage.shapes import box, cylinder, ground_grid
from whacamole.stage.stage import SetBuilder, Stage
from whacamole.stage.textures import TEXTURES

__all__ = ["PlazaParameters", "plaza", "plaza_rand"]

CLEARANCE = 3.2
"""No furniture nearer than this to the people's paths [m]: arms swing, and the camera passes between."""

FURNITURE_REACH = 9.0
"""Furniture stands at most this far beyond the people's paths [m]; farther off it gives no parallax."""

FRONT_DISTANCE = (13.0, 21.0)
"""From the people's paths to a house front [m]: beyond the reach of a long shot's camera."""


@dataclass(frozen=True)
class PlazaParameters:
    """What makes one plaza differ from another.

    Attributes:
        ground: name of the ground texture.
        ground_tile: metres after which it repeats.
        furniture: number of props.
        fronts: which sides carry house fronts: +x, +y, −x, −y.
        sun_elevation, sun_azimuth: degrees; azimuth 0 is +x.
        sun_strength: W/m².
        sky_strength: factor on the sky's light.
    """

    ground: str
    ground_tile: float
    furniture: int
    fronts: tuple[bool, bool, bool, bool]
    sun_elevation: float
    sun_azimuth: float
    sun_strength: float
    sky_strength: float


def plaza_rand(rng: np.random.Generator, paths: NDArray[np.float64], folder: Path) -> Stage:
    """Draw a plaza around ``paths`` (N, 2), the ground positions people will have [m]."""
    fronts = rng.random(4) < 0.7
    fronts[int(rng.integers(4))] = True
    parameters = PlazaParameters(
        ground=str(rng.choice(["paving", "paving", "asphalt", "concrete", "grass", "brick"])),
        ground_tile=float(rng.uniform(2.4, 3.6)),
        furniture=int(rng.integers(9, 16)),
        fronts=(bool(fronts[0]), bool(fronts[1]), bool(fronts[2]), bool(fronts[3])),
        sun_elevation=float(rng.uniform(22.0, 62.0)),
        sun_azimuth=float(rng.uniform(0.0, 360.0)),
        sun_strength=float(rng.uniform(2.2, 3.6)),
        sky_strength=float(rng.uniform(0.8, 1.2)),
    )
    return plaza(parameters, paths, folder, rng)


def plaza(
    parameters: PlazaParameters, paths: NDArray[np.float64], folder: Path, rng: np.random.Generator
) -> Stage:
    """Build a plaza; ``rng`` decides only where the furniture stands and the grain of the textures."""
    build = SetBuilder(folder)
    low, high = paths.min(axis=0), paths.max(axis=0)
    ground = build.material("ground", TEXTURES[parameters.ground], rng, metres=parameters.ground_tile)
    reach = float(max(np.abs(low).max(), np.abs(high).max())) + FRONT_DISTANCE[1] + 40.0
    build.add("ground", ground_grid(reach), ground, blocks=False)
    _house_fronts(build, parameters, low, high, rng)
    _furniture(build, parameters.furniture, paths, rng)
    elevation, azimuth = np.radians(parameters.sun_elevation), np.radians(parameters.sun_azimuth)
    towards_sun = (
        np.cos(elevation) * np.cos(azimuth),
        np.cos(elevation) * np.sin(azimuth),
        np.sin(elevation),
    )
    sun = Sun(
        direction=(-towards_sun[0], -towards_sun[1], -towards_sun[2]),
        strength=parameters.sun_strength,
        angle=1.0,
        color=(1.0, 0.96, 0.9),
    )
    sky = Environment(
        kind="sky",
        sun_elevation=parameters.sun_elevation,
        rotation=parameters.sun_azimuth,
        strength=parameters.sky_strength,
    )
    return build.stage("plaza", (sun,), sky)


def _house_fronts(
    build: SetBuilder,
    parameters: PlazaParameters,
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    rng: np.random.Generator,
) -> None:
    """Line the sides with houses of varied height, their fronts a storey of texture repeated."""
    center, half = (low + high) / 2.0, (high - low) / 2.0
    for side, present in enumerate(parameters.fronts):
        if not present:
            continue
        axis, sign = side % 2, 1.0 if side < 2 else -1.0
        distance = half[axis] + rng.uniform(*FRONT_DISTANCE)
        along, stop = -half[1 - axis] - 16.0, half[1 - axis] + 16.0
        index = 0
        while along < stop:
            storey = float(rng.uniform(2.9, 3.4))
            width, depth = storey * int(rng.integers(2, 5)), float(rng.uniform(7.0, 11.0))
            material = build.material(
                f"front-{side}-{index}", TEXTURES["facade"], rng, metres=storey, roughness=0.7
            )
            place = np.zeros(2)
            place[axis] = sign * (distance + depth / 2.0)
            place[1 - axis] = along + width / 2.0
            size = (depth, width) if axis == 0 else (width, depth)
            x, y = center + place
            solid = box((float(x), float(y), 0.0), (*size, storey * int(rng.integers(2, 5))))
            build.add(f"house-{side}-{index}", solid, material)
            along += width
            index += 1


def _furniture(build: SetBuilder, count: int, paths: NDArray[np.float64], rng: np.random.Generator) -> None:
    """Stand planters, crates, columns, benches and walls around the paths, none too near."""
    low, high = paths.min(axis=0) - FURNITURE_REACH, paths.max(axis=0) + FURNITURE_REACH
    materials = [
        build.material(f"prop-{index}", TEXTURES[kind], rng, metres=tile)
        for index, (kind, tile) in enumerate(
            [
                ("wood", 1.2),
                ("concrete", 1.5),
                ("brick", 1.6),
                ("plaster", 2.0),
                ("wood", 0.8),
                ("brick", 1.0),
            ]
        )
    ]
    taken: list[tuple[NDArray[np.float64], float]] = []
    for index in range(count):
        kind = str(rng.choice(["crate", "planter", "column", "bench", "wall", "bollard"]))
        size, footprint = _furniture_size(kind, rng)
        material = materials[int(rng.integers(len(materials)))]
        for _ in range(40):
            spot = rng.uniform(low, high)
            far_from_people = np.hypot(*(paths - spot).T).min() > CLEARANCE + footprint
            if far_from_people and all(np.hypot(*(spot - other)) > footprint + gap for other, gap in taken):
                break
        else:
            continue  # the square is full; fewer props are as good
        taken.append((spot, footprint))
        place = (float(spot[0]), float(spot[1]), 0.0)
        if kind in ("column", "bollard"):
            build.add(f"prop-{index}-{kind}", cylinder(place, size[0] / 2.0, size[2]), material)
        else:
            solid = box(place, size, yaw=float(rng.uniform(0.0, np.pi)))
            build.add(f"prop-{index}-{kind}", solid, material)


def _furniture_size(kind: str, rng: np.random.Generator) -> tuple[tuple[float, float, float], float]:
    """Return (width, depth, height) and the radius of the footprint, in metres."""
    ranges = {
        "crate": ((0.5, 1.1), (0.5, 1.1), (0.4, 1.2)),
        "planter": ((0.8, 2.0), (0.6, 0.9), (0.4, 0.7)),
        "column": ((0.3, 0.6), (0.3, 0.6), (2.4, 4.0)),
        "bench": ((1.4, 2.2), (0.4, 0.5), (0.42, 0.48)),
        "wall": ((1.5, 3.0), (0.2, 0.3), (0.9, 1.8)),
        "bollard": ((0.15, 0.25), (0.15, 0.25), (0.7, 1.0)),
    }
    width, depth, height = (float(rng.uniform(*span)) for span in ranges[kind])
    if kind in ("column", "bollard"):
        depth = width
    return (width, depth, height), float(np.hypot(width, depth) / 2.0)
