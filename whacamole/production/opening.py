"""Opening a dataset: settle its recipe once, whoever comes first, and refuse to mix two."""

import contextlib
import fcntl
import os
from collections.abc import Iterator
from concurrent.futures import Future

from rich.console import Console

from render_jobs.probe import seek_engine
from whacamole.dataset import DatasetLayout, read_json
from whacamole.dataset.files import write_json
from whacamole.errors import DatasetError
from whacamole.production.pulse import run_name
from whacamole.recipe import Recipe

__all__ = ["EngineSearch", "check_folder", "index_lock", "open_dataset_for"]

MAY_DIFFER = frozenset({"motions", "shots_per_motion", "limit", "test_fraction", "allow_breaches"})
"""What may change between two runs into one dataset: it adds sequences, but alters none."""


class EngineSearch:
    """Settles "auto" while other work goes on: what the dataset was begun with, else the best engine here."""

    def __init__(self, recipe: Recipe, layout: DatasetLayout) -> None:
        self._kept = layout.root / "recipe.json"
        self._recipe = recipe
        self._sought: Future[tuple[str, str]] | None = None
        if recipe.engine == "auto" and not self._kept.exists():
            self._sought = seek_engine()

    def settled(self, *, quiet: bool) -> Recipe:
        """Return the recipe with an engine; waits until it is found.

        Raises:
            EngineError: nothing can render here.
        """
        if self._recipe.engine != "auto":
            return self._recipe
        if self._sought is None:
            return _with_engine(self._recipe, str(read_json(self._kept)["engine"]))
        engine, note = self._sought.result()
        if note and not quiet:
            Console(stderr=True, soft_wrap=True).print(note, markup=False)
        return _with_engine(self._recipe, engine)


def check_folder(recipe: Recipe, layout: DatasetLayout) -> None:
    """Make sure that the dataset of ``recipe`` can begin or go on in this folder; nothing is written.

    Raises:
        DatasetError: the folder is a file, holds other things, or a dataset of another recipe.
    """
    there = next(path for path in (layout.root, *layout.root.parents) if path.exists())
    if not there.is_dir():
        raise DatasetError(f"{there}: is a file, not a folder; choose another --out")
    _refuse_other_files(layout)
    kept = layout.root / "recipe.json"
    if kept.exists():
        if recipe.engine == "auto":
            recipe = _with_engine(recipe, str(read_json(kept)["engine"]))
        _check_same(layout, recipe)


def open_dataset_for(recipe: Recipe, layout: DatasetLayout, *, engine_is_ours: bool) -> Recipe:
    """Begin the dataset of ``recipe``, or go on with it; several runs may do so at the same time.

    Args:
        engine_is_ours: the engine was found here; where another run has just begun the dataset with another
            one, that one holds.

    Returns:
        the recipe with the dataset's engine.

    Raises:
        DatasetError: the folder holds a dataset of another recipe, or something else.
    """
    kept = layout.root / "recipe.json"
    _refuse_other_files(layout)
    layout.root.mkdir(parents=True, exist_ok=True)
    mine = layout.root / f".recipe-{run_name()}.json"
    write_json(mine, recipe.save_as_dict())
    try:
        with contextlib.suppress(FileExistsError):
            os.link(mine, kept)  # the first of several takes the place
        if engine_is_ours:
            recipe = _with_engine(recipe, str(read_json(kept)["engine"]))
        _check_same(layout, recipe)
        if read_json(kept) != recipe.save_as_dict():  # in what may differ
            write_json(kept, recipe.save_as_dict())
    finally:
        mine.unlink(missing_ok=True)
    layout.sequences.mkdir(exist_ok=True)
    layout.work.mkdir(exist_ok=True)
    return recipe


@contextlib.contextmanager
def index_lock(layout: DatasetLayout) -> Iterator[None]:
    """Let one run at a time derive the index, so that the last one to end lists all that is finished."""
    with (layout.root / "recipe.json").open("r+") as lock:
        with contextlib.suppress(OSError):  # no locks here: the index may miss what ends at this moment
            fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def _with_engine(recipe: Recipe, engine: str) -> Recipe:
    return Recipe.model_validate({**recipe.save_as_dict(), "engine": engine})


def _refuse_other_files(layout: DatasetLayout) -> None:
    if (layout.root / "recipe.json").exists() or not layout.root.exists():
        return
    ours = {path for path in layout.root.iterdir() if path.name.startswith(".recipe-")} | {layout.work}
    if any(path not in ours for path in layout.root.iterdir()):
        if (layout.root / "recipe.json").exists():  # another run has begun it this moment
            return
        raise DatasetError(f"{layout.root}: holds other files and no dataset; choose an empty --out")


def _check_same(layout: DatasetLayout, recipe: Recipe) -> None:
    """Refuse to mix two recipes in one dataset."""
    before, now = read_json(layout.root / "recipe.json"), recipe.save_as_dict()
    differing = [name for name in now if name not in MAY_DIFFER and before.get(name) != now[name]]
    if differing:
        changes = ", ".join(f"{name} {before.get(name)} is now {now[name]}" for name in differing)
        raise DatasetError(
            f"{layout.root}: was begun with another recipe ({changes}); choose another --out, or delete "
            "that folder to begin anew"
        )
