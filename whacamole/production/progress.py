"""What a person sees while sequences are made."""

import threading
import time
from types import TracebackType
from typing import Any, Self

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn, TimeElapsedColumn

__all__ = ["ProgressDisplay"]

STEPS = {"scene": "staging", "plan": "planning", "render": "rendering", "label": "labelling"}


class ProgressDisplay:
    """A line for the whole run (pace, time left) and one for each sequence in the making.

    On a terminal the lines move; in a log there is one line for each finished sequence. Safe to call from
    several threads.
    """

    def __init__(self, sequences: int, finished: int, quiet: bool) -> None:
        self._console = Console(stderr=True, quiet=quiet)
        self._bars = Progress(
            TextColumn("{task.description}"),
            BarColumn(bar_width=24),
            MofNCompleteColumn(),
            TextColumn("{task.fields[note]}"),
            TimeElapsedColumn(),
            console=self._console,
            transient=True,
            disable=quiet or not self._console.is_terminal,
        )
        self._lock = threading.Lock()
        self._started = time.monotonic()
        self._frames = 0
        self._made = 0
        self._sequences, self._finished = sequences, finished
        self._overall = self._bars.add_task("sequences", total=sequences, completed=finished, note="")
        self._tasks: dict[str, TaskID] = {}

    def __enter__(self) -> Self:
        self._bars.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bars.stop()

    def begin(self, sequence_id: str) -> None:
        """An attempt at a sequence starts."""
        with self._lock:
            self._tasks[sequence_id] = self._bars.add_task(sequence_id, total=None, note="starting")

    def listen(self, sequence_id: str, event: dict[str, Any]) -> None:
        """Show what a worker says."""
        with self._lock:
            task = self._tasks[sequence_id]
            if event["event"] == "step":
                total = event.get("frames")
                self._bars.update(task, note=STEPS.get(event["name"], event["name"]), total=total)
            elif event["event"] == "frame":
                self._frames += 1
                self._bars.update(task, advance=1)
                self._bars.update(self._overall, note=self._pace())

    def leave(self, sequence_id: str) -> None:
        """An attempt has ended, well or not."""
        with self._lock:
            self._bars.remove_task(self._tasks.pop(sequence_id))

    def made(self, sequence_id: str) -> None:
        """A sequence is finished."""
        with self._lock:
            self._made += 1
            self._bars.update(self._overall, advance=1, note=self._pace())
            done = self._finished + self._made
            self._console.print(f"{sequence_id}  done  ({done}/{self._sequences}, {self._pace()})")

    def failed(self, sequence_id: str) -> None:
        """A sequence is given up."""
        with self._lock:
            self._console.print(f"{sequence_id}  [red]failed[/]  (why: below, at the end)")

    def _pace(self) -> str:
        """Return frames a second and the time left, from the sequences made so far."""
        elapsed = max(time.monotonic() - self._started, 1e-9)
        pace = f"{self._frames / elapsed:.2f} frames/s"
        if self._made:
            left = elapsed / self._made * (self._sequences - self._finished - self._made)
            pace += f", {int(left // 60)}:{int(left % 60):02d} left"
        return pace
