"""Things that stand about: they give the camera parallax and the eye a sense of size."""

from whacamole.stage.props.furnish import furnish, put
from whacamole.stage.props.market import MARKET
from whacamole.stage.props.outdoor_finishes import paint_outdoors
from whacamole.stage.props.prop import Finishes, Part, Prop, PropMaker, block, drum, paint_finishes
from whacamole.stage.props.roof import ROOF, stair_house
from whacamole.stage.props.street import STREET, YARD, fountain, lamp_post, lantern_parts
from whacamole.stage.props.trees import plant_trees

__all__ = [
    "MARKET",
    "ROOF",
    "STREET",
    "YARD",
    "Finishes",
    "Part",
    "Prop",
    "PropMaker",
    "block",
    "drum",
    "fountain",
    "furnish",
    "lamp_post",
    "lantern_parts",
    "paint_finishes",
    "paint_outdoors",
    "plant_trees",
    "put",
    "stair_house",
]
