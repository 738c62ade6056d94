"""Making all sequences of a recipe, some at a time, each in a process of its own, here or on a cluster."""

import contextlib
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import Any

from render_jobs.clusters import Crew, dask_crew, local_crew, read_slurm_config, slurm_crew
from render_jobs.errors import PostponedError
from render_jobs.farm import run_farm
from render_jobs.machine import best_jobs, usable_cores, usable_memory_mb, visible_gpus
from whacamole import __version__
from whacamole.dataset import DatasetLayout, open_dataset, write_index
from whacamole.dataset.card import write_card
from whacamole.dataset.files import write_json
from whacamole.dataset.splitting import refresh_splits
from whacamole.dataset.statistics import collect
from whacamole.errors import DatasetError
from whacamole.production.attempt import DISK_FULL, AttemptError, attempt
from whacamole.production.locations import forget_places, missing_places, read_places
from whacamole.production.means import Limits, Means
from whacamole.production.opening import EngineSearch, check_folder, index_lock, open_dataset_for
from whacamole.production.progress import Monitor
from whacamole.production.pulse import RunRecord, run_name
from whacamole.production.report import Production
from whacamole.production.space import check_disk
from whacamole.production.worklist import SequenceOrder, Worklist, failure_note, work_of
from whacamole.recipe import Recipe
from whacamole.viewing.page import write_page

__all__ = ["Production", "produce"]

Work = Callable[[SequenceOrder], bool]


def produce(
    recipe: Recipe,
    out: Path,
    means: Means | None = None,
    *,
    dry_run: bool = False,
    quiet: bool = False,
    search: EngineSearch | None = None,
) -> Production:
    """Make, or finish, the dataset of ``recipe`` in the folder ``out``.

    Args:
        means: with what; none: this machine, as suits it.
        dry_run: only say what would be made.
        quiet: show no progress.
        search: for the engine, where it has begun already.

    Raises:
        MotionError: there is no motion to film.
        RecipeError, BodyModelError: the recipe cannot be carried out.
        DatasetError: ``out`` holds a dataset of another recipe or something else, or the disk is full.
        EngineError: nothing renders here, or the cluster cannot be reached.
    """
    means = means or Means()
    layout = DatasetLayout(out.resolve())
    check_folder(recipe, layout)
    facts_of_dataset = _facts(recipe)
    worklist = _worklist(recipe, layout, means)
    nothing_usable = bool(worklist.refused) and not worklist.orders and means.shard is None
    if dry_run or nothing_usable:
        return Production(layout.root, worklist, {}, 0.0, {}, dry_run=True, problems=missing_places(recipe))
    search = search or EngineSearch(recipe, layout)
    if means.check_disk:
        check_disk(worklist.open, means.jobs or 1, layout.root)
    settled = search.settled(quiet=quiet)
    try:
        places = read_places(settled, layout, quiet=quiet)
        settled = open_dataset_for(settled, layout, engine_is_ours=recipe.engine == "auto")
        worklist = _worklist(settled, layout, means)
        started = time.monotonic()
        failures = _make_all(worklist, layout, means, quiet)
        with index_lock(layout):
            write_index(layout, {**facts_of_dataset, "recipe": settled.save_as_dict()})
            sides = refresh_splits(layout, settled.test_fraction)  # companions counted
            if layout.finished():
                numbers = collect(open_dataset(layout.root))
                write_card(layout, numbers)
                write_page(layout, numbers)
    except OSError as error:
        if error.errno not in DISK_FULL:
            raise
        raise DatasetError(f"{layout.root}: the disk is full; make room, the same command goes on") from error
    finished = _worklist(settled, layout, means)
    seconds = time.monotonic() - started
    kept = len(worklist.orders) - len(worklist.open)
    forget_places(settled, layout)
    return Production(layout.root, finished, failures, seconds, sides, kept=kept, problems=places.problems)


def _worklist(recipe: Recipe, layout: DatasetLayout, means: Means) -> Worklist:
    whole = work_of(recipe, layout.root)
    return whole.part(means.shard.index, means.shard.count) if means.shard else whole


def _make_all(worklist: Worklist, layout: DatasetLayout, means: Means, quiet: bool) -> dict[str, str]:
    """Make the open orders; return the one-line error of each that failed."""
    orders = worklist.open
    if not orders:
        return {}
    failures: dict[str, str] = {}
    run = run_name()
    with _crew(means, len(orders), layout) as (crew, limits), _work(crew, replace(limits, run=run)) as work:
        record = RunRecord(run, _described(crew, means), time.time(), time.time())
        lengths = {order.sequence_id: order.frames for order in orders}
        with Monitor(layout, record, lengths, len(worklist.orders) - len(orders), quiet=quiet) as monitor:
            farm = run_farm(
                crew.executor, work, orders,
                in_flight=min(crew.in_flight, len(orders)), attempts=means.attempts, retry=_may_help,
                pause=means.pause_s,
            )  # fmt: skip
            for outcome in farm:
                name, error = outcome.task.sequence_id, outcome.error
                if error is None:
                    monitor.made(name, here=bool(outcome.result))
                elif isinstance(error, PostponedError) and not outcome.final:
                    monitor.postponed(str(error))
                else:
                    monitor.failed(name, final=outcome.final)
                if error is not None and outcome.final:
                    failures[name] = _one_line(name, error)
                    _note_failure(outcome.task, failures[name])
    return failures


@contextlib.contextmanager
def _crew(means: Means, orders: int, layout: DatasetLayout) -> Iterator[tuple[Crew, Limits]]:
    """Who does the work, and with what limits on each attempt."""
    limits = means.limits
    if means.cluster is None:
        gpus = () if limits.device == "cpu" else visible_gpus()
        jobs = min(means.jobs or best_jobs(usable_cores(), usable_memory_mb(), len(gpus)), orders)
        threads = limits.threads or max(1, usable_cores() // jobs)
        with local_crew(jobs) as crew:
            yield crew, replace(limits, threads=threads)
    elif means.cluster == "slurm":
        config = read_slurm_config(means.cluster_config)
        if means.jobs is not None:
            config = config.model_copy(update={"workers": means.jobs})
        threads = limits.threads or config.cores
        with slurm_crew(config, layout.logs / "slurm") as crew:
            yield crew, replace(limits, threads=threads)
    else:
        with dask_crew(means.cluster) as crew:
            yield crew, limits


@contextlib.contextmanager
def _work(crew: Crew, limits: Limits) -> Iterator[Work]:
    """What the crew does with an order. Left early, the children that run here end."""
    if crew.picklable:
        yield partial(attempt, limits=limits)
        return
    stop = threading.Event()
    try:
        yield partial(attempt, limits=limits, stop=stop)
    except BaseException:
        stop.set()
        raise


def _described(crew: Crew, means: Means) -> str:
    return f"{crew.name}, part {means.shard}" if means.shard else crew.name


def _may_help(error: BaseException) -> bool:
    """Whether an attempt may be made again: not where the input is at fault; yes where a worker was lost."""
    return error.again if isinstance(error, AttemptError) else not isinstance(error, PostponedError)


def _one_line(name: str, error: BaseException) -> str:
    text = " ".join(str(error).split()) or type(error).__name__
    if isinstance(error, ModuleNotFoundError):
        text += "; the cluster's workers need the packages that this environment has"
    return text if name in text else f"{name}: {text}"


def _note_failure(order: SequenceOrder, error: str) -> None:
    with contextlib.suppress(OSError):  # a full disk must not end the run
        failure_note(order).parent.mkdir(parents=True, exist_ok=True)
        write_json(failure_note(order), {"error": error})


def _facts(recipe: Recipe) -> dict[str, Any]:
    """Return what ``dataset.json`` says of the whole dataset beside the recipe."""
    from whacamole.labels import read_regions
    from whacamole.production.bodies import body_of
    from whacamole.wardrobe.shells import checked_textures

    body = body_of(recipe)
    if recipe.textures is not None:
        checked_textures(body, recipe.textures)  # before hours of work, not in them
    if recipe.contact_regions is not None:
        read_regions(recipe.contact_regions, body.num_vertices)
    return {
        "generator": "whacamole",
        "versions": {"whacamole": __version__, **{name: version(name) for name in ("bpy", "numpy", "scipy")}},
        "seed": recipe.seed,
        "body_model": {"name": body.name, "sha256": body.sha256},
    }
