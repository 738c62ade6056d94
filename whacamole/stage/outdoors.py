"""Stages under the sky."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from render_jobs import Environment, Lamp
from whacamole.stage.floor import Floor
from whacamole.stage.horizon import horizon
from whacamole.stage.props import (
    MARKET,
    ROOF,
    STREET,
    Finishes,
    furnish,
    paint_finishes,
)
from whacamole.stage.stage import SetBuilder, Stage
from whacamole.stage.surroundings import daylight, ground
from whacamole.stage.textures import TEXTURES
from whacamole.stage.town import Town, line_with_houses, square_around

__all__ = ["courtyard", "market", "night_street", "plaza", "rooftop"]

Paths = NDArray[np.float64]


def plaza(rng: np.random.Generator, paths: Paths, folder: Path | None) -> Stage:
    """A town square by day: paved, house fronts, street furniture."""
    build, floor = SetBuilder(folder), Floor(paths)
    texture = str(rng.choice(["paving", "paving", "asphalt", "concrete", "brick"]))
    ground(build, floor, texture, float(rng.uniform(2.4, 3.6)), rng)
    sun, sky = daylight(rng, (22.0, 62.0))
    square = square_around(floor, _some_sides(rng, 0.8), rng, sun, 15.0)
    line_with_houses(build, square, Town(), rng, streets=True)
    furnish(build, floor, STREET, int(rng.integers(9, 16)), _masonry(build, rng), rng)
    horizon(build, floor, "town", rng)
    return build.stage("plaza", (sun,), sky, exposure=0.6)


def market(rng: np.random.Generator, paths: Paths, folder: Path | None) -> Stage:
    """A lane of stalls between houses in the low light of morning or evening."""
    build, floor = SetBuilder(folder), Floor(paths)
    ground(build, floor, str(rng.choice(["brick", "paving", "concrete"])), float(rng.uniform(2.0, 3.0)), rng)
    sun, sky = daylight(rng, (12.0, 28.0))
    square = square_around(floor, _some_sides(rng, 0.9), rng, sun, 11.0)
    line_with_houses(build, square, Town(storeys=(2, 3), shops=0.7), rng, streets=True)
    surfaces = {
        "cloth": (("cloth", 1.0), ("cloth", 0.7), ("cloth", 1.3)), "wood": (("wood", 1.0), ("wood", 0.7)),
        "stone": (("concrete", 1.4),),
    }  # fmt: skip
    furnish(build, floor, MARKET, int(rng.integers(14, 22)), paint_finishes(build, surfaces, rng), rng)
    horizon(build, floor, "town", rng)
    return build.stage("market", (sun,), sky, exposure=0.9)


def courtyard(rng: np.random.Generator, paths: Paths, folder: Path | None) -> Stage:
    """A yard closed in by houses, lit by an overcast sky: soft light, no hard shadow."""
    build, floor = SetBuilder(folder), Floor(paths)
    ground(build, floor, str(rng.choice(["paving", "concrete", "brick"])), float(rng.uniform(2.0, 3.5)), rng)
    square = square_around(floor, np.ones(4, bool), rng, None, 15.0)
    line_with_houses(build, square, Town(shops=0.1), rng, streets=False)
    furnish(build, floor, STREET, int(rng.integers(7, 13)), _masonry(build, rng), rng)
    light = Environment(
        kind="hdri",
        hdri=str(rng.choice(["courtyard", "city", "forest"])),  # type: ignore[arg-type]
        rotation=float(rng.uniform(0.0, 360.0)),
        strength=1.0,
        backdrop=(0.72, 0.76, 0.82),
    )
    horizon(build, floor, "town", rng)
    return build.stage("courtyard", (), light, exposure=0.5)


def rooftop(rng: np.random.Generator, paths: Paths, folder: Path | None) -> Stage:
    """A flat roof at sunrise or sunset: parapets, vents, the light of an HDRI from low down."""
    build, floor = SetBuilder(folder), Floor(paths)
    texture, metres = str(rng.choice(["concrete", "asphalt", "wood"])), float(rng.uniform(2.5, 4.0))
    beyond = float(rng.uniform(12.0, 15.0))
    ground(build, floor, texture, metres, rng, beyond + 0.2)
    surfaces = {"stone": (("concrete", 1.4), ("plaster", 2.0), ("brick", 1.4)), "wood": (("wood", 1.0),)}
    furnish(build, floor, ROOF, int(rng.integers(10, 16)), paint_finishes(build, surfaces, rng), rng)
    parapet = build.material("parapet", TEXTURES["brick"], rng, metres=1.6)
    reach = floor.reach + beyond
    for index, (x, y) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1))):
        size = (0.4, 2.0 * reach, 1.1) if x else (2.0 * reach, 0.4, 1.1)
        build.add_box(f"parapet-{index}", (x * reach, y * reach, 0.0), size, parapet)
    light = Environment(
        kind="hdri",
        hdri=str(rng.choice(["sunrise", "sunset"])),  # type: ignore[arg-type]
        rotation=float(rng.uniform(0.0, 360.0)),
        strength=1.2,
    )
    horizon(build, floor, "roofs", rng)
    return build.stage("rooftop", (), light, exposure=1.0)


def night_street(rng: np.random.Generator, paths: Paths, folder: Path | None) -> Stage:
    """A street at night under lamps: warm pools of light, dark fronts."""
    build, floor = SetBuilder(folder), Floor(paths)
    ground(build, floor, str(rng.choice(["asphalt", "paving"])), float(rng.uniform(2.4, 3.4)), rng)
    square = square_around(floor, _some_sides(rng, 0.8), rng, None, 15.0)
    line_with_houses(build, square, Town(shops=0.6, lit=0.35), rng, streets=True, glow=0.8)
    furnish(build, floor, STREET, int(rng.integers(8, 14)), _masonry(build, rng), rng)
    warm = (1.0, float(rng.uniform(0.84, 0.93)), float(rng.uniform(0.66, 0.8)))
    night = Environment(kind="color", color=(0.10, 0.13, 0.22), strength=0.6)
    horizon(build, floor, "night-town", rng)
    return build.stage("night-street", _street_lamps(build, floor, warm, rng), night, exposure=0.3)


def _street_lamps(
    build: SetBuilder, floor: Floor, color: tuple[float, float, float], rng: np.random.Generator
) -> tuple[Lamp, ...]:
    """Stand lamp posts around the paths so that no part of them is dark."""
    post = build.material("post", TEXTURES["concrete"], rng, metres=2.0)
    low, high = floor.low - 3.8, floor.high + 3.8
    columns, rows = np.maximum(np.ceil((high - low) / 9.0), 1).astype(int) + 1
    lamps: list[Lamp] = []
    for x in np.linspace(low[0], high[0], columns):
        for y in np.linspace(low[1], high[1], rows):
            if np.hypot(*(floor.paths - [x, y]).T).min() < 3.4:
                continue
            index, height = len(lamps), float(rng.uniform(4.2, 5.2))
            build.add_cylinder(f"post-{index}", (float(x), float(y), 0.0), 0.07, height, post)
            nearest = floor.paths[int(np.argmin(np.hypot(*(floor.paths - [x, y]).T)))]
            lamp = Lamp(
                position=(float(x), float(y), height + 0.15),
                target=(float(nearest[0]), float(nearest[1]), 0.8),
                power_w=float(rng.uniform(260.0, 420.0)),
                size=0.5,
                color=color,
            )
            lamps.append(lamp)
    return tuple(lamps)


def _masonry(build: SetBuilder, rng: np.random.Generator) -> Finishes:
    stone = (("concrete", 1.5), ("brick", 1.6), ("plaster", 2.0))
    return paint_finishes(build, {"stone": stone, "wood": (("wood", 1.2), ("wood", 0.8))}, rng)


def _some_sides(rng: np.random.Generator, share: float) -> NDArray[np.bool_]:
    """Draw which of four sides are built up, at least one."""
    sides = rng.random(4) < share
    sides[int(rng.integers(4))] = True
    return sides
