"""What a person sees while sequences are made, on whatever machines; and the record for other terminals."""

import threading
import time
from collections.abc import Mapping
from dataclasses import replace
from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn, TimeElapsedColumn

from whacamole.dataset import DatasetLayout
from whacamole.production.pulse import RUN_BEAT_S, Pulse, RunRecord, pulses

__all__ = ["STEPS", "Monitor", "clock"]

STEPS = {"scene": "staging", "plan": "planning", "render": "rendering", "label": "labelling"}
LOOK_S = 1.0
SHOWN = 12
"""Sequences in the making that get a line of their own."""


def clock(seconds: float) -> str:
    """Return a duration as 3:07, 1:02:03 or "2 d 3 h"."""
    minutes, rest = divmod(int(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    if hours >= 48:
        return f"{hours // 24} d {hours % 24} h"
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


class Pace:
    """Frames rendered by one run, from the signs of life of its sequences."""

    def __init__(self, frames: Mapping[str, int]) -> None:
        self._frames = frames
        self._began = time.monotonic()
        self._seen: dict[str, int] = {}
        self._rendered = 0
        self._left = dict(frames)

    def look(self, pulse: Pulse) -> None:
        """Take in how far a sequence is."""
        if pulse.step not in ("render", "label") or pulse.sequence_id not in self._left:
            return
        done = pulse.done if pulse.step == "render" else pulse.frames
        before = self._seen.setdefault(pulse.sequence_id, done if pulse.step == "render" else 0)
        self._rendered += max(0, done - before)
        self._seen[pulse.sequence_id] = max(done, before)

    def finish(self, sequence_id: str, *, here: bool) -> None:
        """A sequence is finished, by this run or (not ``here``) by somebody else."""
        frames = self._left.pop(sequence_id, 0)
        seen = self._seen.pop(sequence_id, 0)
        if here:
            self._rendered += max(0, frames - seen)

    def give_up(self, sequence_id: str) -> None:
        """A sequence will not be finished."""
        self._left.pop(sequence_id, None)

    @property
    def frames_s(self) -> float:
        """Frames a second since the beginning."""
        return self._rendered / max(time.monotonic() - self._began, 1e-9)

    @property
    def left_s(self) -> float | None:
        """Seconds left; None where there is no telling."""
        if not self._rendered:
            return None
        left = sum(max(0, frames - self._seen.get(name, 0)) for name, frames in self._left.items())
        return left / self.frames_s


class Monitor:
    """A line for the whole run (pace, time left) and one for each sequence in the making.

    It looks into the dataset's folder once a second, so it sees workers on any machine. On a terminal the
    lines move; in a log there is one line for each finished sequence. It keeps the run's record for
    `whacamole status`.
    """

    def __init__(
        self,
        layout: DatasetLayout,
        record: RunRecord,
        frames: Mapping[str, int],
        finished: int,
        *,
        quiet: bool,
    ) -> None:
        self._layout, self._record = layout, record
        self._console = Console(stderr=True, quiet=quiet, soft_wrap=True)
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
        self._pace = Pace(frames)
        self._finished, self._total = finished, finished + len(frames)
        self._overall = self._bars.add_task("sequences", total=self._total, completed=finished, note="")
        self._tasks: dict[str, TaskID] = {}
        self._said = ""
        self._over = threading.Event()
        self._eyes = threading.Thread(target=self._watch, daemon=True, name="monitor")

    def __enter__(self) -> Self:
        self._record.write(self._layout)
        self._bars.start()
        self._eyes.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._over.set()
        self._eyes.join()
        self._bars.stop()
        self._record.remove(self._layout)

    def made(self, sequence_id: str, *, here: bool) -> None:
        """A sequence is finished, by this run or (not ``here``) by another."""
        with self._lock:
            self._pace.finish(sequence_id, here=here)
            self._finished += 1
            self._record = replace(self._record, made=self._record.made + here)
            how = "done" if here else "done elsewhere"
            self._console.print(
                f"{sequence_id}  {how}  ({self._finished}/{self._total}{self._pace_text(', ')})",
                highlight=False,
            )

    def failed(self, sequence_id: str, *, final: bool) -> None:
        """An attempt at a sequence failed; ``final``: it is given up."""
        with self._lock:
            self._record = replace(self._record, failed_attempts=self._record.failed_attempts + 1)
            if final:
                self._pace.give_up(sequence_id)
                self._console.print(f"{sequence_id}  [red]failed[/]  (why: below, at the end)")
            else:
                self._console.print(f"{sequence_id}  an attempt failed, it is tried again", highlight=False)

    def postponed(self, why: str) -> None:
        """Something cannot be done at present; said once."""
        with self._lock:
            if why != self._said and "another process" not in why:
                self._console.print(f"waiting: {why}", highlight=False, markup=False)
                self._said = why

    def _watch(self) -> None:
        next_record = 0.0
        while not self._over.wait(LOOK_S):
            mine = [pulse for pulse in pulses(self._layout) if pulse.run == self._record.name]
            with self._lock:
                for pulse in mine:
                    self._pace.look(pulse)
                self._show(mine)
                if time.monotonic() >= next_record:
                    next_record = time.monotonic() + RUN_BEAT_S
                    pace = round(self._pace.frames_s, 3)
                    record = replace(self._record, beat=time.time(), frames_s=pace, left_s=self._pace.left_s)
                    record.write(self._layout)

    def _show(self, mine: list[Pulse]) -> None:
        shown = {pulse.sequence_id: pulse for pulse in mine[:SHOWN]}
        for gone in set(self._tasks) - set(shown):
            self._bars.remove_task(self._tasks.pop(gone))
        for name, pulse in shown.items():
            if name not in self._tasks:
                self._tasks[name] = self._bars.add_task(name, total=None, note="")
            note = f"{STEPS.get(pulse.step, pulse.step)} on {pulse.host}"
            self._bars.update(self._tasks[name], completed=pulse.done, total=pulse.frames or None, note=note)
        self._bars.update(self._overall, completed=self._finished, note=self._pace_text())

    def _pace_text(self, before: str = "") -> str:
        """Return frames a second and the time left, over all workers of this run."""
        left = self._pace.left_s
        if left is None:
            return ""
        return f"{before}{self._pace.frames_s:.2f} frames/s, {clock(left)} left"
