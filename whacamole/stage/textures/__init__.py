"""Tileable surface textures from a few numbers and a seed: grounds, walls, foliage, wood, cloth.

Every texture is a square ``(N, N, 3)`` array of sRGB in [0, 1] that repeats without a seam. Each carries
detail at many scales, because visual odometry and the eye both need something to hold on to.
"""

from collections.abc import Callable

from whacamole.stage.textures.foliage import bark, flowers, leaves
from whacamole.stage.textures.grounds import asphalt, concrete, grass, gravel, paving
from whacamole.stage.textures.painting import Image
from whacamole.stage.textures.walls import ashlar, brick, brickwork, plaster, roof_tiles, stucco, wallpaper
from whacamole.stage.textures.wood_and_cloth import cloth, wood

__all__ = ["TEXTURES"]

TEXTURES: dict[str, Callable[..., Image]] = {
    "ashlar": ashlar,
    "asphalt": asphalt,
    "bark": bark,
    "brick": brick,
    "brickwork": brickwork,
    "cloth": cloth,
    "concrete": concrete,
    "flowers": flowers,
    "grass": grass,
    "gravel": gravel,
    "leaves": leaves,
    "paving": paving,
    "plaster": plaster,
    "roof-tiles": roof_tiles,
    "stucco": stucco,
    "wallpaper": wallpaper,
    "wood": wood,
}
