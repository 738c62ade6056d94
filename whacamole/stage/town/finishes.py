"""The materials of a town: a few painted surfaces, tinted house by house."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from render_jobs import Material
from whacamole.stage.shapes import Vector
from whacamole.stage.stage import SetBuilder
from whacamole.stage.textures import TEXTURES
from whacamole.stage.textures.windows import shop_windows, sign_boards, window_panes

__all__ = ["TownFinishes", "tinted"]

STUCCO: tuple[Vector, ...] = (
    (0.95, 0.90, 0.78), (0.90, 0.78, 0.56), (0.84, 0.66, 0.44), (0.96, 0.95, 0.92), (0.78, 0.78, 0.76),
    (0.88, 0.72, 0.62), (0.74, 0.52, 0.42), (0.80, 0.83, 0.78), (0.92, 0.86, 0.84), (0.70, 0.74, 0.78),
    (0.94, 0.84, 0.66),
)  # fmt: skip
"""Paints of house fronts: cream, ochre, white, greys, rose, terracotta, pale green and blue."""

BRICK: tuple[Vector, ...] = ((1.0, 0.98, 0.96), (0.92, 0.80, 0.72), (1.0, 1.0, 0.92), (0.80, 0.76, 0.76))
STONE: tuple[Vector, ...] = ((0.98, 0.93, 0.84), (0.90, 0.89, 0.87), (0.96, 0.84, 0.70), (0.82, 0.82, 0.82))
TINTS = {
    "stucco": STUCCO,
    "stucco-dark": ((0.62, 0.60, 0.57), (0.70, 0.62, 0.52), (0.55, 0.50, 0.47)),
    "brick": BRICK,
    "ashlar": STONE,
}

PAINTS: tuple[Vector, ...] = (
    (0.16, 0.27, 0.22), (0.17, 0.22, 0.33), (0.40, 0.13, 0.12), (0.36, 0.24, 0.15), (0.22, 0.22, 0.23),
    (0.47, 0.53, 0.50), (0.55, 0.60, 0.64), (0.74, 0.70, 0.62),
)  # fmt: skip
"""Of doors, shutters and the woodwork of shops."""

ROOFS: tuple[Vector, ...] = ((0.66, 0.36, 0.25), (0.56, 0.32, 0.25), (0.36, 0.37, 0.40), (0.46, 0.38, 0.34))

DOORS = ("door-0", "door-1", "door-2")
SLOPES = ("roof-0", "roof-1")
"""Finishes that have a colour of the town's own."""


def tinted(material: Material, name: str, tint: Vector) -> Material:
    """Return the material under another name and in another colour."""
    return material.model_copy(update={"name": name, "base_color": tint})


class TownFinishes:
    """Paints the surfaces of a town's houses and hands them out by finish."""

    def __init__(self, build: SetBuilder, rng: np.random.Generator, glow: float) -> None:
        """Paint; lit windows shine with ``glow``, at night signs and shops do too."""

        def painted(
            name: str, texture: Callable[..., NDArray[np.float64]], metres: float, roughness: float = 0.85
        ) -> Material:
            return build.material(name, texture, rng, metres=metres, roughness=roughness)

        stucco = painted("stucco", TEXTURES["stucco"], 5.0)
        self._walls = {
            "stucco": stucco,
            "stucco-dark": stucco,
            "brick": painted("brickwork", TEXTURES["brickwork"], 4.0),
            "ashlar": painted("ashlar", TEXTURES["ashlar"], 2.4),
        }
        tiles = painted("tiles", TEXTURES["roof-tiles"], 4.0, 0.8)
        pane = painted("panes", window_panes, 1.0, 0.06)
        shop = painted("shops", shop_windows, 1.0, 0.08)
        sign = painted("signs", sign_boards, 1.0, 0.4)
        awning = painted("awnings", TEXTURES["awning"], float(rng.uniform(1.2, 2.4)))
        paints = [PAINTS[index] for index in rng.permutation(len(PAINTS))[: len(DOORS)]]
        roofs = [ROOFS[index] for index in rng.permutation(len(ROOFS))[: len(SLOPES)]]
        self._rest = {
            "brick": self._walls["brick"],
            "trim-pale": tinted(stucco, "trim-pale", (0.95, 0.93, 0.88)),
            "trim-sand": tinted(stucco, "trim-sand", (0.86, 0.79, 0.67)),
            "trim-grey": tinted(stucco, "trim-grey", (0.66, 0.65, 0.63)),
            "stone": tinted(stucco, "stone", (0.60, 0.59, 0.57)),
            "slabs": tinted(self._walls["ashlar"], "slabs", (0.74, 0.73, 0.71)),
            "frame-white": build.plain("frame-white", (0.86, 0.86, 0.84), roughness=0.4),
            "frame-dark": build.plain("frame-dark", (0.18, 0.19, 0.20), roughness=0.4),
            "frame-wood": build.plain("frame-wood", (0.38, 0.25, 0.16), roughness=0.5),
            **{
                door: build.plain(door, paint, roughness=0.4)
                for door, paint in zip(DOORS, paints, strict=True)
            },
            **{roof: tinted(tiles, roof, tint) for roof, tint in zip(SLOPES, roofs, strict=True)},
            "metal": build.plain("town-metal", (0.24, 0.25, 0.26), roughness=0.45, metallic=0.6),
            "pot": build.plain("pot", (0.60, 0.36, 0.26), roughness=0.9),
            "awning": awning,
            "pane": pane,
            "lit": _glowing(pane, "lit", (1.0, 0.80, 0.52), glow),
            "lit-cool": _glowing(pane, "lit-cool", (0.95, 0.93, 0.85), 0.8 * glow),
            "shop": shop,
            "shop-lit": _glowing(shop, "shop-lit", (1.0, 0.88, 0.68), 0.3 * glow),
            "sign": _glowing(sign, "sign", (1.0, 0.95, 0.85), 0.06 * glow) if glow else sign,
        }  # fmt: skip

    def wall(self, finish: str, house: str, rng: np.random.Generator) -> Material:
        """Return a wall's material in a paint or stone of the house's own."""
        tints = TINTS[finish]
        return tinted(self._walls[finish], f"{house}.{finish}", tints[int(rng.integers(len(tints)))])

    def __getitem__(self, finish: str) -> Material:
        """The material of what is on a front."""
        return self._rest[finish]


def _glowing(material: Material, name: str, color: Vector, glow: float) -> Material:
    return material.model_copy(
        update={"name": name, "emission": color, "emission_strength": glow, "emission_lights": False}
    )
