"""How a dataset is made, as opposed to what is in it: nothing here alters a label."""

import sys
from dataclasses import dataclass, field
from pathlib import Path
from typing import Self

from render_jobs.farm import DEFAULT_ATTEMPTS, DEFAULT_PAUSE_S
from whacamole.errors import RecipeError

__all__ = ["Limits", "Means", "Shard"]

WORKER = (sys.executable, "-m", "whacamole.production.worker")
"""What makes one sequence; the path of the order is added."""

SCHEMES = ("tcp", "tls", "ucx", "ws", "wss")
"""What a Dask scheduler's address may begin with."""


@dataclass(frozen=True)
class Shard:
    """One of ``count`` disjoint parts of the work; ``index`` counts from 1."""

    index: int
    count: int

    @classmethod
    def parse(cls, text: str) -> Self:
        """Read ``2/8``.

        Raises:
            RecipeError: it is no such thing.
        """
        index, slash, count = text.partition("/")
        if not (slash and index.strip().isdigit() and count.strip().isdigit()):
            raise RecipeError(f"shard {text!r} is not PART/PARTS, such as 2/8")
        shard = cls(int(index), int(count))
        if shard.count < 1:
            raise RecipeError(f"shard {text!r}: there is at least one part, 1/1")
        if not 1 <= shard.index <= shard.count:
            raise RecipeError(
                f"shard {text!r}: parts count from 1 to {shard.count}; with Slurm use --array=1-{shard.count}"
            )
        return shard

    def __str__(self) -> str:
        return f"{self.index}/{self.count}"


@dataclass(frozen=True)
class Limits:
    """What one attempt at one sequence may take. It travels to the machine where the attempt is made.

    Attributes:
        threads: processor threads; 0 is an even share of what the machine gives.
        device: "auto", "cpu" or "gpu".
        silence_s: seconds without a finished frame after which the attempt counts as hung.
        time_s: seconds it may take in all; None is no limit.
        memory_mb: resident memory that one process may hold; None is nine tenths of what the machine gives.
        disk_patience_s: how long to wait where the disk is full.
        worker: the command that makes one sequence; the path of its order is added.
        run: the run it belongs to, for the records.
    """

    threads: int = 0
    device: str = "auto"
    silence_s: float = 1800.0
    time_s: float | None = None
    memory_mb: float | None = None
    disk_patience_s: float = 600.0
    worker: tuple[str, ...] = WORKER
    run: str = ""


@dataclass(frozen=True)
class Means:
    """With what a run works.

    Attributes:
        jobs: sequences made at the same time on this machine; on a Slurm cluster, most workers at a time;
            None is what suits the machine.
        cluster: ``tcp://HOST:PORT`` of a Dask scheduler, ``slurm``, or None for this machine.
        cluster_config: YAML file on the cluster's jobs.
        shard: the part of the work this run does; None is all of it.
        attempts: how often a sequence is tried.
        limits: of each attempt.
        pause_s: before a sequence that could not be made is asked for again.
        check_disk: refuse to begin what the disk cannot hold.
    """

    jobs: int | None = None
    cluster: str | None = None
    cluster_config: Path | None = None
    shard: Shard | None = None
    attempts: int = DEFAULT_ATTEMPTS
    limits: Limits = field(default_factory=Limits)
    pause_s: float = DEFAULT_PAUSE_S
    check_disk: bool = True

    def __post_init__(self) -> None:
        """Refuse a cluster that is none."""
        scheme, colon, _ = str(self.cluster).partition("://")
        if self.cluster not in (None, "slurm") and not (colon and scheme in SCHEMES):
            raise RecipeError(
                f"cluster {self.cluster!r} is neither slurm nor an address such as tcp://host:8786"
            )
        if self.cluster_config is not None and self.cluster != "slurm":
            raise RecipeError(f"cluster-config {self.cluster_config}: it is for --cluster slurm alone")
