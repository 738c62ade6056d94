"""Where Blender's time goes inside a frame, from what it prints while it renders.

Blender prints a line at every change of its status, with the time since the frame began; the denoiser names
itself, without a time. Both go to the job's log, which a thread reads as it grows.
"""

from __future__ import annotations

import re
import threading
import time
from pathlib import Path
from types import TracebackType
from typing import Self

from render_jobs.profile import DENOISING, LABELLING, SAMPLING, SYNCHRONISING, Profile

LOOK_S = 0.02

DENOISER_VERBOSITY = ("OIDN_VERBOSE", "1")
"""The environment variable, and the value from which on the denoiser names itself before it starts."""

_DENOISER = b"Intel(R) Open Image Denoise"
_STATUS = re.compile(rb"Fra:(-?\d+) .*?\| Time:([\d:.]+) \|.*\| [^|,]*, (\w+) \| (.*)")
_SAMPLE = re.compile(rb"Sample (\d+)/(\d+)")


class Phases:
    """Adds up what the lines say, as they come.

    Args:
        profile: where the seconds go.
        label_layer: the name of the view layer whose samples are counted as label rays.
    """

    def __init__(self, profile: Profile, label_layer: str) -> None:
        self._profile = profile
        self._label_layer = label_layer.encode()
        self._frame = b""
        self._time = 0.0
        self._phase = SYNCHRONISING
        self._zero = 0.0  # the clock's time at which the frame began

    def hear(self, line: bytes, clock: float) -> None:
        """Take in a line that was seen when the clock said ``clock`` [s]."""
        if line.startswith(_DENOISER):
            if self._phase == SAMPLING:
                self._until(max(self._time, clock - self._zero))
                self._phase = DENOISING
            return
        status = _STATUS.match(line)
        if status is None:
            return
        now = _seconds(status[2])
        if status[1] != self._frame:
            self._frame, self._time, self._phase, self._zero = status[1], 0.0, SYNCHRONISING, clock - now
        self._zero = min(self._zero, clock - now)  # the line that was seen with the least delay
        self._until(now)
        self._phase = self._phase_of(status[3], status[4])

    def _until(self, now: float) -> None:
        self._profile.add(self._phase, max(0.0, now - self._time))
        self._time = max(self._time, now)

    def _phase_of(self, layer: bytes, status: bytes) -> str:
        sample = _SAMPLE.match(status)
        if sample is None or sample[1] == sample[2]:
            return SYNCHRONISING
        return LABELLING if layer == self._label_layer else SAMPLING


def _seconds(text: bytes) -> float:
    """``MM:SS.ss`` or ``HH:MM:SS.ss`` in seconds."""
    total = 0.0
    for part in text.split(b":"):
        total = 60.0 * total + float(part)
    return total


class LogFollower:
    """A context in which a thread reads what is added to a log and tells it to :class:`Phases`."""

    def __init__(self, log: Path, phases: Phases) -> None:
        self._log, self._phases = log, phases
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._follow, name="profile", daemon=True)

    def __enter__(self) -> Self:
        self._start = self._log.stat().st_size if self._log.exists() else 0
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._over.set()
        self._thread.join()

    def _follow(self) -> None:
        if not self._log.exists():  # the job is rendered by hand, with its output elsewhere
            return
        with self._log.open("rb") as stream:
            stream.seek(self._start)
            rest = b""
            while True:
                last = self._over.wait(LOOK_S)
                *lines, rest = (rest + stream.read()).split(b"\n")
                for line in lines:
                    self._phases.hear(line, time.perf_counter())
                if last:
                    return
