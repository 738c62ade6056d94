"""The outcome of the last audit, kept in ``DATASET/check.json`` for those who look at the dataset later."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from whacamole.check.findings import Finding, Findings
from whacamole.dataset import DatasetLayout, read_json
from whacamole.dataset.files import sha256_of, write_json
from whacamole.errors import DatasetError

__all__ = ["Line", "StoredFindings", "read_findings", "store_findings"]

FILE = "check.json"


@dataclass(frozen=True)
class Line:
    """A finding in words.

    Attributes:
        sequence: its id, or empty for the dataset as a whole.
        text: the line `whacamole check` printed.
    """

    sequence: str
    text: str


@dataclass(frozen=True)
class StoredFindings:
    """What the last audit found.

    Attributes:
        sequences, frames: how many it audited.
        lines: its findings.
        current: whether ``dataset.json`` is still the one it was made for.
    """

    sequences: int
    frames: int
    lines: tuple[Line, ...]
    current: bool


def store_findings(root: Path, found: Findings) -> Path:
    """Write the outcome of an audit into the dataset.

    Raises:
        OSError: the folder cannot be written to.
    """
    layout = DatasetLayout(root)
    path = layout.root / FILE
    write_json(path, {"dataset_json_sha256": sha256_of(layout.index), **found.to_json()})
    return path


def read_findings(root: Path) -> StoredFindings | None:
    """The outcome of the last audit; None if there was none.

    Raises:
        DatasetError: ``check.json`` is there and is none.
    """
    layout = DatasetLayout(root)
    path = layout.root / FILE
    if not path.is_file():
        return None
    value: Any = read_json(path)
    try:
        findings = [Finding(**entry) for entry in value["findings"]]
        return StoredFindings(
            sequences=int(value["sequences"]),
            frames=int(value["frames"]),
            lines=tuple(Line(finding.sequence, finding.line()) for finding in findings),
            current=value["dataset_json_sha256"] == sha256_of(layout.index),
        )
    except (KeyError, TypeError, ValueError) as error:
        raise DatasetError(f"{path}: not the outcome of an audit; run `whacamole check` again") from error
