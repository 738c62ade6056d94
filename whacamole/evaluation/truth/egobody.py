"""EgoBody (Zhang et al., ECCV 2022): SMPL-X of the people before a head-mounted camera."""

import csv
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from whacamole.errors import EvaluationError
from whacamole.evaluation.core.alignment import FloatArray
from whacamole.evaluation.io.arrays import read_npz
from whacamole.evaluation.records import BoolArray, CameraTrack, IntArray, PersonTrack, Recording
from whacamole.evaluation.truth.rich import read_body, smplx_person

SPLITS = ("train", "val", "test", "all")
_OPENGL_TO_OPENCV = np.diag([1.0, -1.0, -1.0, 1.0])


@dataclass(frozen=True)
class EgoBodyTruth:
    """The folder with ``data_info_release.csv``: the interactee as the HoloLens camera saw them.

    The world is the master Kinect's camera frame, in which the bodies are given; the camera of a frame is
    ``holo_to_kinect12`` · ``pv2world`` with its axes turned to OpenCV's. A frame counts where body, image and
    a valid detection exist.
    """

    root: Path
    name: str = "EgoBody"

    def ids(self, split: str) -> list[str]:
        """Recordings of a split by ``data_splits.csv``."""
        if split not in SPLITS:
            raise EvaluationError(f"EgoBody has no split {split!r}, only {', '.join(SPLITS)}")
        if split == "all":
            return sorted(self._info())
        found = sorted(row[split] for row in _rows(self.root / "data_splits.csv") if row.get(split))
        if not found:
            raise EvaluationError(f"{self.root}: data_splits.csv lists nothing under {split}")
        return found

    def read(self, sequence_id: str) -> Recording:
        """One recording from its start frame to its end frame."""
        info = self._info().get(sequence_id)
        if info is None:
            raise EvaluationError(f"{self.root}: EgoBody has no recording {sequence_id}")
        try:
            first, last = int(info["start_frame"]), int(info["end_frame"])
            body, gender = info["body_idx_fpv"].split()
        except (KeyError, ValueError) as error:
            raise EvaluationError(
                f"{self.root}: data_info_release.csv is not readable for {sequence_id}"
            ) from error
        frames = np.arange(first, last + 1)
        camera, seen = self._camera(sequence_id, frames)
        person = self._person(sequence_id, frames, int(body), gender, seen)
        return Recording(
            id=sequence_id,
            frame_index=frames,
            fps=30.0,
            people=(person,),
            camera=camera,
            source=info.get("scene_name", ""),
        )

    def _info(self) -> dict[str, dict[str, str]]:
        return {row["recording_name"]: row for row in _rows(self.root / "data_info_release.csv")}

    def _person(
        self, recording: str, frames: IntArray, body: int, gender: str, seen: BoolArray
    ) -> PersonTrack:
        folder = next(
            iter(sorted(self.root.glob(f"smplx_interactee*/{recording}/body_idx_{body}/results"))), None
        )
        if folder is None:
            raise EvaluationError(f"{self.root}: no smplx_interactee*/{recording}/body_idx_{body}/results")
        bodies = {
            row: read_body(path)
            for row, frame in enumerate(frames)
            if (path := folder / f"frame_{frame:05d}" / "000.pkl").exists()
        }
        if not bodies:
            raise EvaluationError(f"{folder}: no frame_?????/000.pkl between {frames[0]} and {frames[-1]}")
        arrays = {
            key: np.full((len(frames), len(value)), np.nan)
            for key, value in next(iter(bodies.values())).items()
        }
        for row, values in bodies.items():
            for key, value in values.items():
                arrays[key][row] = value
        valid = np.isin(np.arange(len(frames)), list(bodies)) & seen
        return smplx_person(arrays, valid, body, gender, space="world")

    def _camera(self, recording: str, frames: IntArray) -> tuple[CameraTrack, BoolArray]:
        """The head-mounted camera on the frames, and where it saw the interactee."""
        folder = next(iter(sorted((self.root / "egocentric_color" / recording).glob("*/"))), None)
        table = next(iter(folder.glob("*_pv.txt")), None) if folder else None
        if folder is None or table is None:
            raise EvaluationError(f"{self.root}: no egocentric_color/{recording}/*/*_pv.txt")
        poses = {row[0]: np.array(row[1:19], dtype=np.float64) for row in _pv_rows(table)}
        cx, cy = (float(word) for word in table.read_text("utf-8").splitlines()[0].split(",")[:2])
        listed = read_npz(folder / "valid_frame.npz")
        holo_to_world = self._holo_to_kinect(recording)
        pose, K = np.full((len(frames), 4, 4), np.nan), np.tile(np.eye(3), (len(frames), 1, 1))
        seen = np.zeros(len(frames), dtype=bool)
        for name, valid in zip(listed.get("imgname", ()), listed.get("valid", ()), strict=True):
            time, _, frame = Path(str(name)).stem.partition("_frame_")
            row = int(frame) - int(frames[0]) if frame.isdigit() else -1
            if 0 <= row < len(frames) and time in poses:
                pose[row] = holo_to_world @ poses[time][2:].reshape(4, 4) @ _OPENGL_TO_OPENCV
                K[row, :2] = [[poses[time][0], 0.0, cx], [0.0, poses[time][1], cy]]
                seen[row] = bool(valid)
        found = np.isfinite(pose).all(axis=(1, 2))
        return CameraTrack(pose, found, K), seen & found

    def _holo_to_kinect(self, recording: str) -> FloatArray:
        base = self.root / "calibrations" / recording
        for path in (base / "cal_trans" / "holo_to_kinect12.json", base / "holo_to_kinect12.json"):
            if path.exists():
                try:
                    return np.array(json.loads(path.read_text("utf-8"))["trans"], dtype=np.float64).reshape(
                        4, 4
                    )
                except (OSError, ValueError, KeyError) as error:
                    raise EvaluationError(f"{path}: not a transform ({error})") from error
        raise EvaluationError(f"{base}: no holo_to_kinect12.json")


def _rows(path: Path) -> list[dict[str, str]]:
    try:
        with path.open(newline="", encoding="utf-8") as stream:
            return list(csv.DictReader(stream))
    except (OSError, UnicodeDecodeError) as error:
        raise EvaluationError(f"{path}: not readable ({error})") from error


def _pv_rows(path: Path) -> Iterator[list[str]]:
    """Lines after the first: time, fx, fy, then 16 numbers, camera to HoloLens world."""
    for number, line in enumerate(path.read_text("utf-8").splitlines()[1:], start=2):
        words = line.strip().split(",")
        if len(words) < 19:
            raise EvaluationError(f"{path}: line {number} has {len(words)} entries, expected 19")
        yield words
