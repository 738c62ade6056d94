"""``dataset.json``: derived from the finished sequences, never a state of its own.

Whatever was killed, and whenever, writing the index again from the folders gives the same file.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from whacamole.dataset.files import sha256_of, write_json
from whacamole.dataset.layout import FORMAT_VERSION, DatasetLayout, SequenceLayout
from whacamole.errors import DatasetError

__all__ = ["checksums_of", "read_json", "read_summary", "write_index", "write_summary"]


def read_json(path: Path, remedy: str = "run `whacamole render` again with the same options") -> Any:
    """Return the value of a JSON file; ``remedy`` ends the message if it is broken.

    Raises:
        DatasetError: the file is missing or is not JSON.
    """
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise DatasetError(f"{path}: not there; is this a dataset made by `whacamole render`?") from None
    except (OSError, UnicodeDecodeError, json.JSONDecodeError) as error:
        raise DatasetError(f"{path}: not readable as JSON ({error}); {remedy}") from error


def checksums_of(folder: Path) -> dict[str, str]:
    """Return the sha256 of every file below ``folder``, by relative path, sorted."""
    files = sorted(path for path in folder.rglob("*") if path.is_file() and path.name != "sequence.json")
    return {path.relative_to(folder).as_posix(): sha256_of(path) for path in files}


def write_summary(sequence: SequenceLayout, facts: Mapping[str, Any]) -> None:
    """Write ``sequence.json``: what the sequence is, and the checksum of every file in it."""
    write_json(sequence.summary, {**facts, "checksums": checksums_of(sequence.folder)})


def read_summary(sequence: SequenceLayout) -> dict[str, Any]:
    """Return the facts of a finished sequence.

    Raises:
        DatasetError: ``sequence.json`` is missing or broken.
    """
    value = read_json(sequence.summary, "delete the folder, render again")
    if not isinstance(value, dict) or "motion_id" not in value:
        raise DatasetError(f"{sequence.summary}: no summary of a sequence; delete the folder, render again")
    return value


def write_index(layout: DatasetLayout, facts: Mapping[str, Any]) -> None:
    """Write ``dataset.json`` from what is finished.

    Args:
        facts: resolved recipe, versions and body model, placed before the list of sequences.
    """
    entries = []
    for sequence_id in layout.finished():
        sequence = layout.sequence(sequence_id)
        summary = read_summary(sequence)
        checksums = summary.pop("checksums")
        labels = {name: digest for name, digest in checksums.items() if "/" not in name}
        entries.append({**summary, "checksums": {**labels, "sequence.json": sha256_of(sequence.summary)}})
    write_json(layout.index, {"format_version": FORMAT_VERSION, **facts, "sequences": entries})
