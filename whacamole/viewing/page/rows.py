"""What the page knows of every sequence: plain values, small enough to be embedded for thousands."""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from whacamole.check.stored import StoredFindings
from whacamole.dataset import Dataset
from whacamole.viewing.places import Places

__all__ = ["COLUMNS", "rows_of"]

COLUMNS = (
    "id", "motion", "source", "shots", "stage", "people", "frames", "fps", "width", "height", "split",
    "together", "visible", "image", "links", "findings",
)  # fmt: skip
"""The values of a row, in order. ``links``: bits, 1 for the 3D scene, 2 for the video, 4 for the sheet."""


def rows_of(data: Dataset, findings: StoredFindings | None) -> list[list[Any]]:
    """A row for each finished sequence, from ``dataset.json`` and the names of files alone."""
    sides = _sides(data)
    found: dict[str, list[str]] = {}
    for line in findings.lines if findings is not None else ():
        found.setdefault(line.sequence, []).append(line.text)
    places = Places(data.layout.root)
    made = places.made()
    present = set(data.ids)
    return [
        _row(entry, sides, found, made)
        for entry in data.index.get("sequences", ())
        if isinstance(entry, Mapping) and entry.get("id") in present
    ]


def _row(
    facts: Mapping[str, Any],
    sides: Mapping[str, str],
    found: Mapping[str, list[str]],
    made: Mapping[str, int],
) -> list[Any]:
    name = str(facts["id"])
    frames = int(facts.get("frames", 0))
    return [
        name,
        str(facts.get("motion_id", "")),
        str(facts.get("motion_source", "not stated")),
        sorted({str(shot) for shot in _list(facts.get("shots"))}),
        str(facts.get("stage", "not stated")),
        int(facts.get("people", 0)),
        frames,
        float(facts.get("fps", 0.0)),
        int(facts.get("width", 16)),
        int(facts.get("height", 9)),
        sides.get(name, "none"),
        bool(facts.get("interactive")),
        round(float(facts.get("mean_visible_fraction", -1.0)), 3),
        "png" if facts.get("image_format") == "png" else "jpg",
        made.get(name, 0),
        found.get(name, []),
    ]


def _list(value: Any) -> Iterable[Any]:
    return value if isinstance(value, list) else ()


def _sides(data: Dataset) -> dict[str, str]:
    sides: dict[str, str] = {}
    for file in sorted(data.layout.splits.glob("*.txt")) if data.layout.splits.is_dir() else ():
        for name in _words(file):
            sides[name] = f"{sides[name]}, {file.stem}" if name in sides else file.stem
    return sides


def _words(file: Path) -> list[str]:
    return file.read_text(encoding="utf-8", errors="replace").split()
