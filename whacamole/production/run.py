"""Making all sequences of a recipe, some at a time, each in a process of its own."""

import os
import subprocess
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from importlib.metadata import version
from pathlib import Path
from typing import Any

from rich.console import Console

from render_jobs.farm import run_farm
from render_jobs.probe import choose_engine
from whacamole import __version__
from whacamole.dataset import DatasetLayout, open_dataset, read_json, write_index
from whacamole.dataset.card import write_card
from whacamole.dataset.files import write_json
from whacamole.dataset.splitting import refresh_splits
from whacamole.dataset.statistics import collect
from whacamole.errors import DatasetError
from whacamole.production.attempt import AttemptError, attempt
from whacamole.production.progress import ProgressDisplay
from whacamole.production.report import Production
from whacamole.production.worklist import SequenceOrder, Worklist, failure_note, work_of
from whacamole.recipe import Recipe
from whacamole.viewing.page import write_page

__all__ = ["Production", "produce"]

MAY_DIFFER = frozenset({"motions", "shots_per_motion", "limit", "test_fraction", "allow_breaches"})
"""What may change between two runs into one dataset: it adds sequences, but alters none."""


def produce(
    recipe: Recipe,
    out: Path,
    *,
    jobs: int = 1,
    device: str = "auto",
    dry_run: bool = False,
    quiet: bool = False,
) -> Production:
    """Make, or finish, the dataset of ``recipe`` in the folder ``out``.

    Args:
        jobs: sequences made at the same time.
        device: "auto", "cpu" or "gpu".
        dry_run: only say what would be made.
        quiet: show no progress.

    Raises:
        MotionError: there is no motion to film.
        RecipeError, BodyModelError: the recipe cannot be carried out.
        DatasetError: ``out`` holds a dataset of another recipe, or something else.
    """
    layout = DatasetLayout(out.resolve())
    worklist = work_of(recipe, layout.root)
    if dry_run:
        return Production(layout.root, worklist, {}, 0.0, {}, dry_run=True)
    recipe = _with_engine(recipe, layout, quiet)
    _check_recipe(layout, recipe)
    facts = _facts(recipe)
    worklist = work_of(recipe, layout.root)
    _open_dataset(layout, recipe)
    started = time.monotonic()
    failures = _make_all(worklist, jobs, device, quiet)
    write_index(layout, facts, recipe.test_fraction)
    sides = refresh_splits(layout, recipe.test_fraction)  # by the rule of `split`, companions counted
    if layout.finished():
        numbers = collect(open_dataset(layout.root))
        write_card(layout, numbers)
        write_page(layout, numbers)
    finished = work_of(recipe, layout.root)
    seconds = time.monotonic() - started
    kept = len(worklist.orders) - len(worklist.open)
    return Production(layout.root, finished, failures, seconds, sides, kept=kept)


def _with_engine(recipe: Recipe, layout: DatasetLayout, quiet: bool) -> Recipe:
    """Settle "auto": what the dataset was begun with, else the best engine that this machine can run.

    Raises:
        EngineError: nothing can render here.
    """
    if recipe.engine != "auto":
        return recipe
    kept = layout.root / "recipe.json"
    if kept.exists():
        engine, note = str(read_json(kept)["engine"]), ""
    else:
        engine, note = choose_engine()
    if note and not quiet:
        Console(stderr=True, soft_wrap=True).print(note, markup=False)
    return Recipe.model_validate({**recipe.save_as_dict(), "engine": engine})


@dataclass
class _Processes:
    """The workers that run now, so that none outlives an interrupted run."""

    running: set[subprocess.Popen[str]] = field(default_factory=set)
    lock: threading.Lock = field(default_factory=threading.Lock)
    stopped: bool = False

    def add(self, process: subprocess.Popen[str]) -> None:
        with self.lock:
            self.running = {other for other in self.running if other.poll() is None} | {process}
            if self.stopped:
                process.terminate()

    def stop(self) -> None:
        with self.lock:
            self.stopped = True
            for process in self.running:
                process.terminate()


def _make_all(worklist: Worklist, jobs: int, device: str, quiet: bool) -> dict[str, str]:
    """Make the open orders; return the one-line error of each that failed."""
    threads = max(1, (os.cpu_count() or 1) // jobs)
    processes = _Processes()
    failures: dict[str, str] = {}
    total = len(worklist.orders)
    with (
        ProgressDisplay(total, total - len(worklist.open), quiet) as display,
        ThreadPoolExecutor(jobs) as pool,
    ):

        def make(order: SequenceOrder) -> None:
            failure_note(order).unlink(missing_ok=True)
            display.begin(order.sequence_id)
            try:
                attempt(order, display.listen, threads=threads, device=device, running=processes.add)
            finally:
                display.leave(order.sequence_id)

        try:
            for outcome in run_farm(pool, make, worklist.open, in_flight=jobs, retry=_may_help):
                if outcome.error is None:
                    display.made(outcome.task.sequence_id)
                elif outcome.final:
                    failures[outcome.task.sequence_id] = str(outcome.error)
                    write_json(failure_note(outcome.task), {"error": str(outcome.error)})
                    display.failed(outcome.task.sequence_id)
        except BaseException:
            processes.stop()
            raise
    return failures


def _may_help(error: BaseException) -> bool:
    return isinstance(error, AttemptError) and error.again


def _facts(recipe: Recipe) -> dict[str, Any]:
    """Return what ``dataset.json`` says of the whole dataset."""
    from whacamole.production.sequence import body_of

    body = body_of(recipe)
    return {
        "generator": "whacamole",
        "versions": {"whacamole": __version__, **{name: version(name) for name in ("bpy", "numpy", "scipy")}},
        "seed": recipe.seed,
        "recipe": recipe.save_as_dict(),
        "body_model": {"name": body.name, "sha256": body.sha256},
    }


def _check_recipe(layout: DatasetLayout, recipe: Recipe) -> None:
    """Refuse to mix two recipes in one dataset."""
    kept = layout.root / "recipe.json"
    if not kept.exists():
        if layout.root.exists() and any(layout.root.iterdir()):
            raise DatasetError(f"{layout.root}: holds other files and no dataset; choose an empty --out")
        return
    before, now = read_json(kept), recipe.save_as_dict()
    differing = [name for name in now if name not in MAY_DIFFER and before.get(name) != now[name]]
    if differing:
        changes = ", ".join(f"{name} {before.get(name)} is now {now[name]}" for name in differing)
        raise DatasetError(f"{layout.root}: was begun with another recipe ({changes}); choose another --out")


def _open_dataset(layout: DatasetLayout, recipe: Recipe) -> None:
    layout.sequences.mkdir(parents=True, exist_ok=True)
    layout.work.mkdir(exist_ok=True)
    write_json(layout.root / "recipe.json", recipe.save_as_dict())
