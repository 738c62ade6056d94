"""Labelling frames while later ones render: the renderer is a process of its own, this is a thread here."""

import threading
import time
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TypeVar

from render_jobs import missing_frames
from render_jobs.profile import Profile

__all__ = ["FrameGate", "beside"]

LABELLING = "labels"
LABELS_LEFT = "labels after the last frame"

Rendered = TypeVar("Rendered")
Labelled = TypeVar("Labelled")


class _AbandonedError(Exception):
    """The frame that somebody waits for will not come."""


class FrameGate:
    """Lets one thread wait for frames that another one reports."""

    def __init__(self, missing: Iterable[int]) -> None:
        self._missing = set(missing)
        self._closed = False
        self._changed = threading.Condition()
        self.waited = 0.0
        """Seconds spent in :meth:`wait`."""

    def open(self, frame: int) -> None:
        """The frame is there."""
        with self._changed:
            self._missing.discard(frame)
            self._changed.notify_all()

    def close(self) -> None:
        """What is missing now will not come."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()

    def wait(self, frame: int) -> None:
        """Return when the frame is there.

        Raises:
            Exception: the gate was closed without it.
        """
        began = time.perf_counter()
        with self._changed:
            self._changed.wait_for(lambda: self._closed or frame not in self._missing)
            self.waited += time.perf_counter() - began
            if frame in self._missing:
                raise _AbandonedError(f"frame {frame} was not rendered")


def beside(
    job: Path,
    render: Callable[[Callable[[int], None]], Rendered],
    label: Callable[[Callable[[int], None], Callable[[int], None]], Labelled],
    say: Callable[..., None],
    frames: int,
    profile: Profile,
) -> tuple[Rendered, Labelled]:
    """Render a job, and label each frame as soon as it is there; return what the two return.

    Args:
        job: the job folder.
        render: renders what is missing; it is given what to call with the number of each frame that is there.
        label: labels all frames in order; it is given what to call before it reads a frame, which waits until
            that is there, and what to call after each frame.
        say: told of every frame rendered, and of labelling where that takes longer.
        frames: of the job.
        profile: gets the seconds of labelling, and those by which it came after the last frame.

    Raises:
        whatever ``render`` raises, or else ``label``.
    """
    gate = FrameGate(missing_frames(job))
    told = _Told(say)

    def rendered(frame: int) -> None:
        gate.open(frame)
        say("frame", index=frame)

    def work() -> Labelled:
        began = time.perf_counter()
        try:
            return label(gate.wait, told.labelled)
        finally:
            profile.add(LABELLING, time.perf_counter() - began - gate.waited)

    with ThreadPoolExecutor(1, "labels") as pool:
        labels = pool.submit(work)
        try:
            result = render(rendered)
        finally:
            gate.close()
        with profile.phase(LABELS_LEFT):
            told.begin(frames)
            return result, labels.result()


class _Told:
    """Says how far labelling is, once nothing renders any more: one bar shows one thing at a time."""

    def __init__(self, say: Callable[..., None]) -> None:
        self._say = say
        self._lock = threading.Lock()
        self._done = 0
        self._aloud = False

    def labelled(self, frame: int) -> None:
        with self._lock:
            self._done += 1
            if self._aloud:
                self._say("labelled", index=frame)

    def begin(self, frames: int) -> None:
        with self._lock:
            self._aloud = True
            self._say("step", name="label", frames=frames, done=self._done)
