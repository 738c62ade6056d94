"""Whether every file is there, whole, and in its split."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from render_jobs import PASSES
from whacamole.check.findings import Report
from whacamole.dataset import Dataset, DatasetLayout, Sequence, read_json
from whacamole.dataset.files import sha256_of
from whacamole.errors import DatasetError

_LABELS = ("camera", "people", "contact", "shot")


def check_index(data: Dataset, report: Report) -> None:
    """``dataset.json`` names the sequences that are there, once each."""
    listed = [str(entry.get("id")) for entry in data.index.get("sequences", ())]
    for missing in sorted(set(listed) - set(data.ids)):
        report.add("dataset.json", f"lists {missing}, which is not there", "absent", "present")
    for extra in sorted(set(data.ids) - set(listed)):
        report.add("dataset.json", f"does not list {extra}, which is there", "absent", "present")
    if data.layout.sequences.is_dir():
        folders = {path.name for path in data.layout.sequences.iterdir() if path.is_dir()}
        for unfinished in sorted(folders - set(data.ids)):
            report.add("sequences", f"{unfinished} has no sequence.json", "absent", "present")


def check_splits(data: Dataset, motions: Mapping[str, str], report: Report) -> None:
    """Every sequence is in one split, and every motion on one side.

    Args:
        data: the dataset.
        motions: motion of each sequence.
        report: takes the findings.
    """
    sides = {
        path.stem: path.read_text(encoding="utf-8").split()
        for path in sorted(data.layout.splits.glob("*.txt"))
    }
    side_of: dict[str, str] = {}
    motion_side: dict[str, str] = {}
    for side, ids in sides.items():
        for sequence_id in ids:
            label = f"splits/{side}.txt"
            if sequence_id not in motions:
                report.add(label, f"lists {sequence_id}, which is not there", "absent", "present")
                continue
            if sequence_id in side_of:
                report.add(label, f"lists {sequence_id}", f"also in {side_of[sequence_id]}", "one split")
            side_of.setdefault(sequence_id, side)
            motion = motions[sequence_id]
            if motion_side.setdefault(motion, side) != side:
                leak = f"motion {motion} leaks: {sequence_id}"
                report.add(label, leak, f"motion also in {motion_side[motion]}", "one split a motion")
    for sequence_id in sorted(set(motions) - set(side_of)):
        report.add("splits", f"{sequence_id} is in no split", "absent", "present")


def check_files(sequence: Sequence, report: Report, *, checksums: bool) -> bool:
    """Every file of a sequence is there and, if asked, as it was written; the label files can be read.

    Returns:
        Whether the label files can be read.
    """
    before = len(report.found)
    folder = sequence.layout.folder
    for label in _LABELS:
        try:
            getattr(sequence, label)
        except DatasetError as error:
            report.add(f"{label}", "not readable", _reason(error, folder), "a whole file")
    readable = len(report.found) == before
    for name in sequence.facts.get("passes", ()):
        if name == "rgb" and sequence.facts["image_format"] == "mp4":
            _check_video(sequence, report)
            continue
        wanted = {PASSES[name].file(frame, sequence.facts["image_format"]) for frame in range(len(sequence))}
        present = {path.relative_to(folder) for path in (folder / name).glob("*")}
        for file in sorted(wanted - present):
            report.add(name, f"{file} is missing", "absent", "present", int(file.stem))
        for file in sorted(present - wanted):
            report.add(name, f"{file} does not belong there", "present", "absent")
    if checksums:
        _check_sums(sequence, report)
    return readable


def _check_video(sequence: Sequence, report: Report) -> None:
    """The video is there, is no shorter than the labels, and holds nothing else in its place."""
    try:
        sequence.rgb(len(sequence) - 1)
    except DatasetError as error:
        report.add("rgb", "not readable", _reason(error, sequence.layout.folder), "a whole file")
    if (sequence.layout.folder / "rgb").exists():
        report.add("rgb", "a folder of frames beside rgb.mp4", "present", "absent")


def _check_sums(sequence: Sequence, report: Report) -> None:
    written: Mapping[str, Any] = sequence.facts.get("checksums", {})
    for name, digest in written.items():
        path = sequence.layout.folder / name
        if path.is_file() and (found := sha256_of(path)) != digest:
            frame = int(path.stem) if path.stem.isdigit() else None
            report.add(name, "changed since it was written: sha256", found[:12], str(digest)[:12], frame)
    if not written:
        report.add("sequence.json", "holds no checksums", "absent", "present")


def read_index(path: Path) -> Dataset:
    """Open a dataset, also one that no longer has all its sequences.

    Raises:
        DatasetError: there is no dataset at all.
    """
    layout = DatasetLayout(path)
    if not isinstance(read_json(layout.index), dict):
        raise DatasetError(f"{layout.index}: not the index of a dataset; run `whacamole render` again")
    return Dataset(layout, tuple(layout.finished()))


def _reason(error: DatasetError, folder: Path) -> str:
    return str(error).replace(f"{folder}/", "").split(";")[0]
