"""RICH (Huang et al., CVPR 2022): ``bodies/<split>/<sequence>/<frame>/<subject>.pkl`` and calibration."""

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from whacamole.errors import EvaluationError
from whacamole.evaluation.core.alignment import FloatArray
from whacamole.evaluation.io.arrays import axis_angles, take
from whacamole.evaluation.records import CameraTrack, PersonTrack, Placement, Recording
from whacamole.evaluation.truth.pickles import read_pickle

SPLITS = ("train", "val", "test", "all")
_WIDTHS = {
    "global_orient": 3, "transl": 3, "body_pose": 63, "betas": 10, "expression": 10, "jaw_pose": 3,
    "leye_pose": 3, "reye_pose": 3,
}  # fmt: skip


@dataclass(frozen=True)
class RichTruth:
    """The folder with ``bodies`` and ``scan_calibration`` (or its ``data``): SMPL-X, gendered, static
    cameras.

    A sequence seen by a camera is one recording, ``<sequence>_cam_<number>``. Genders are read from
    ``gender.json`` or ``resource/gender.json`` (of the benchmark's toolkit); without it bodies are neutral
    and a note says so.
    """

    root: Path
    name: str = "RICH"

    def ids(self, split: str) -> list[str]:
        """Recordings of a split: every sequence with every calibrated camera of its scene."""
        if split not in SPLITS:
            raise EvaluationError(f"RICH has no split {split!r}, only {', '.join(SPLITS)}")
        folder = "*" if split == "all" else split
        found = [
            f"{sequence.name}_cam_{int(camera.stem):02d}"
            for sequence in sorted((self._data / "bodies").glob(f"{folder}/*"))
            for camera in sorted(self._calibration(sequence.name).glob("[0-9]*.xml"))
        ]
        if not found:
            raise EvaluationError(
                f"{self.root}: no bodies/{folder}/* with scan_calibration/*/calibration/*.xml"
            )
        return found

    def read(self, sequence_id: str) -> Recording:
        """One sequence with one camera."""
        parts = re.fullmatch(r"(.+)_cam_(\d+)", sequence_id)
        folder = next(iter((self._data / "bodies").glob(f"*/{parts[1]}")), None) if parts else None
        if parts is None or folder is None:
            raise EvaluationError(f"{self.root}: RICH has no sequence {sequence_id}")
        frames = sorted(int(path.name) for path in folder.iterdir() if path.name.isdigit())
        subjects = sorted({path.stem for path in folder.glob("[0-9]*/*.pkl")})
        if not frames or not subjects:
            raise EvaluationError(f"{folder}: no <frame>/<subject>.pkl")
        genders = self._genders()
        people = tuple(_person(folder, frames, subject, genders) for subject in subjects)
        pose, K = _camera(self._calibration(folder.name) / f"{int(parts[2]):03d}.xml")
        T = len(frames)
        camera = CameraTrack(np.tile(pose, (T, 1, 1)), np.ones(T, dtype=bool), np.tile(K, (T, 1, 1)))
        return Recording(
            id=sequence_id,
            frame_index=np.array(frames, dtype=np.intp),
            fps=30.0,
            people=people,
            camera=camera,
            source=folder.name.split("_")[0],
            notes=() if genders else ("no gender.json, so RICH's people are taken as neutral",),
        )

    @property
    def _data(self) -> Path:
        return self.root / "data" if (self.root / "data" / "bodies").is_dir() else self.root

    def _calibration(self, sequence: str) -> Path:
        return self._data / "scan_calibration" / sequence.split("_")[0] / "calibration"

    def _genders(self) -> dict[str, str]:
        for path in (self.root / "gender.json", self.root / "resource" / "gender.json"):
            if path.exists():
                try:
                    return {
                        str(key): str(value) for key, value in json.loads(path.read_text("utf-8")).items()
                    }
                except (OSError, ValueError, AttributeError) as error:
                    raise EvaluationError(f"{path}: not a list of genders ({error})") from error
        return {}


def _person(folder: Path, frames: list[int], subject: str, genders: dict[str, str]) -> PersonTrack:
    """One subject over all frames; a frame without its file does not count."""
    rows: dict[str, list[FloatArray]] = {}
    valid = np.zeros(len(frames), dtype=bool)
    for row, frame in enumerate(frames):
        path = folder / f"{frame:05d}" / f"{subject}.pkl"
        if path.exists():
            valid[row] = True
            for key, value in read_body(path).items():
                rows.setdefault(key, []).append(value)
    arrays = {}
    for key, values in rows.items():
        arrays[key] = np.full((len(frames), len(values[0])), np.nan)
        arrays[key][valid] = np.stack(values)
    return smplx_person(arrays, valid, int(subject), genders.get(str(int(subject)), "neutral"), space="world")


def read_body(path: Path) -> dict[str, FloatArray]:
    """One frame's SMPL-X parameters (RICH, EgoBody): each a flat array; hands are principal components.

    Raises:
        EvaluationError: the file cannot be used; one line.
    """
    values = read_pickle(path)
    body = {
        key: np.ravel(take(values, key, path, (1, width), (width,), default=np.zeros(width)))
        for key, width in _WIDTHS.items()
    }
    if "body_pose" not in values or "transl" not in values:
        raise EvaluationError(f"{path}: no body_pose and transl; not a SMPL-X body")
    hands = {
        key: np.ravel(take(values, key, path))
        for key in ("left_hand_pose", "right_hand_pose")
        if key in values
    }
    return body | hands


def smplx_person(
    arrays: dict[str, FloatArray], valid: Any, track_id: int, gender: str, *, space: str
) -> PersonTrack:
    """A person of per-frame arrays (T, n) as :func:`read_body` names them, in one space."""
    placement = Placement(arrays["global_orient"], arrays["transl"])
    return PersonTrack(
        track_id=track_id,
        kind="smplx",
        betas=arrays["betas"],
        body_pose=axis_angles(arrays["body_pose"]),
        valid=valid,
        world=placement if space == "world" else None,
        camera=placement if space == "camera" else None,
        gender=gender,
        left_hand_pose=arrays.get("left_hand_pose"),
        right_hand_pose=arrays.get("right_hand_pose"),
        jaw_pose=arrays["jaw_pose"],
        leye_pose=arrays["leye_pose"],
        reye_pose=arrays["reye_pose"],
        expression=arrays["expression"],
    )


def _camera(path: Path) -> tuple[FloatArray, FloatArray]:
    """Camera to world (4, 4) and K (3, 3) of an OpenCV calibration file."""
    try:
        tree = ElementTree.parse(path)  # noqa: S314  # no entities are resolved from outside; a local file of numbers
        matrices = {}
        for key, size in (("CameraMatrix", 12), ("Intrinsics", 9)):
            numbers = np.array((tree.findtext(f"./{key}/data") or "").split(), dtype=np.float64)
            matrices[key] = numbers.reshape(3, size // 3)
    except (OSError, ElementTree.ParseError, ValueError) as error:
        raise EvaluationError(f"{path}: not an OpenCV calibration ({error})") from error
    T_camera_world = np.vstack([matrices["CameraMatrix"], [0.0, 0.0, 0.0, 1.0]])
    return np.linalg.inv(T_camera_world), matrices["Intrinsics"]
