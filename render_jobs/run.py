"""Run a job in a child process, watch it, and say what became of it."""

from __future__ import annotations

import contextlib
import json
import os
import queue
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import psutil

from render_jobs.devices import parse_device
from render_jobs.errors import EngineError, RenderJobError, WorkerError
from render_jobs.images import PARTIAL_FOLDER, is_complete
from render_jobs.processes import child_environment
from render_jobs.storage import OUTPUT_FOLDER, JobRecord, read_record
from render_jobs.worker import BAD_JOB, LOG_FILE, NO_ENGINE

WATCH_INTERVAL_S = 0.5
MEGABYTE = 1024**2

OnFrame = Callable[[int], None]


@dataclass(frozen=True)
class JobResult:
    """What became of a job.

    Attributes:
        frames: the number of frames that this call rendered; those already there are not counted.
        seconds: wall time of the call.
        frame_seconds: what each frame took in the renderer.
        devices: what rendered, for people to read; empty where nothing had to be rendered.
        peak_memory_mb: largest resident memory of the child that was seen.
        log: the job's log.
    """

    frames: int
    seconds: float
    frame_seconds: dict[int, float]
    devices: str
    peak_memory_mb: float
    log: Path


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
) -> JobResult:
    """Render what a job folder still lacks, in child processes.

    Args:
        folder: the job folder; no other process may be rendering it.
        engine: ``cycles``.
        device: ``auto``, ``cpu``, ``gpu`` or an interface as ``cuda:0``.
        threads: CPU threads of the child; 0 takes all cores.
        timeout: seconds without a finished frame after which the child counts as hung and is killed; None
            waits for ever.
        memory_limit_mb: resident memory at which the child is killed; None sets no limit.
        block: frames a child renders before a fresh one takes over, so that no leak of the renderer can grow.
        on_frame: told the number of each finished frame.

    Returns:
        what was rendered and what it took.

    Raises:
        RenderJobError: the job is at fault; another try cannot help.
        EngineError: this machine cannot run the engine.
        WorkerError: the child crashed, hung or reported an error; finished frames stay.
    """
    folder = Path(folder)
    parse_device(device)
    record = read_record(folder)
    _clear_remains(folder)
    began = time.monotonic()
    watch = _Watch(folder, timeout, memory_limit_mb, on_frame)
    for frames in _blocks(record, folder / OUTPUT_FOLDER, block):
        watch.run(_command(folder, engine, device, threads, frames))
    return JobResult(
        frames=len(watch.frame_seconds),
        seconds=time.monotonic() - began,
        frame_seconds=watch.frame_seconds,
        devices=watch.devices,
        peak_memory_mb=watch.peak_memory_mb,
        log=watch.log,
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


def _command(folder: Path, engine: str, device: str, threads: int, frames: range) -> list[str]:
    options = {
        "--engine": engine,
        "--device": device,
        "--threads": str(threads),
        "--frames": f"{frames.start}:{frames.stop}",
        "--parent": str(os.getpid()),
    }
    pairs = [word for pair in options.items() for word in pair]
    return [sys.executable, "-X", "faulthandler", "-m", "render_jobs.worker", str(folder), *pairs]


def _clear_remains(folder: Path) -> None:
    """Remove what killed processes left behind."""
    for path in folder.glob("scratch-*"):
        shutil.rmtree(path, ignore_errors=True)
    shutil.rmtree(folder / OUTPUT_FOLDER / PARTIAL_FOLDER, ignore_errors=True)


class _Watch:
    """Runs children for one job and keeps what they say."""

    def __init__(
        self, folder: Path, timeout: float | None, memory_limit_mb: float | None, on_frame: OnFrame | None
    ) -> None:
        self.log = folder / LOG_FILE
        self.frame_seconds: dict[int, float] = {}
        self.devices = ""
        self.peak_memory_mb = 0.0
        self._folder = folder
        self._timeout = timeout
        self._memory_limit_mb = memory_limit_mb
        self._on_frame = on_frame
        self._error = ""

    def run(self, command: list[str]) -> None:
        """Run one child to its end. Raises as :func:`run_job` does."""
        self._error = ""
        with self.log.open("ab") as log:
            child = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=log,
                env=child_environment(),
                start_new_session=True,  # the terminal's Ctrl-C reaches only us; we end the child
            )
        try:
            self._follow(child)
        finally:
            child.kill()
            child.wait()
            _clear_remains(self._folder)
        self._judge(child.returncode)

    def _follow(self, child: subprocess.Popen[bytes]) -> None:
        assert child.stdout is not None
        lines: queue.Queue[bytes | None] = queue.Queue()
        threading.Thread(target=_read_lines, args=(child.stdout, lines), daemon=True).start()
        heard = time.monotonic()
        while True:
            self._check_memory(child.pid)
            try:
                line = lines.get(timeout=WATCH_INTERVAL_S)
            except queue.Empty:
                if self._timeout is not None and time.monotonic() - heard > self._timeout:
                    reason = f"no frame was finished in {self._timeout:.0f} s, the process was killed"
                    raise self._failure(reason) from None
                continue
            if line is None:
                child.wait()
                return
            heard = time.monotonic()
            self._hear(json.loads(line))

    def _hear(self, event: dict[str, Any]) -> None:
        match event["event"]:
            case "start":
                self.devices = event["devices"]
            case "frame":
                self.frame_seconds[event["frame"]] = event["seconds"]
                if self._on_frame is not None:
                    self._on_frame(event["frame"])
            case "error":
                self._error = event["message"]

    def _check_memory(self, pid: int) -> None:
        with contextlib.suppress(psutil.Error):
            used = psutil.Process(pid).memory_info().rss / MEGABYTE
            self.peak_memory_mb = max(self.peak_memory_mb, used)
            if self._memory_limit_mb is not None and used > self._memory_limit_mb:
                limit = f"the limit of {self._memory_limit_mb:.0f} MB"
                raise self._failure(f"the process was killed at {used:.0f} MB, over {limit}")

    def _judge(self, code: int) -> None:
        if code == 0:
            return
        if code == NO_ENGINE:
            raise EngineError(self._error)
        if code == BAD_JOB and self._error:
            raise RenderJobError(self._error)
        if code < 0:
            hint = ": was memory short?" if code == -signal.SIGKILL else ""
            raise self._failure(f"the process was ended by {signal.Signals(-code).name}{hint}")
        raise self._failure(self._error or f"the process ended with status {code}")

    def _failure(self, reason: str) -> WorkerError:
        return WorkerError(f"{self._folder.name}: {reason} (log: {self.log})", self.log)


def _read_lines(stream: IO[bytes], lines: queue.Queue[bytes | None]) -> None:
    for line in stream:
        lines.put(line)
    lines.put(None)
