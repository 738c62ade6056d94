"""EMDB (Kaufmann et al., ICCV 2023): ``P?/<sequence>/P?_<sequence>_data.pkl``."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from whacamole.errors import EvaluationError
from whacamole.evaluation.io.arrays import axis_angles, take
from whacamole.evaluation.records import CameraTrack, PersonTrack, Placement, Recording
from whacamole.evaluation.truth.pickles import read_pickle

SPLITS = ("emdb1", "emdb2", "all")


@dataclass(frozen=True)
class EmdbTruth:
    """The folder with P0 … P9: SMPL, gendered, y up; frames outside ``good_frames_mask`` do not count."""

    root: Path
    name: str = "EMDB"
    _files: dict[str, Path] = field(default_factory=dict, init=False, repr=False)

    def __post_init__(self) -> None:
        for path in sorted(self.root.glob("P*/*/*_data.pkl")):
            self._files[path.name.removesuffix("_data.pkl")] = path

    def ids(self, split: str) -> list[str]:
        """Sequences of "emdb1" (camera frame), "emdb2" (world) or "all", such as ``P0_09_outdoor_walk``."""
        if split not in SPLITS:
            raise EvaluationError(f"EMDB has no split {split!r}, only {', '.join(SPLITS)}")
        found = [
            key for key, path in self._files.items() if split == "all" or bool(read_pickle(path).get(split))
        ]
        if not found:
            raise EvaluationError(f"{self.root}: no sequence of {split} (P?/*/*_data.pkl)")
        return found

    def read(self, sequence_id: str) -> Recording:
        """One sequence: one person, one moving camera, 30 fps."""
        path = self._files.get(sequence_id)
        if path is None:
            raise EvaluationError(f"{self.root}: EMDB has no sequence {sequence_id}")
        values = read_pickle(path)
        smpl, camera = (_part(values, key, path) for key in ("smpl", "camera"))
        T = len(take(smpl, "trans", path, (None, 3)))
        extrinsics = take(camera, "extrinsics", path, (T, 4, 4))
        K = np.broadcast_to(take(camera, "intrinsics", path, (3, 3)), (T, 3, 3))
        person = PersonTrack(
            track_id=0,
            kind="smpl",
            betas=take(smpl, "betas", path, (10,), (1, 10)).reshape(10),
            body_pose=axis_angles(take(smpl, "poses_body", path, (T, 69))),
            valid=take(values, "good_frames_mask", path, (T,), default=np.ones(T)).astype(bool),
            world=Placement(take(smpl, "poses_root", path, (T, 3)), take(smpl, "trans", path, (T, 3))),
            gender=str(values.get("gender", "neutral")),
        )
        return Recording(
            id=sequence_id,
            frame_index=np.arange(T),
            fps=30.0,
            people=(person,),
            camera=CameraTrack(np.linalg.inv(extrinsics), np.ones(T, dtype=bool), K),
            source=sequence_id.split("_")[0],
            up=(0.0, 1.0, 0.0),
        )


def _part(values: dict[str, Any], key: str, path: Path) -> dict[str, Any]:
    part = values.get(key)
    if not isinstance(part, dict):
        raise EvaluationError(f"{path}: no {key!r}; not an EMDB sequence")
    return part
