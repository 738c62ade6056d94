"""Places to film in: geometry, light, and what a camera or a person may not enter."""

from whacamole.stage.plaza import PlazaParameters, plaza, plaza_rand
from whacamole.stage.stage import SetBuilder, Stage

__all__ = ["PlazaParameters", "SetBuilder", "Stage", "plaza", "plaza_rand"]
