"""The body model that a recipe names."""

from whacamole.body import BodyModel
from whacamole.recipe import Recipe

__all__ = ["body_of"]


def body_of(recipe: Recipe) -> BodyModel:
    """Return the body model that a recipe names.

    Raises:
        BodyModelError: the file is no SMPL-X-schema model.
    """
    return BodyModel.embedded() if recipe.body_model is None else BodyModel.load(recipe.body_model)
