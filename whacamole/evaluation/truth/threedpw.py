"""3DPW (von Marcard et al., ECCV 2018): ``sequenceFiles/{train,validation,test}/<sequence>.pkl``."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from whacamole.errors import EvaluationError
from whacamole.evaluation.io.arrays import axis_angles, take
from whacamole.evaluation.records import CameraTrack, PersonTrack, Placement, Recording
from whacamole.evaluation.truth.pickles import read_pickle

SPLITS = ("train", "validation", "test", "all")
_GENDERS = {"m": "male", "f": "female"}


@dataclass(frozen=True)
class ThreedpwTruth:
    """The folder with ``sequenceFiles``: SMPL, gendered, one or two people, one moving camera.

    A person's frame counts where the camera pose is valid for that person and, if 2D detections are stored,
    where there is one.
    """

    root: Path
    name: str = "3DPW"

    def ids(self, split: str) -> list[str]:
        """Sequences of a split."""
        if split not in SPLITS:
            raise EvaluationError(f"3DPW has no split {split!r}, only {', '.join(SPLITS)}")
        folder = "*" if split == "all" else split
        found = sorted(path.stem for path in (self.root / "sequenceFiles").glob(f"{folder}/*.pkl"))
        if not found:
            raise EvaluationError(f"{self.root}: no sequenceFiles/{folder}/*.pkl")
        return found

    def read(self, sequence_id: str) -> Recording:
        """One sequence at the 30 fps of its images."""
        path = next(iter((self.root / "sequenceFiles").glob(f"*/{sequence_id}.pkl")), None)
        if path is None:
            raise EvaluationError(f"{self.root}: 3DPW has no sequence {sequence_id}")
        values = read_pickle(path)
        extrinsics = take(values, "cam_poses", path, (None, 4, 4))
        T = len(extrinsics)
        people, count = [], len(values.get("poses", ()))
        for key in ("poses", "trans", "betas", "genders", "campose_valid"):
            if len(values.get(key, ())) != count or not count:
                raise EvaluationError(
                    f"{path}: {key!r} does not list {count} people; fetch the benchmark's file again"
                )
        for i in range(count):
            person = {key: values[key][i] for key in ("poses", "trans", "betas", "campose_valid")}
            pose = axis_angles(take(person, "poses", path, (T, 72)))
            valid = take(person, "campose_valid", path, (T,)).astype(bool)
            if len(values.get("poses2d", ())) == count:
                valid &= (take({"poses2d": values["poses2d"][i]}, "poses2d", path, (T, 3, 18)) > 0).any(
                    axis=(1, 2)
                )
            people.append(
                PersonTrack(
                    track_id=i,
                    kind="smpl",
                    betas=np.ravel(take(person, "betas", path))[:10],
                    body_pose=pose[:, 1:],
                    valid=valid,
                    world=Placement(pose[:, 0], take(person, "trans", path, (T, 3))),
                    gender=_GENDERS.get(str(values["genders"][i])[:1], "neutral"),
                )
            )
        K = np.broadcast_to(take(values, "cam_intrinsics", path, (3, 3)), (T, 3, 3))
        return Recording(
            id=sequence_id,
            frame_index=np.arange(T),
            fps=30.0,
            people=tuple(people),
            camera=CameraTrack(np.linalg.inv(extrinsics), np.isfinite(extrinsics).all(axis=(1, 2)), K),
            source=path.parent.name,
        )
