"""PromptHMR-Vid: ``results.pkl`` of its pipeline (joblib)."""

from pathlib import Path
from typing import Any

import numpy as np

from whacamole.errors import EvaluationError
from whacamole.evaluation.core.alignment import FloatArray
from whacamole.evaluation.io import inert
from whacamole.evaluation.io.arrays import (
    axis_angles,
    frame_numbers,
    from_matrices,
    intrinsics,
    poses,
    spread_rows,
    take,
)
from whacamole.evaluation.records import CameraTrack, PersonTrack, Placement, Recording


def read_prompthmr(path: Path, sequence_id: str, fps: float) -> Recording:
    """Read a result: ``people`` with ``smplx_cam`` and ``smplx_world``, and ``camera_world``; SMPL-X,
    neutral.

    Raises:
        EvaluationError: the file cannot be used; one line.
    """
    values = inert.load(path)
    if not isinstance(values, dict) or not {"people", "camera_world"} <= set(values):
        raise EvaluationError(
            f"{path}: no 'people' and 'camera_world'; give the results.pkl of PromptHMR's pipeline"
        )
    camera = values["camera_world"]
    centres = take(camera, "Twc", path, (None, 3))
    T = len(centres)
    pose = poses(take(camera, "Rwc", path, (T, 3, 3)), centres)
    K = intrinsics(take(camera, "img_focal", path), take(camera, "img_center", path), T)
    people = tuple(
        _person(person, path, number, T) for number, person in enumerate(values["people"].values())
    )
    return Recording(
        id=sequence_id,
        frame_index=np.arange(T),
        fps=fps,
        people=people,
        camera=CameraTrack(pose, np.ones(T, dtype=bool), K),
        method="PromptHMR",
        by_position=True,
    )


def _person(person: dict[str, Any], path: Path, number: int, T: int) -> PersonTrack:
    rows = frame_numbers(person, "frames", path, T)
    F, world, camera = len(rows), person.get("smplx_world", {}), person.get("smplx_cam", {})
    pose = axis_angles(take(world, "pose", path, (F, 165)))
    orient = from_matrices(take(camera, "rotmat", path, (F, 55, 3, 3))[:, 0])

    def spread(values: FloatArray) -> FloatArray:
        return spread_rows(values, rows, T)

    return PersonTrack(
        track_id=int(person.get("track_id", number)),
        kind="smplx",
        betas=spread(take(world, "shape", path, (F, 10))),
        body_pose=spread(pose[:, 1:22]),
        left_hand_pose=spread(pose[:, 25:40]),
        right_hand_pose=spread(pose[:, 40:55]),
        valid=np.isin(np.arange(T), rows),
        world=Placement(spread(pose[:, 0]), spread(take(world, "trans", path, (F, 3)))),
        camera=Placement(
            spread(orient), spread(take(camera, "trans", path, (F, 3), (F, 1, 3)).reshape(F, 3))
        ),
    )
