"""Signs of life in the dataset's folder: what is being made, where, how fast, for any terminal to read."""

import contextlib
import json
import os
import socket
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Self

from whacamole.dataset.files import write_json
from whacamole.dataset.layout import DatasetLayout

__all__ = ["Heart", "Pulse", "RunRecord", "host_name", "live_runs", "pulses", "run_name"]

BEAT_S = 1.0
"""The file of a sequence in the making is written this often at most."""

RUN_BEAT_S = 5.0
RUN_DEAD_S = 60.0
"""A run whose record is older is taken for dead."""

PULSE = "progress.json"


def host_name() -> str:
    """Return the name of this machine without its domain."""
    return socket.gethostname().split(".")[0] or "localhost"


def run_name() -> str:
    """Return a name for the run that this process is."""
    return f"{host_name()}-{os.getpid()}"


@dataclass(frozen=True)
class Pulse:
    """What is being done for one sequence.

    Attributes:
        sequence_id: which.
        run: the run that asked for it.
        host, pid: the process that makes it.
        step: "scene", "plan", "render" or "label".
        done, frames: how many frames of the step, of how many; 0 frames where it is not known.
        beat: when this was written [s since 1970].
    """

    sequence_id: str
    run: str
    host: str
    pid: int
    step: str = ""
    done: int = 0
    frames: int = 0
    beat: float = 0.0

    @classmethod
    def read(cls, work: Path) -> Self | None:
        """Return the pulse in a work folder, None where there is none."""
        value = _read(work / PULSE)
        with contextlib.suppress(TypeError):
            return None if value is None else cls(**value)
        return None


class Heart:
    """Keeps the pulse of one sequence in its work folder, as events come."""

    def __init__(self, work: Path, sequence_id: str, run: str) -> None:
        self._file = work / PULSE
        self._pulse = Pulse(sequence_id, run, host_name(), os.getpid())

    def hear(self, event: str, facts: dict[str, Any]) -> None:
        """Take in one event of the worker."""
        now = time.time()
        if event == "step":
            done, frames = int(facts.get("done", 0)), int(facts.get("frames", 0))
            self._pulse = replace(self._pulse, step=facts["name"], done=done, frames=frames, beat=0.0)
        elif event in ("frame", "labelled"):
            self._pulse = replace(self._pulse, done=self._pulse.done + 1)
        if now - self._pulse.beat >= BEAT_S or self._pulse.done == self._pulse.frames:
            self._pulse = replace(self._pulse, beat=now)
            with contextlib.suppress(OSError):  # a full disk: the work itself will say so
                write_json(self._file, asdict(self._pulse))


def pulses(layout: DatasetLayout) -> Iterator[Pulse]:
    """Yield what is being made, or was when its process ended."""
    try:
        folders = sorted(entry.path for entry in os.scandir(layout.work) if entry.is_dir())
    except OSError:
        return
    for folder in folders:
        if (pulse := Pulse.read(Path(folder))) is not None:
            yield pulse


@dataclass(frozen=True)
class RunRecord:
    """One ``whacamole render`` at work.

    Attributes:
        name: host and process id.
        with_what: "4 jobs", "Dask at tcp://…", "shard 2/8, 1 job" and so on.
        began, beat: when it began, and when this was written [s since 1970].
        made: sequences it has made.
        frames_s: frames a second over all its workers.
        left_s: time left for its part of the work; None where it is not known yet.
        failed_attempts: attempts that failed so far.
    """

    name: str
    with_what: str
    began: float
    beat: float
    made: int = 0
    frames_s: float = 0.0
    left_s: float | None = None
    failed_attempts: int = 0

    def write(self, layout: DatasetLayout) -> None:
        """Write the record, if the disk lets us."""
        with contextlib.suppress(OSError):
            layout.runs.mkdir(parents=True, exist_ok=True)
            write_json(layout.runs / f"{self.name}.json", asdict(self))

    def remove(self, layout: DatasetLayout) -> None:
        """Remove it: the run has ended. Those of runs that were killed go with it."""
        with contextlib.suppress(OSError):
            (layout.runs / f"{self.name}.json").unlink(missing_ok=True)
            live = {run.name for run in live_runs(layout)}
            for file in layout.runs.glob("*.json"):
                if file.stem not in live:
                    file.unlink(missing_ok=True)
            layout.runs.rmdir()  # where it was the last one


def live_runs(layout: DatasetLayout) -> list[RunRecord]:
    """Return the runs that have given a sign of life in the last minute, oldest first."""
    found = []
    for file in layout.runs.glob("*.json"):
        value = _read(file)
        with contextlib.suppress(TypeError):
            if value is not None and time.time() - (record := RunRecord(**value)).beat < RUN_DEAD_S:
                found.append(record)
    return sorted(found, key=lambda record: record.began)


def _read(path: Path) -> dict[str, Any] | None:
    try:
        value = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):  # gone, or half there on a full disk
        return None
    return value if isinstance(value, dict) else None
