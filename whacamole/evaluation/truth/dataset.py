"""Datasets of this project (docs/format.md)."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from whacamole.errors import EvaluationError
from whacamole.evaluation.io.arrays import read_npz, take
from whacamole.evaluation.io.native import camera_of, contact_of, people_of
from whacamole.evaluation.records import SPACES, Recording


@dataclass(frozen=True)
class DatasetTruth:
    """A folder with ``sequences/`` and ``splits/``."""

    root: Path
    name: str = "whacamole"

    def ids(self, split: str) -> list[str]:
        """Ids of ``splits/<split>.txt``; "all": every sequence there is."""
        if split == "all":
            found = sorted(path.parent.name for path in (self.root / "sequences").glob("*/people.npz"))
        else:
            path = self.root / "splits" / f"{split}.txt"
            try:
                found = sorted(path.read_text(encoding="utf-8").split())
            except OSError as error:
                raise EvaluationError(
                    f"{path}: {error.strerror or error}; use --split all, train or test"
                ) from error
        if not found:
            raise EvaluationError(f"{self.root}: split {split!r} has no sequence")
        return found

    def read(self, sequence_id: str) -> Recording:
        """One sequence: labels as they are stored, nothing posed."""
        folder = self.root / "sequences" / sequence_id
        camera, people = read_npz(folder / "camera.npz"), read_npz(folder / "people.npz")
        path = folder / "people.npz"
        frame_index = take(camera, "frame_index", folder / "camera.npz", (None,)).astype(np.intp)
        T = len(frame_index)
        tracks = people_of(people, path, T)
        P = len(tracks)
        joints = {
            space: take(people, f"joints_{space}", path, (P, T, 55, 3))
            for space in SPACES
            if f"joints_{space}" in people
        }
        contact = folder / "contact.npz"
        visible = take(people, "visible_fraction", path, (P, T)) if "visible_fraction" in people else None
        return Recording(
            id=sequence_id,
            frame_index=frame_index,
            fps=float(take(camera, "fps", folder / "camera.npz")),
            people=tracks,
            camera=camera_of(camera, folder / "camera.npz", T),
            contact=contact_of(read_npz(contact), "ground_contact") if contact.exists() else None,
            joints=joints,
            visible_fraction=visible,
            shots=_shots(folder / "shot.json", T),
            source=_source(people, folder),
            up=(0.0, 0.0, 1.0),
        )


def _shots(path: Path, T: int) -> tuple[str, ...] | None:
    """Name of the camera move at each frame; where two shots share a frame it is the later one's."""
    shots = _json(path).get("shots")
    if not isinstance(shots, list):
        return None
    names = [""] * T
    for shot in shots:
        if not isinstance(shot, dict) or "kind" not in shot:
            raise EvaluationError(f"{path}: a shot without 'kind'; render the sequence again")
        for frame in range(max(int(shot.get("start", 0)), 0), min(int(shot.get("end", T - 1)), T - 1) + 1):
            names[frame] = str(shot["kind"])
    return tuple(names)


def _source(people: dict[str, Any], folder: Path) -> str:
    """Where the motion comes from: as the sequence's summary says, else the first part of the motion's id."""
    summary = _json(folder / "sequence.json")
    if summary.get("motion_source"):
        return str(summary["motion_source"])
    motion = np.ravel(people.get("motion_id", ""))
    return str(motion[0]).split("/")[0].split("__")[0] if motion.size else ""


def _json(path: Path) -> dict[str, Any]:
    if not path.exists():
        return {}
    try:
        value = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, json.JSONDecodeError) as error:
        raise EvaluationError(f"{path}: not readable as JSON ({error}); render the sequence again") from error
    return value if isinstance(value, dict) else {}
