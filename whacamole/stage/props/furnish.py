"""Standing props about, out of the way of people and of each other."""

from collections.abc import Sequence

import numpy as np

from render_jobs import Material
from whacamole.stage.floor import CLEARANCE, Floor
from whacamole.stage.props.prop import Finishes, Prop, PropMaker
from whacamole.stage.shapes import Vector, joined, turned
from whacamole.stage.stage import SetBuilder

__all__ = ["furnish", "put"]


def furnish(
    build: SetBuilder,
    floor: Floor,
    makers: Sequence[PropMaker],
    count: int,
    finishes: Finishes,
    rng: np.random.Generator,
    *,
    beyond: float = 9.0,
    clearance: float = CLEARANCE,
) -> None:
    """Stand ``count`` props of the given kinds around the paths; fewer where the floor is full.

    Args:
        beyond: how far outside the rectangle of the paths [m]; farther off they give little parallax.
        clearance: from the paths [m].
    """
    for index in range(count):
        prop = makers[int(rng.integers(len(makers)))](rng)
        radius = float(np.hypot(prop.size[0], prop.size[1]) / 2.0)
        place = floor.spot(rng, radius, beyond, clearance)
        yaw = float(rng.uniform(0.0, 2.0 * np.pi))
        if place is not None:
            put(build, f"{prop.name}-{index}", prop, (*place, 0.0), yaw, finishes, rng)


def put(
    build: SetBuilder,
    name: str,
    prop: Prop,
    base: Vector,
    yaw: float,
    finishes: Finishes,
    rng: np.random.Generator,
) -> None:
    """Put a prop on the set, one mesh for each of its finishes, called ``name.finish``,
    and one for what is shaded smoothly."""
    build.keep_out(name, base, prop.size, yaw)
    chosen: dict[str, Material] = {}
    for finish, smooth in dict.fromkeys((part.finish, part.smooth) for part in prop.parts):
        if finish not in chosen:
            chosen[finish] = finishes[finish][int(rng.integers(len(finishes[finish])))]
        solid = joined([part.solid for part in prop.parts if (part.finish, part.smooth) == (finish, smooth)])
        mesh = f"{name}.{finish}-smooth" if smooth else f"{name}.{finish}"
        build.add(mesh, turned(solid, base, yaw), chosen[finish], smooth=smooth)
