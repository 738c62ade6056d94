"""What every drawn picture shares: ink, paper and letters."""

from functools import cache

from PIL import ImageFont

__all__ = ["INK", "PAPER", "font"]

INK = (34, 34, 38)
PAPER = (252, 252, 250)


@cache
def _sized(size: int) -> ImageFont.FreeTypeFont:
    loaded = ImageFont.load_default(size=size)
    assert isinstance(loaded, ImageFont.FreeTypeFont)
    return loaded


def font(height: int) -> ImageFont.FreeTypeFont:
    """Letters for a picture of this height [px]."""
    return _sized(max(10, round(height / 22)))
