"""The materials of what stands about outdoors."""

from typing import Final

import numpy as np

from whacamole.stage.props.prop import Finishes
from whacamole.stage.shapes import Vector
from whacamole.stage.stage import SetBuilder
from whacamole.stage.textures import TEXTURES
from whacamole.stage.textures.windows import posters

__all__ = ["paint_outdoors"]

PLAIN: Final[dict[str, tuple[Vector, float, float]]] = {
    "metal": ((0.20, 0.21, 0.22), 0.45, 0.7),
    "steel": ((0.58, 0.60, 0.61), 0.35, 0.8),
    "casing": ((0.76, 0.76, 0.73), 0.5, 0.0),
    "glass": ((0.10, 0.14, 0.17), 0.08, 0.0),
    "water": ((0.12, 0.20, 0.22), 0.05, 0.0),
    "terracotta": ((0.62, 0.38, 0.27), 0.9, 0.0),
    "wicker": ((0.55, 0.40, 0.23), 0.9, 0.0),
    "felt": ((0.30, 0.30, 0.30), 0.9, 0.0),
    "sign-red": ((0.70, 0.08, 0.09), 0.4, 0.0),
    "sign-blue": ((0.08, 0.22, 0.52), 0.4, 0.0),
    "sign-white": ((0.90, 0.90, 0.89), 0.4, 0.0),
    "bin-green": ((0.16, 0.28, 0.19), 0.5, 0.0),
    "bin-grey": ((0.25, 0.26, 0.27), 0.5, 0.0),
    "bin-blue": ((0.15, 0.24, 0.38), 0.5, 0.0),
    "fruit-red": ((0.66, 0.10, 0.09), 0.35, 0.0),
    "fruit-orange": ((0.90, 0.48, 0.10), 0.5, 0.0),
    "fruit-green": ((0.42, 0.58, 0.16), 0.4, 0.0),
    "fruit-yellow": ((0.90, 0.76, 0.22), 0.45, 0.0),
    "fruit-purple": ((0.28, 0.12, 0.26), 0.4, 0.0),
}
"""Colour, roughness and metal of what has no pattern."""

PAINTS: Final[tuple[Vector, ...]] = (
    (0.16, 0.30, 0.24),
    (0.22, 0.26, 0.34),
    (0.42, 0.14, 0.13),
    (0.32, 0.33, 0.34),
)

PAINTED: Final[dict[str, tuple[tuple[str, float], ...]]] = {
    "planks": (("wood", 0.7),),
    "stone": (("concrete", 1.5),),
    "awning-0": (("awning", 1.4),),
    "awning-1": (("awning", 2.0),),
    "brick": (("brickwork", 4.0),),
    "render": (("stucco", 4.0),),
}
"""Texture, and metres after which it repeats, of what has one."""


def paint_outdoors(
    build: SetBuilder,
    textures: tuple[str, ...],
    rng: np.random.Generator,
    *,
    posted: bool = False,
    glow: float = 0.0,
) -> Finishes:
    """Paint the named ``textures``, posters if ``posted``; make plain finishes and lamps of ``glow``."""
    finishes: Finishes = {
        name: tuple(
            build.material(f"{name}-{index}", TEXTURES[kind], rng, metres=metres)
            for index, (kind, metres) in enumerate(PAINTED[name])
        )
        for name in textures
    }
    if posted:
        finishes["posters"] = (build.material("posters", posters, rng, metres=2.6),)
    for name, (color, roughness, metallic) in PLAIN.items():
        finishes[name] = (build.plain(name, color, roughness=roughness, metallic=metallic),)
    finishes["paint"] = (build.plain("paint", PAINTS[int(rng.integers(len(PAINTS)))], roughness=0.4),)
    finishes["lamp"] = (build.plain("lamp", (1.0, 0.86, 0.62), roughness=0.3, glow=glow),)
    return finishes
