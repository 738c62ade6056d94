"""Tileable surface textures from a few numbers and a seed: grounds, walls, foliage, wood, cloth.

Every texture is a square ``(N, N, 3)`` array of sRGB in [0, 1] that repeats without a seam. Each carries
detail at many scales, because visual odometry and the eye both need something to hold on to.
"""

from collections.abc import Callable

from whacamole.stage.textures.floors import boards, carpet, floor_tiles, herringbone, poured
from whacamole.stage.textures.foliage import bark
from whacamole.stage.textures.grounds import asphalt, clinker, concrete, grass, gravel, setts, slabs
from whacamole.stage.textures.interiors import (
    art,
    blockwork,
    cardboard,
    paint,
    palette,
    rug,
    timber,
    wallpaper,
    weave,
)
from whacamole.stage.textures.painting import Image
from whacamole.stage.textures.walls import ashlar, brick, brickwork, plaster, roof_tiles, stucco
from whacamole.stage.textures.wood_and_cloth import awning, wood

__all__ = ["TEXTURES"]

TEXTURES: dict[str, Callable[..., Image]] = {
    "art": art,
    "ashlar": ashlar,
    "asphalt": asphalt,
    "awning": awning,
    "bark": bark,
    "blockwork": blockwork,
    "boards": boards,
    "brick": brick,
    "brickwork": brickwork,
    "cardboard": cardboard,
    "carpet": carpet,
    "clinker": clinker,
    "concrete": concrete,
    "floor-tiles": floor_tiles,
    "grass": grass,
    "gravel": gravel,
    "herringbone": herringbone,
    "paint": paint,
    "palette": palette,
    "plaster": plaster,
    "poured": poured,
    "roof-tiles": roof_tiles,
    "rug": rug,
    "setts": setts,
    "slabs": slabs,
    "stucco": stucco,
    "timber": timber,
    "wallpaper": wallpaper,
    "weave": weave,
    "wood": wood,
}
