"""How far a dataset is, read from its folder alone, so that any terminal on any machine may ask."""

import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from whacamole.dataset import DatasetLayout, read_json
from whacamole.errors import DatasetError, MotionError
from whacamole.production.place import attempts_so_far
from whacamole.production.progress import STEPS, clock
from whacamole.production.pulse import Pulse, RunRecord, live_runs
from whacamole.production.worklist import failure_note, work_of
from whacamole.recipe import Recipe

__all__ = ["Status", "status_of"]


@dataclass(frozen=True)
class Status:
    """The state of a dataset.

    Attributes:
        dataset: its folder.
        asked: sequences that its recipe asks for; None where its motions are not here to tell.
        finished: how many of them are there.
        runs: every `whacamole render` at work on it, on whatever machine.
        begun: sequence id → how far it is, of those not finished.
        failed: sequence id → one-line error, of those given up in the last run that tried them.
        failed_attempts: sequence id → errors of its attempts, of those not finished.
    """

    dataset: str
    asked: int | None
    finished: int
    runs: tuple[RunRecord, ...]
    begun: dict[str, Pulse]
    failed: dict[str, str]
    failed_attempts: dict[str, list[str]]

    def as_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        return {**asdict(self), "frames_s": self.frames_s, "left_s": self.left_s}

    @property
    def frames_s(self) -> float:
        """Frames a second over all runs."""
        return sum(run.frames_s for run in self.runs)

    @property
    def left_s(self) -> float | None:
        """Seconds until the last of the runs is through; None where nothing runs or none can tell."""
        return max((run.left_s for run in self.runs if run.left_s is not None), default=None)

    def as_text(self) -> str:
        """Return the state as lines for a terminal."""
        of = "" if self.asked is None else f"of {self.asked} "
        head = f"{self.dataset}: {self.finished} {of}sequences finished"
        if self.asked is None:
            head += " (the motions of its recipe are not here: how many are asked for cannot be told)"
        if self.runs:
            head += f", {self.frames_s:.2f} frames/s"
        if self.left_s is not None:
            head += f", {clock(self.left_s)} left"
        lines = [head]
        for run in self.runs:
            tries = f", {run.failed_attempts} attempts failed" if run.failed_attempts else ""
            spent = clock(time.time() - run.began)
            lines.append(f"  run {run.name} ({run.with_what}): {run.made} made in {spent}{tries}")
        for name, pulse in self.begun.items():
            lines.append(f"  {name}: {self._how_far(pulse)}")
            lines += [f"    failed attempt: {error}" for error in self.failed_attempts.get(name, ())]
        lines += [f"  failed: {error}" for error in self.failed.values()]  # each names its sequence
        return "\n".join(lines)

    def _how_far(self, pulse: Pulse) -> str:
        text = f"{STEPS.get(pulse.step, pulse.step or 'begun')}"
        if pulse.frames:
            text += f", {pulse.done} of {pulse.frames} frames"
        if pulse.run in {run.name for run in self.runs}:
            return (
                f"{text}, on {pulse.host} (pid {pulse.pid}), {clock(max(0.0, time.time() - pulse.beat))} ago"
            )
        return f"{text}; nobody is at it, `whacamole render` goes on with it"


def status_of(root: Path) -> Status:
    """Return the state of the dataset at ``root``.

    Raises:
        DatasetError: there is no dataset.
    """
    layout = DatasetLayout(root.resolve())
    if not (layout.root / "recipe.json").exists():
        raise DatasetError(f"{root}: no dataset made by `whacamole render` (recipe.json is not there)")
    runs = tuple(live_runs(layout))
    try:
        worklist = work_of(Recipe.model_validate(read_json(layout.root / "recipe.json")), layout.root)
    except MotionError:  # a dataset that has travelled, or a relative path seen from elsewhere
        return Status(str(layout.root), None, len(layout.finished()), runs, {}, {}, {})
    begun: dict[str, Pulse] = {}
    failed: dict[str, str] = {}
    attempts: dict[str, list[str]] = {}
    for order in worklist.open:
        work = layout.work_of(order.sequence_id)
        if failure_note(order).exists():
            failed[order.sequence_id] = str(read_json(failure_note(order))["error"])
        elif (pulse := Pulse.read(work)) is not None:
            begun[order.sequence_id] = pulse
            attempts[order.sequence_id] = [str(made["error"]) for made in attempts_so_far(work)]
    done = len(worklist.orders) - len(worklist.open)
    return Status(str(layout.root), len(worklist.orders), done, runs, begun, failed, attempts)
