"""Furniture of rooms and halls."""

from typing import Final

from whacamole.stage.props.prop import PropMaker, block, drum

__all__ = ["HALL", "LIVING_ROOM"]

LIVING_ROOM: Final[tuple[PropMaker, ...]] = (
    block("cabinet", "wood", (0.8, 1.6), (0.35, 0.5), (0.8, 2.1)),
    block("sofa", "cloth", (1.6, 2.3), (0.8, 1.0), (0.4, 0.75)),
    block("table", "wood", (1.0, 2.0), (0.7, 1.0), (0.72, 0.78)),
    drum("stool", "cloth", (0.18, 0.24), (0.42, 0.75)),
)

HALL: Final[tuple[PropMaker, ...]] = (
    block("bench", "wood", (1.4, 2.2), (0.4, 0.5), (0.42, 0.48)),
    block("box", "cloth", (0.5, 1.1), (0.5, 1.1), (0.4, 1.2)),
    block("cabinet", "wood", (0.8, 1.6), (0.35, 0.5), (0.8, 2.1)),
)
