"""What an audit found: one line a finding."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from whacamole.labels.arrays import Float64s
from whacamole.words import counted

Value = float | int | str


@dataclass(frozen=True)
class Finding:
    """One breach.

    Attributes:
        sequence: id, or empty for the dataset as a whole.
        frame: the worst frame, None where it is about none.
        label: the file, array or image that is wrong, such as ``people.joints_image``.
        message: what is wrong.
        value: what was found.
        limit: what it should keep to.
        frames: how many frames in a row are as wrong.
    """

    sequence: str
    frame: int | None
    label: str
    message: str
    value: Value
    limit: Value
    frames: int = 1

    def line(self) -> str:
        """One line for people."""
        where = self.sequence or "dataset"
        if self.frame is not None:
            where += f" frame {self.frame}"
            if self.frames > 1:
                where += f" (worst of {self.frames})"
        return f"{where}: {self.label}: {self.message}: {_text(self.value)}, limit {_text(self.limit)}"

    def to_json(self) -> dict[str, Any]:
        """Plain values."""
        return dict(vars(self))


@dataclass(frozen=True)
class Findings:
    """The outcome of an audit.

    Attributes:
        findings: in the order of the sequences.
        sequences: how many were audited.
        frames: how many frames they have.
        notes: what could not be asked, and what it takes; no breaches.
    """

    findings: tuple[Finding, ...]
    sequences: int
    frames: int
    notes: tuple[str, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether nothing was found."""
        return not self.findings

    def __iter__(self) -> Iterator[Finding]:
        """Yield every finding."""
        return iter(self.findings)

    def __len__(self) -> int:
        """Return the number of findings."""
        return len(self.findings)

    def lines(self) -> list[str]:
        """One line a finding, one a note, and a summary at the end."""
        audited = f"{counted(self.sequences, 'sequence')}, {counted(self.frames, 'frame')}"
        verdict = "nothing wrong" if self.ok else counted(len(self), "finding")
        notes = (f"note: {note}" for note in self.notes)
        return [*(finding.line() for finding in self.findings), *notes, f"{audited}: {verdict}"]

    def to_json(self) -> dict[str, Any]:
        """Plain values: ``ok``, ``sequences``, ``frames``, ``findings`` and ``notes``."""
        return {
            "ok": self.ok,
            "sequences": self.sequences,
            "frames": self.frames,
            "findings": [finding.to_json() for finding in self.findings],
            "notes": list(self.notes),
        }


@dataclass
class Report:
    """Collects the findings about one sequence.

    Attributes:
        sequence: its id, or empty for the dataset as a whole.
        found: what was found so far.
    """

    sequence: str
    found: list[Finding] = field(default_factory=list)

    def add(self, label: str, message: str, value: Value, limit: Value, frame: int | None = None) -> None:
        """Note one breach."""
        self.found.append(Finding(self.sequence, frame, label, message, value, limit))

    def at_most(self, label: str, message: str, values: Float64s, limit: float) -> None:
        """Note where a value ``(T,)`` passes its limit or is no number: one finding a run of frames."""
        bad = ~(values <= limit)
        edges = np.flatnonzero(np.diff(np.concatenate([[False], bad, [False]]).astype(np.int8)))
        for start, end in edges.reshape(-1, 2).tolist():
            run = np.where(np.isnan(values[start:end]), np.inf, values[start:end])
            worst = start + int(run.argmax())
            self.found.append(
                Finding(self.sequence, worst, label, message, float(values[worst]), limit, end - start)
            )


def _text(value: Value) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)
