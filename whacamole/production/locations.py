"""The stages and maps that a recipe names, read once for a dataset and kept in its ``.work``."""

import shutil
from collections.abc import Callable
from pathlib import Path

from rich.console import Console

from whacamole.dataset import DatasetLayout
from whacamole.production.worklist import work_of
from whacamole.recipe import Recipe
from whacamole.stage import STAGES, Places, find_places

__all__ = ["forget_places", "missing_places", "places_of", "read_places"]

FOLDER = "stages"


def places_of(
    recipe: Recipe, layout: DatasetLayout, on_file: Callable[[Path], None] = lambda _: None
) -> Places:
    """Return the places that a recipe names.

    Raises:
        RecipeError: none of them can be used.
    """
    return find_places(recipe.stages, recipe.hdris, layout.work / FOLDER, tuple(STAGES), on_file)


def read_places(recipe: Recipe, layout: DatasetLayout, *, quiet: bool) -> Places:
    """Read them in sight of the user; what is wrong with them is said once and before all else.

    Raises:
        RecipeError: none of them can be used.
    """
    console = Console(stderr=True, soft_wrap=True, quiet=quiet, highlight=False)
    with console.status("reading stages") as status:
        places = places_of(recipe, layout, lambda file: status.update(f"reading {file}"))
    for note in places.notes:
        console.print(note, markup=False)
    return places


def missing_places(recipe: Recipe) -> tuple[str, ...]:
    """Return a line for each place of a recipe that is not there; nothing is read."""
    named = [Path(entry) for entry in recipe.stages if entry not in STAGES]
    named += [recipe.hdris] if recipe.hdris is not None else []
    return tuple(f"{path}: there is no such file or folder" for path in named if not path.exists())


def forget_places(recipe: Recipe, layout: DatasetLayout) -> None:
    """Remove what was kept, once every sequence of the recipe is there."""
    if not work_of(recipe, layout.root).open:
        shutil.rmtree(layout.work / FOLDER, ignore_errors=True)
