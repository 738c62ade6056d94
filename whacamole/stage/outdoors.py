"""Stages under the sky."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from render_jobs import Environment, Lamp, Material
from whacamole.stage.floor import Floor
from whacamole.stage.horizon import horizon
from whacamole.stage.pile import Pile
from whacamole.stage.props import (
    MARKET,
    ROOF,
    STREET,
    YARD,
    Finishes,
    fountain,
    furnish,
    lantern_parts,
    paint_outdoors,
    stair_house,
)
from whacamole.stage.props.plants import plant_finishes
from whacamole.stage.shapes import boxes, cylinder, joined, moved
from whacamole.stage.stage import SetBuilder, Stage
from whacamole.stage.surroundings import daylight, ground
from whacamole.stage.town import Town, line_with_houses, square_around

__all__ = ["courtyard", "market", "night_street", "plaza", "rooftop"]

Paths = NDArray[np.float64]

REPEATS = {"asphalt": 3.0, "clinker": 3.6, "concrete": 4.0, "gravel": 2.2, "setts": 3.6, "slabs": 4.8}
"""After how many metres a ground repeats, so that its stones have their true size."""

STREET_TEXTURES = ("planks", "stone", "brick")
"""What the things of a street or a yard are painted with."""

YARD_SKIES = {"courtyard": 2.4, "city": 1.0, "forest": 1.4}
"""Strength of the skies over a yard: only what comes from high up gets into it."""

MANHOLE = 0.32
"""Radius of a manhole's cover [m]."""

PARAPET = (0.4, 1.1)
"""Thickness and height of a roof's parapet [m]."""


def plaza(rng: np.random.Generator, paths: Paths, folder: Path | None) -> Stage:
    """A town square by day: paved, house fronts, street furniture."""
    build, floor = SetBuilder(folder), Floor(paths)
    _pave(build, floor, ("slabs", "slabs", "setts", "clinker", "asphalt"), rng)
    sun, sky = daylight(rng, (22.0, 62.0))
    square = square_around(floor, _some_sides(rng, 0.8), rng, sun, 15.0)
    line_with_houses(build, square, Town(), rng, streets=True)
    finishes = plant_finishes(build, rng) | paint_outdoors(build, STREET_TEXTURES, rng, posted=True)
    furnish(build, floor, (fountain,), int(rng.random() < 0.6), finishes, rng, beyond=8.0)
    furnish(build, floor, STREET, int(rng.integers(11, 17)), finishes, rng, beyond=8.0)
    horizon(build, floor, "town", rng)
    return build.stage("plaza", (sun,), sky, exposure=0.6)


def market(rng: np.random.Generator, paths: Paths, folder: Path | None) -> Stage:
    """A lane of stalls between houses in the low light of morning or evening."""
    build, floor = SetBuilder(folder), Floor(paths)
    _pave(build, floor, ("setts", "setts", "slabs", "clinker"), rng)
    sun, sky = daylight(rng, (12.0, 28.0))
    square = square_around(floor, _some_sides(rng, 0.9), rng, sun, 11.0)
    line_with_houses(build, square, Town(storeys=(2, 3), shops=0.7), rng, streets=True)
    finishes = paint_outdoors(build, ("planks", "awning-0", "awning-1"), rng)
    furnish(build, floor, MARKET, int(rng.integers(12, 17)), finishes, rng, beyond=8.0)
    horizon(build, floor, "town", rng)
    return build.stage("market", (sun,), sky, exposure=0.9)


def courtyard(rng: np.random.Generator, paths: Paths, folder: Path | None) -> Stage:
    """A yard closed in by houses, lit by an overcast sky: soft light, no hard shadow."""
    build, floor = SetBuilder(folder), Floor(paths)
    _pave(build, floor, ("slabs", "setts", "clinker"), rng)
    square = square_around(floor, np.ones(4, bool), rng, None, 15.0)
    line_with_houses(build, square, Town(storeys=(2, 3), shops=0.1), rng, streets=False)
    finishes = plant_finishes(build, rng) | paint_outdoors(build, STREET_TEXTURES, rng)
    furnish(build, floor, YARD, int(rng.integers(10, 16)), finishes, rng, beyond=8.0)
    sky = str(rng.choice(list(YARD_SKIES)))
    light = Environment(
        kind="hdri",
        hdri=sky,  # type: ignore[arg-type]
        rotation=float(rng.uniform(0.0, 360.0)),
        strength=YARD_SKIES[sky],
        backdrop=(0.72, 0.76, 0.82),
    )
    horizon(build, floor, "town", rng)
    return build.stage("courtyard", (), light, exposure=0.5)


def rooftop(rng: np.random.Generator, paths: Paths, folder: Path | None) -> Stage:
    """A flat roof at sunrise or sunset: parapets, vents, the light of an HDRI from low down."""
    build, floor = SetBuilder(folder), Floor(paths)
    texture = str(rng.choice(["concrete", "asphalt", "gravel", "slabs"]))
    beyond = float(rng.uniform(12.0, 15.0))
    ground(build, floor, texture, REPEATS[texture], rng, beyond + 0.2)
    finishes = paint_outdoors(build, ("planks", "stone", "brick", "render"), rng)
    furnish(build, floor, (stair_house,), 1, finishes, rng)
    furnish(build, floor, ROOF, int(rng.integers(12, 18)), finishes, rng)
    wall = finishes[str(rng.choice(["brick", "render"]))][0]
    _parapet(build, floor.reach + beyond, wall, finishes["stone"][0])
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
    _pave(build, floor, ("asphalt", "asphalt", "slabs", "setts"), rng)
    square = square_around(floor, _some_sides(rng, 0.8), rng, None, 15.0)
    line_with_houses(build, square, Town(shops=0.6, lit=0.35), rng, streets=True, glow=0.8)
    finishes = plant_finishes(build, rng) | paint_outdoors(build, STREET_TEXTURES, rng, posted=True, glow=2.5)
    furnish(build, floor, STREET[:-2], int(rng.integers(8, 14)), finishes, rng, beyond=8.0)
    warm = (1.0, float(rng.uniform(0.84, 0.93)), float(rng.uniform(0.66, 0.8)))
    night = Environment(kind="color", color=(0.10, 0.13, 0.22), strength=0.6)
    horizon(build, floor, "night-town", rng)
    lamps = _street_lamps(build, floor, finishes, warm, rng)
    return build.stage("night-street", lamps, night, exposure=0.3)


def _street_lamps(
    build: SetBuilder,
    floor: Floor,
    finishes: Finishes,
    color: tuple[float, float, float],
    rng: np.random.Generator,
) -> tuple[Lamp, ...]:
    """Stand lanterns around the paths so that no part of them is dark."""
    lanterns = Pile()
    low, high = floor.low - 3.8, floor.high + 3.8
    columns, rows = np.maximum(np.ceil((high - low) / 9.0), 1).astype(int) + 1
    lamps: list[Lamp] = []
    for x in np.linspace(low[0], high[0], columns):
        for y in np.linspace(low[1], high[1], rows):
            if np.hypot(*(floor.paths - [x, y]).T).min() < 3.4:
                continue
            index, height = len(lamps), float(rng.uniform(4.2, 5.2))
            base = (float(x), float(y), 0.0)
            post, *head = lantern_parts(height)
            build.add(f"post-{index}.metal", moved(post.solid, base), finishes["metal"][0])
            build.keep_out(f"post-{index}", base, (0.26, 0.26, height), 0.0)
            for part in head:
                lanterns.add(part.finish, moved(part.solid, base))
            nearest = floor.paths[int(np.argmin(np.hypot(*(floor.paths - [x, y]).T)))]
            lamp = Lamp(
                position=(float(x), float(y), height + 0.15),
                target=(float(nearest[0]), float(nearest[1]), 0.8),
                power_w=float(rng.uniform(260.0, 420.0)),
                size=0.5,
                color=color,
            )
            lamps.append(lamp)
    for finish, solid in lanterns.merged():
        build.add(f"lanterns.{finish}", solid, finishes[finish][0])
    return tuple(lamps)


def _pave(build: SetBuilder, floor: Floor, kinds: tuple[str, ...], rng: np.random.Generator) -> None:
    """Lay a ground of one of the kinds, with covers of manholes where nobody treads."""
    kind = str(rng.choice(kinds))
    ground(build, floor, kind, REPEATS[kind], rng)
    covers = []
    for _ in range(int(rng.integers(2, 6))):
        place = floor.spot(rng, MANHOLE, 5.0, 1.0)
        if place is not None:
            covers.append(cylinder((*place, 0.0), MANHOLE, 0.005))
    if covers:
        build.add("manholes", joined(covers), build.plain("manhole", (0.17, 0.17, 0.18), metallic=0.5))


def _parapet(build: SetBuilder, reach: float, wall: Material, coping: Material) -> None:
    """Wall in a roof that reaches so far from its middle [m]; slabs of stone lie on the wall."""
    for index, (x, y) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1))):
        half = np.array([PARAPET[0] / 2, reach] if x else [reach, PARAPET[0] / 2])
        middle = np.array([x * reach, y * reach])
        top = PARAPET[1]
        low, high = middle - half + 0.04, middle + half - 0.04
        build.add(f"parapet-{index}.wall", boxes([*low, 0.0], [*high, top - 0.07]), wall)
        low, high = middle - half, middle + half
        build.add(f"parapet-{index}.coping", boxes([*low, top - 0.07], [*high, top]), coping)
        base, size = (float(middle[0]), float(middle[1]), 0.0), (float(2 * half[0]), float(2 * half[1]), top)
        build.keep_out(f"parapet-{index}", base, size, 0.0)


def _some_sides(rng: np.random.Generator, share: float) -> NDArray[np.bool_]:
    """Draw which of four sides are built up, at least one."""
    sides = rng.random(4) < share
    sides[int(rng.integers(4))] = True
    return sides
