"""Where the work of a farm is done: threads of this process, a Dask cluster, or Slurm through Dask.

Each is a context manager that gives a :class:`Crew`: an executor of ``concurrent.futures`` for
:func:`render_jobs.farm.run_farm`. Dask is imported when it is asked for.
"""

from __future__ import annotations

import contextlib
import importlib
import logging
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import Executor, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from render_jobs.errors import EngineError, RenderJobError

CONNECT_S = 30.0
SBATCH_S = 60.0
IN_FLIGHT = 1000
"""Tasks given to a Dask scheduler at a time: enough for it to see how many workers it needs."""


@dataclass(frozen=True)
class Crew:
    """Who does the work.

    Attributes:
        executor: takes tasks.
        in_flight: how many to hand over at a time.
        name: for people to read.
        picklable: whether tasks leave this process.
    """

    executor: Executor
    in_flight: int
    name: str
    picklable: bool


class SlurmConfig(BaseModel):
    """What a Slurm job that runs one worker asks for; the small file behind ``--cluster slurm``."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    partition: str | None = None
    account: str | None = None
    workers: Annotated[int, Field(ge=1)] = 8
    """Most jobs at a time."""
    cores: Annotated[int, Field(ge=1)] = 4
    memory: str = "8GB"
    walltime: str = "04:00:00"
    gpus: Annotated[int, Field(ge=0)] = 0
    """Graphics processors a job: one job works on one sequence at a time, so 1 is enough."""
    directives: tuple[str, ...] = ()
    """Further lines for ``#SBATCH``, such as ``--constraint=avx512``."""
    prologue: tuple[str, ...] = ()
    """Shell lines before the worker starts, such as ``source /shared/venv/bin/activate``."""
    python: str | None = None
    """Interpreter on the nodes; none: the path of this one."""
    interface: str | None = None
    """Network interface that nodes reach each other by, such as ``ib0``."""
    local_directory: str | None = None
    """Fast disk of a node for what Dask writes."""


@contextlib.contextmanager
def local_crew(jobs: int) -> Iterator[Crew]:
    """Threads that each watch one child at a time."""
    with ThreadPoolExecutor(jobs, thread_name_prefix="job") as pool:
        yield Crew(pool, jobs, f"{jobs} job{'s' if jobs > 1 else ''}", picklable=False)


@contextlib.contextmanager
def dask_crew(address: str) -> Iterator[Crew]:
    """The workers of a Dask scheduler that somebody else has started.

    Raises:
        EngineError: Dask is not installed, nobody answers at the address, or does no longer.
    """
    distributed = _imported("distributed")
    try:
        client = distributed.Client(address, timeout=CONNECT_S, set_as_default=False)
    except (OSError, ValueError) as error:
        raise EngineError(
            f"cluster {address}: no Dask scheduler answers ({_short(error)}); start one with `dask scheduler`"
        ) from error
    with client:
        try:
            yield _crew_of(client, f"Dask at {address}")
        except Exception as error:
            if client.status not in ("closed", "closing"):
                raise
            raise EngineError(
                f"cluster {address}: the scheduler is gone; finished work is kept, the same command goes on"
            ) from error


@contextlib.contextmanager
def slurm_crew(config: SlurmConfig, log_folder: Path) -> Iterator[Crew]:
    """Workers in Slurm jobs, as many as there is work for, up to ``config.workers``.

    The jobs are cancelled at the end; one that runs into its wall time or is pre-empted is replaced, and what
    it was at goes on elsewhere.

    Raises:
        EngineError: Dask is not installed, there is no ``sbatch`` here, or it refuses such jobs.
    """
    jobqueue, distributed = _imported("dask_jobqueue"), _imported("distributed")
    if shutil.which("sbatch") is None:
        raise EngineError(
            "cluster slurm: sbatch is not found; run this on a login node, or use --shard in a job array"
        )
    log_folder.mkdir(parents=True, exist_ok=True)
    with jobqueue.SLURMCluster(
        **slurm_options(config, log_folder), scheduler_options={"dashboard_address": ":0"}
    ) as cluster:
        _check_slurm_takes(cluster.job_script())
        cluster.adapt(minimum_jobs=0, maximum_jobs=config.workers)
        with distributed.Client(cluster, set_as_default=False) as client:
            yield _crew_of(client, f"Slurm, up to {config.workers} jobs of {config.cores} cores")


def _check_slurm_takes(script: str) -> None:
    """Ask Slurm whether it would take a job; none is submitted.

    Without this, jobs that are refused (no such partition, no account, no controller) are tried without end.
    """
    try:
        asked = subprocess.run(
            ["sbatch", "--test-only"], input=script, capture_output=True, text=True, timeout=SBATCH_S,
            check=False,
        )  # fmt: skip
    except subprocess.TimeoutExpired as error:
        raise EngineError(
            f"cluster slurm: sbatch did not answer within {SBATCH_S:.0f} s; try it later"
        ) from error
    if asked.returncode != 0:
        reason = " ".join((asked.stderr or asked.stdout).split())
        raise EngineError(
            f"cluster slurm: sbatch would refuse the jobs ({reason}); mend --cluster-config, "
            "or see `sinfo` and `scontrol ping`"
        )


def slurm_options(config: SlurmConfig, log_folder: Path) -> dict[str, Any]:
    """The arguments of ``dask_jobqueue.SLURMCluster`` that ``config`` stands for.

    A worker has one thread, for one sequence at a time; the job's cores are for the renderer.
    """
    gpus = (f"--gres=gpu:{config.gpus}",) if config.gpus else ()
    return {
        "queue": config.partition,
        "account": config.account,
        "cores": 1,
        "processes": 1,
        "job_cpu": config.cores,
        "memory": config.memory,
        "walltime": config.walltime,
        "job_name": "whacamole",
        "job_extra_directives": [*gpus, *config.directives],
        "job_script_prologue": list(config.prologue),
        "python": config.python or sys.executable,
        "interface": config.interface,
        "local_directory": config.local_directory,
        "log_directory": str(log_folder),
        # Dask's own watch over memory sees the worker alone, not the renderer beside it; ours sees that.
        "worker_extra_args": ["--memory-limit", "0"],
    }


def read_slurm_config(path: Path | None) -> SlurmConfig:
    """Read the file, or give the defaults where there is none.

    Raises:
        RenderJobError: it cannot be read, or says something impossible; one line.
    """
    if path is None:
        return SlurmConfig()
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
        return SlurmConfig.model_validate(values or {})
    except ValidationError as error:
        fault = error.errors()[0]
        name = ".".join(str(part) for part in fault["loc"])
        known = ", ".join(SlurmConfig.model_fields)
        raise RenderJobError(f"{path}: {name}: {fault['msg']}; there are {known}") from error
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise RenderJobError(f"{path}: not a readable cluster file ({_short(error)})") from error


def slots_here() -> int:
    """How many tasks the worker that runs this may run at once: 1 outside a Dask worker."""
    distributed = sys.modules.get("distributed")
    if distributed is None:
        return 1
    try:
        return int(distributed.get_worker().state.nthreads)
    except ValueError:  # not in a task
        return 1


def _crew_of(client: Any, name: str) -> Crew:
    # The scheduler runs a task again whose worker died; `retries` stays 0: the farm counts failures.
    return Crew(client.get_executor(pure=False), IN_FLIGHT, name, picklable=True)


def _imported(name: str) -> Any:
    try:
        module = importlib.import_module(name)
    except ImportError as error:
        raise EngineError(
            f"--cluster needs Dask ({_short(error)}); install it: pip install 'whacamole[cluster]'"
        ) from error
    logging.getLogger("distributed").setLevel(os.environ.get("DASK_LOGGING", "ERROR"))
    return module


def _short(error: BaseException) -> str:
    return " ".join(str(error).split()) or type(error).__name__
