"""Run a job in a child process, watch it, and say what became of it."""

from __future__ import annotations

import os
import shutil
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from render_jobs.devices import parse_device
from render_jobs.errors import EngineError, RenderJobError, WorkerError
from render_jobs.images import PARTIAL_FOLDER, is_complete
from render_jobs.profile import Profile
from render_jobs.protocol import BAD_JOB, ENGINES, LOG_FILE, NO_ENGINE
from render_jobs.remedies import known_failure
from render_jobs.standby import Standby
from render_jobs.storage import OUTPUT_FOLDER, JobRecord, read_record
from render_jobs.watch import ChildEnd, describe_end, follow_child, start_child

OnFrame = Callable[[int], None]


@dataclass(frozen=True)
class JobResult:
    """What became of a job.

    Attributes:
        frames: the number of frames that this call rendered; those already there are not counted.
        seconds: wall time of the call.
        frame_seconds: what each frame took in the renderer.
        frame_cpu_seconds: the same, as CPU time of all threads: steadier where other work shares the machine.
        devices: what rendered, for people to read; empty where nothing had to be rendered.
        peak_memory_mb: largest resident memory of the child that was seen.
        log: the job's log.
        profile: seconds by phase over all children (:mod:`render_jobs.profile`).
    """

    frames: int
    seconds: float
    frame_seconds: dict[int, float]
    frame_cpu_seconds: dict[int, float]
    devices: str
    peak_memory_mb: float
    log: Path
    profile: dict[str, float]


def run_job(
    folder: Path | str,
    *,
    engine: str = "cycles",
    device: str = "auto",
    threads: int = 0,
    timeout: float | None = 1800.0,
    memory_limit_mb: float | None = None,
    block: int = 200,
    on_frame: OnFrame | None = None,
    standby: Standby | None = None,
) -> JobResult:
    """Render what a job folder still lacks, in child processes.

    Args:
        folder: the job folder; no other process may be rendering it.
        engine: ``cycles``, ``raster`` or ``eevee``.
        device: ``auto``, ``cpu``, ``gpu`` or an interface as ``cuda:0``.
        threads: CPU threads of the child; 0 takes all cores.
        timeout: seconds without a finished frame after which the child counts as hung and is killed; None
            waits for ever.
        memory_limit_mb: resident memory at which the child is killed; None sets no limit.
        block: frames a child renders before a fresh one takes over, so that no leak of the renderer can grow.
        on_frame: told the number of each finished frame.
        standby: a child that has been started beforehand; it renders the first block.

    Returns:
        what was rendered and what it took.

    Raises:
        RenderJobError: the job is at fault; another try cannot help.
        EngineError: this machine cannot run the engine.
        WorkerError: the child crashed, hung or reported an error; finished frames stay.
    """
    folder = Path(folder)
    parse_device(device)
    if engine not in ENGINES:
        raise RenderJobError(f"engine {engine!r} is not one of {', '.join(ENGINES)}")
    record = read_record(folder)
    _clear_remains(folder)
    began = time.monotonic()
    log = folder / LOG_FILE
    progress = _Progress(on_frame)
    peak = 0.0
    for frames in _blocks(record, folder / OUTPUT_FOLDER, block):
        arguments = _arguments(folder, engine, device, threads, frames)
        log_start = log.stat().st_size if log.exists() else 0
        child = standby.put_to_work(arguments) if standby is not None and standby.engine == engine else None
        if child is None:
            child = start_child(_command(arguments), log)
        try:
            end = follow_child(child, log, progress.hear, timeout=timeout, memory_limit_mb=memory_limit_mb)
        finally:
            _clear_remains(folder)
        _judge(end, progress.error, log, log_start)
        peak = max(peak, end.peak_memory_mb)
    return JobResult(
        frames=len(progress.frame_seconds),
        seconds=time.monotonic() - began,
        frame_seconds=progress.frame_seconds,
        frame_cpu_seconds=progress.frame_cpu_seconds,
        devices=progress.devices,
        peak_memory_mb=peak,
        log=log,
        profile=progress.profile.seconds,
    )


def missing_frames(folder: Path | str) -> list[int]:
    """The frames of a job that are not complete.

    Raises:
        RenderJobError: ``job.json`` is missing or damaged.
    """
    folder = Path(folder)
    return _missing(read_record(folder), folder / OUTPUT_FOLDER)


def _missing(record: JobRecord, out: Path) -> list[int]:
    frames = range(record.num_frames)
    return [frame for frame in frames if not is_complete(out, frame, record.passes, record.image_format)]


def _blocks(record: JobRecord, out: Path, size: int) -> Iterator[range]:
    """Ranges of frames that hold at most ``size`` missing ones each."""
    missing = _missing(record, out)
    for start in range(0, len(missing), size):
        part = missing[start : start + size]
        yield range(part[0], part[-1] + 1)


def _arguments(folder: Path, engine: str, device: str, threads: int, frames: range) -> list[str]:
    options = {
        "--engine": engine,
        "--device": device,
        "--threads": str(threads),
        "--frames": f"{frames.start}:{frames.stop}",
    }
    return [str(folder), *(word for pair in options.items() for word in pair)]


def _command(arguments: Sequence[str]) -> list[str]:
    parent = ["--parent", str(os.getpid())]
    return [sys.executable, "-X", "faulthandler", "-m", "render_jobs.worker", *arguments, *parent]


def _clear_remains(folder: Path) -> None:
    """Remove what killed processes left behind."""
    for path in folder.glob("scratch-*"):
        shutil.rmtree(path, ignore_errors=True)
    shutil.rmtree(folder / OUTPUT_FOLDER / PARTIAL_FOLDER, ignore_errors=True)


class _Progress:
    """What the children of one job have said so far."""

    def __init__(self, on_frame: OnFrame | None) -> None:
        self.frame_seconds: dict[int, float] = {}
        self.frame_cpu_seconds: dict[int, float] = {}
        self.devices = ""
        self.error = ""
        self.profile = Profile()
        self._on_frame = on_frame

    def hear(self, event: dict[str, Any]) -> None:
        """Take in one event of :mod:`render_jobs.worker`."""
        match event["event"]:
            case "start":
                self.devices = event["devices"]
            case "frame":
                self.frame_seconds[event["frame"]] = event["seconds"]
                self.frame_cpu_seconds[event["frame"]] = event["cpu_seconds"]
                if self._on_frame is not None:
                    self._on_frame(event["frame"])
            case "profile":
                self.profile.merge(event["seconds"])
            case "error":
                self.error = event["message"]


def _judge(end: ChildEnd, error: str, log: Path, log_start: int) -> None:
    """Raise what the end of a worker means, or return if all is well.

    Args:
        error: what it said itself, if anything.
        log_start: where in the log its own output begins.
    """
    if end.status == 0:
        return
    if end.status == NO_ENGINE:
        raise EngineError(error)
    if end.status == BAD_JOB and error:
        raise RenderJobError(error)
    if end.status < 0:  # Blender's OpenGL engines end the process where a library or a driver is missing
        with log.open("rb") as stream:
            stream.seek(log_start)
            known = known_failure(stream.read().decode(errors="replace"))
        if known is not None:
            raise EngineError(f"the engine cannot run here ({known[0]}): {known[1]} (log: {log})")
    raise WorkerError(f"{error or describe_end(end)} (log: {log})", log)
