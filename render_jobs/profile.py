"""Where the time of a job goes: seconds by phase, measured in the process that spends them."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Final

STARTING: Final = "start Python"
IMPORTING: Final = "load the engine"
LOADING: Final = "read the job"
BUILDING: Final = "build the scene"
SYNCHRONISING: Final = "synchronise, BVH"
SAMPLING: Final = "samples"
DENOISING: Final = "denoise"
LABELLING: Final = "label rays"
DRAWING: Final = "draw"
WRITING: Final = "write raw frames"
WAITING: Final = "wait for encoder"
ENCODING: Final = "encode"

MEANWHILE: Final = frozenset({ENCODING})
"""Phases of a job that go on beside the others, so that they do not add to its wall time."""


class Profile:
    """Seconds by phase, in the order in which phases were first met. Safe to use from several threads."""

    def __init__(self) -> None:
        self._seconds: dict[str, float] = {}
        self._lock = threading.Lock()

    @contextmanager
    def phase(self, name: str) -> Iterator[None]:
        """Count the time spent inside as that phase, also where it ends in an error."""
        began = time.perf_counter()
        try:
            yield
        finally:
            self.add(name, time.perf_counter() - began)

    def add(self, name: str, seconds: float) -> None:
        """Count some time."""
        with self._lock:
            self._seconds[name] = self._seconds.get(name, 0.0) + seconds

    def merge(self, seconds: Mapping[str, float]) -> None:
        """Count the time of another process."""
        for name, value in seconds.items():
            self.add(name, value)

    @property
    def seconds(self) -> dict[str, float]:
        """What was counted so far."""
        with self._lock:
            return dict(self._seconds)


def since_start() -> float:
    """Seconds since this process was started: what the interpreter and its first imports took.

    0 where the system does not tell; Linux does, to a hundredth of a second.
    """
    try:
        fields = (
            Path("/proc/self/stat").read_text(encoding="ascii", errors="replace").rpartition(")")[2].split()
        )
        started = int(fields[19]) / os.sysconf("SC_CLK_TCK")
        return max(0.0, time.clock_gettime(time.CLOCK_BOOTTIME) - started)
    except (OSError, AttributeError, ValueError, IndexError):
        return 0.0
