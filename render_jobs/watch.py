"""Watch a child process that reports in JSON lines: its crash, hang or hunger for memory ends it alone."""

from __future__ import annotations

import contextlib
import json
import queue
import signal
import subprocess
import threading
import time
from collections.abc import Callable, Sequence
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
) -> ChildEnd:
    """Run a command to its end. However this function is left, the child is gone.

    Args:
        command: what to run. It gets the means to import our packages, no terminal, and a session of its own,
            so that the terminal's Ctrl-C reaches only us.
        log: what the child writes to stderr is appended here.
        on_event: told every JSON object that the child prints; other lines are ignored.
        timeout: seconds without a line after which the child counts as hung.
        memory_limit_mb: resident memory that it may hold.

    Raises:
        WorkerError: the child hung or took too much memory, and was killed.
    """
    with log.open("ab") as errors:
        child = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=errors,
            env=child_environment(),
            start_new_session=True,
        )
    try:
        peak = _follow(child, log, on_event, timeout, memory_limit_mb)
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


def _follow(
    child: subprocess.Popen[bytes],
    log: Path,
    on_event: Callable[[Event], None],
    timeout: float | None,
    memory_limit_mb: float | None,
) -> float:
    """Pass on events until the child closes its stdout; return the peak memory in MB."""
    assert child.stdout is not None
    lines: queue.Queue[bytes | None] = queue.Queue()
    reader = threading.Thread(target=_read_lines, args=(child.stdout, lines), daemon=True)
    reader.start()
    heard = time.monotonic()
    peak = 0.0
    while True:
        used = _memory_mb(child.pid)
        peak = max(peak, used)
        if memory_limit_mb is not None and used > memory_limit_mb:
            limit = f"the limit of {memory_limit_mb:.0f} MB"
            raise WorkerError(f"the process was killed at {used:.0f} MB, over {limit} (log: {log})", log)
        try:
            line = lines.get(timeout=WATCH_INTERVAL_S)
        except queue.Empty:
            if timeout is not None and time.monotonic() - heard > timeout:
                reason = f"nothing was finished in {timeout:.0f} s, the process was killed"
                raise WorkerError(f"{reason} (log: {log})", log) from None
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
