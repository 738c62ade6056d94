"""What lines streets and squares: houses with modelled fronts, drawn one by one."""

from whacamole.stage.town.house import Town
from whacamole.stage.town.rows import Square, line_with_houses, square_around

__all__ = ["Square", "Town", "line_with_houses", "square_around"]
