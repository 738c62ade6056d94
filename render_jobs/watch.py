"""Watch a child process that reports in JSON lines: its crash, hang or hunger for memory ends it alone."""

from __future__ import annotations

import contextlib
import json
import queue
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

import psutil

from render_jobs.errors import WorkerError
from render_jobs.processes import child_environment

WATCH_INTERVAL_S = 0.5
MEGABYTE = 1024**2

Event = dict[str, Any]


@dataclass(frozen=True)
class ChildEnd:
    """How a child ended: its exit status (negative for a signal) and the most memory it was seen to hold."""

    status: int
    peak_memory_mb: float


def watch_child(
    command: Sequence[str],
    log: Path,
    on_event: Callable[[Event], None],
    *,
    timeout: float | None,
    memory_limit_mb: float | None,
    time_limit: float | None = None,
    environment: Mapping[str, str] | None = None,
    stop: threading.Event | None = None,
) -> ChildEnd:
    """Run a command to its end. However this function is left, the child is gone.

    Args:
        command: what to run, as :func:`start_child` runs it.
        log: what the child writes to stderr is appended here.
        on_event: told every JSON object that the child prints; other lines are ignored.
        timeout: seconds without a line after which the child counts as hung.
        memory_limit_mb: resident memory that it may hold.
        time_limit: seconds that it may take in all.
        environment: variables for it alone, over our own.
        stop: ends the child when it is set.

    Raises:
        WorkerError: the child hung, took too long or too much memory, or was to stop; it was killed.
    """
    child = start_child(command, log, environment=environment)
    return follow_child(
        child,
        log,
        on_event,
        timeout=timeout,
        memory_limit_mb=memory_limit_mb,
        time_limit=time_limit,
        stop=stop,
    )


def start_child(
    command: Sequence[str], log: Path, *, environment: Mapping[str, str] | None = None, asked: bool = False
) -> subprocess.Popen[bytes]:
    """Start a command that :func:`follow_child` can follow; the caller sees to its end.

    It gets the means to import our packages, no terminal, and a session of its own, so that the terminal's
    Ctrl-C reaches only us.

    Args:
        asked: give it a pipe as stdin, over which it is told what to do.
    """
    with log.open("ab") as errors:
        return subprocess.Popen(
            command,
            stdin=subprocess.PIPE if asked else subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=errors,
            env=child_environment() | dict(environment or {}),
            start_new_session=True,
        )


def follow_child(
    child: subprocess.Popen[bytes],
    log: Path,
    on_event: Callable[[Event], None],
    *,
    timeout: float | None,
    memory_limit_mb: float | None,
    time_limit: float | None = None,
    stop: threading.Event | None = None,
) -> ChildEnd:
    """Watch a child that :func:`start_child` started, to its end; arguments and errors of `watch_child`."""
    limits = _Limits(timeout, time_limit, memory_limit_mb, stop)
    try:
        peak = _follow(child, log, on_event, limits)
        return ChildEnd(child.wait(), peak)
    finally:
        child.kill()
        child.wait()


def describe_end(end: ChildEnd) -> str:
    """Why a child that did not end well ended, in words."""
    if end.status >= 0:
        return f"the process ended with status {end.status}"
    hint = ": was memory short?" if end.status == -signal.SIGKILL else ""
    return f"the process was ended by {signal.Signals(-end.status).name}{hint}"


@dataclass(frozen=True)
class _Limits:
    silence: float | None
    time: float | None
    memory_mb: float | None
    stop: threading.Event | None

    def breach(self, silent: float, spent: float, used_mb: float) -> str:
        """What a child has overstepped, in words; empty where all is well."""
        if self.stop is not None and self.stop.is_set():
            return "it was stopped"
        if self.memory_mb is not None and used_mb > self.memory_mb:
            return f"the process was killed at {used_mb:.0f} MB, over the limit of {self.memory_mb:.0f} MB"
        if self.silence is not None and silent > self.silence:
            return f"nothing was finished in {self.silence:.0f} s, the process was killed"
        if self.time is not None and spent > self.time:
            return f"it took longer than the limit of {self.time:.0f} s, the process was killed"
        return ""


def _follow(
    child: subprocess.Popen[bytes], log: Path, on_event: Callable[[Event], None], limits: _Limits
) -> float:
    """Pass on events until the child closes its stdout; return the peak memory in MB."""
    assert child.stdout is not None
    lines: queue.Queue[bytes | None] = queue.Queue()
    reader = threading.Thread(target=_read_lines, args=(child.stdout, lines), daemon=True)
    reader.start()
    began = heard = time.monotonic()
    peak = 0.0
    while True:
        used = _memory_mb(child.pid)
        peak = max(peak, used)
        now = time.monotonic()
        if breach := limits.breach(now - heard, now - began, used):
            raise WorkerError(f"{breach} (log: {log})", log)
        try:
            line = lines.get(timeout=WATCH_INTERVAL_S)
        except queue.Empty:
            continue
        if line is None:
            reader.join()
            return peak
        heard = time.monotonic()
        with contextlib.suppress(json.JSONDecodeError):
            event = json.loads(line)
            if isinstance(event, dict):
                on_event(event)


def _memory_mb(pid: int) -> float:
    try:
        return float(psutil.Process(pid).memory_info().rss) / MEGABYTE
    except psutil.Error:  # it has just ended
        return 0.0


def _read_lines(stream: IO[bytes], lines: queue.Queue[bytes | None]) -> None:
    with stream:
        for line in stream:
            lines.put(line)
    lines.put(None)
