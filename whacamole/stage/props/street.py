"""What stands in streets, on squares, markets and roofs."""

from typing import Final

from whacamole.stage.props.prop import PropMaker, block, drum

__all__ = ["MARKET", "ROOF", "STREET"]

_CRATE = block("crate", "wood", (0.5, 1.1), (0.5, 1.1), (0.4, 1.2))
_COLUMN = drum("column", "stone", (0.15, 0.3), (2.4, 4.0))
_WALL = block("wall", "stone", (1.5, 3.0), (0.2, 0.3), (0.9, 1.8))

STREET: Final[tuple[PropMaker, ...]] = (
    _CRATE,
    block("planter", "stone", (0.8, 2.0), (0.6, 0.9), (0.4, 0.7)),
    _COLUMN,
    block("bench", "wood", (1.4, 2.2), (0.4, 0.5), (0.42, 0.48)),
    _WALL,
    drum("bollard", "stone", (0.08, 0.13), (0.7, 1.0)),
)

MARKET: Final[tuple[PropMaker, ...]] = (
    block("stall", "cloth", (1.8, 2.8), (0.9, 1.2), (0.85, 1.0)),
    block("stall", "cloth", (1.8, 2.8), (0.9, 1.2), (0.85, 1.0)),
    _CRATE,
    drum("barrel", "wood", (0.28, 0.36), (0.8, 0.95)),
    _CRATE,
    _COLUMN,
)

_VENT = block("vent", "stone", (0.8, 2.0), (0.8, 1.6), (0.7, 1.6))

ROOF: Final[tuple[PropMaker, ...]] = (_VENT, _VENT, _WALL, _COLUMN, _CRATE)
