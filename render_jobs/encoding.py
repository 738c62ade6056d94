"""Putting finished frames in place in a thread of its own, while the engine renders the next one."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import NoReturn, Self

from render_jobs.images import Writer, publish_frame
from render_jobs.profile import ENCODING, WAITING, Profile

FRAMES_WAITING = 3
"""Frames that may wait to be encoded: a slow disk slows the engine down and does not fill memory and disk."""

OnFrame = Callable[[int, float, float], None]
"""Told of each frame that is in its place: number, seconds, CPU seconds of all threads."""


@dataclass
class Encoder:
    """Encodes and publishes frames; use it as a context, which ends when all are in place.

    Attributes:
        out: the output folder.
        image_format: of the rgb files.
        on_frame: told of each frame in its place.
        abort: ends the process on an error, which in another thread nobody would see.
        profile: where the time goes.
    """

    out: Path
    image_format: str
    on_frame: OnFrame
    abort: Callable[[BaseException], NoReturn]
    profile: Profile

    def __post_init__(self) -> None:
        self._slots = threading.Semaphore(FRAMES_WAITING)
        self._pool = ThreadPoolExecutor(1, "encode")
        self._began, self._cpu_began = time.perf_counter(), time.process_time()

    def __enter__(self) -> Self:
        self._began, self._cpu_began = time.perf_counter(), time.process_time()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        with self.profile.phase(WAITING):
            self._pool.shutdown(wait=True)

    def put(self, frame: int, writers: Callable[[], Mapping[str, Writer]]) -> None:
        """Hand over a frame; waits where too many are waiting already.

        Args:
            frame: its number.
            writers: gives what writes each pass; called in the encoder's thread.
        """
        with self.profile.phase(WAITING):
            self._slots.acquire()
        now, cpu_now = time.perf_counter(), time.process_time()
        self._pool.submit(self._finish, frame, writers, now - self._began, cpu_now - self._cpu_began)
        self._began, self._cpu_began = now, cpu_now

    def _finish(
        self, frame: int, writers: Callable[[], Mapping[str, Writer]], seconds: float, cpu_seconds: float
    ) -> None:
        try:
            with self.profile.phase(ENCODING):
                publish_frame(self.out, frame, writers(), self.image_format)
            self.on_frame(frame, seconds, cpu_seconds)
        except BaseException as error:
            self.abort(error)
        finally:
            self._slots.release()
