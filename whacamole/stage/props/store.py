"""What stands in a warehouse."""

from typing import Final

from whacamole.stage.props.prop import PropMaker, block, drum

__all__ = ["WAREHOUSE"]

WAREHOUSE: Final[tuple[PropMaker, ...]] = (
    block("crate", "wood", (0.5, 1.1), (0.5, 1.1), (0.4, 1.2)),
    block("crate", "wood", (0.5, 1.1), (0.5, 1.1), (0.4, 1.2)),
    drum("barrel", "metal", (0.28, 0.36), (0.8, 0.95)),
    block("cabinet", "metal", (0.8, 1.6), (0.35, 0.5), (0.8, 2.1)),
    drum("column", "stone", (0.15, 0.3), (2.4, 4.0)),
)
