"""Things that stand about: they give the camera parallax and the eye a sense of size."""

from whacamole.stage.props.furnish import furnish, put
from whacamole.stage.props.prop import Finishes, Part, Prop, PropMaker, block, drum, paint_finishes
from whacamole.stage.props.street import MARKET, ROOF, STREET
from whacamole.stage.props.trees import plant_trees

__all__ = [
    "MARKET",
    "ROOF",
    "STREET",
    "Finishes",
    "Part",
    "Prop",
    "PropMaker",
    "block",
    "drum",
    "furnish",
    "paint_finishes",
    "plant_trees",
    "put",
]
