"""TRAM: ``camera.npy`` and ``hps/hps_track_*.npy`` of its demo."""

from pathlib import Path
from typing import Any

import numpy as np

from whacamole.errors import EvaluationError
from whacamole.evaluation.io import inert
from whacamole.evaluation.io.arrays import (
    frame_numbers,
    from_matrices,
    intrinsics,
    poses,
    read_npz,
    spread_rows,
    take,
)
from whacamole.evaluation.records import CameraTrack, PersonTrack, Placement, Recording


def read_tram(folder: Path, sequence_id: str, fps: float) -> Recording:
    """Read a result folder: SMPL, neutral, in the camera's frame, and a metric camera.

    The world follows from the two, x_world = R_cam x + T_cam, as in TRAM's own evaluation.

    Raises:
        EvaluationError: a file is missing or cannot be used; one line.
    """
    camera_path = folder / "camera.npy"
    camera = _dict(camera_path)
    centres = take(camera, "pred_cam_T", camera_path, (None, 3))
    T = len(centres)
    pose = poses(take(camera, "pred_cam_R", camera_path, (T, 3, 3)), centres)
    K = None
    if "img_focal" in camera and "img_center" in camera:
        K = intrinsics(take(camera, "img_focal", camera_path), take(camera, "img_center", camera_path), T)
    files = sorted((folder / "hps").glob("hps_track_*.npy"), key=lambda p: int(p.stem.rsplit("_", 1)[1]))
    if not files:
        raise EvaluationError(f"{folder}: no hps/hps_track_*.npy; give the folder that TRAM's demo wrote")
    people = tuple(_person(_dict(file), file, number, T) for number, file in enumerate(files))
    return Recording(
        id=sequence_id,
        frame_index=np.arange(T),
        fps=fps,
        people=people,
        camera=CameraTrack(pose, np.ones(T, dtype=bool), K),
        method="TRAM",
        by_position=True,
    )


def _dict(path: Path) -> dict[str, Any]:
    value = read_npz(path) if path.suffix == ".npz" else inert.load(path)
    if not isinstance(value, dict):
        raise EvaluationError(f"{path}: holds no dictionary; give the file that TRAM's demo wrote")
    return value


def _person(values: dict[str, Any], path: Path, number: int, T: int) -> PersonTrack:
    rows = frame_numbers(values, "frame", path, T)
    F = len(rows)
    rotations = spread_rows(from_matrices(take(values, "pred_rotmat", path, (F, 24, 3, 3))), rows, T)
    transl = take(values, "pred_trans", path, (F, 3), (F, 1, 3)).reshape(F, 3)
    return PersonTrack(
        track_id=number,
        kind="smpl",
        betas=spread_rows(take(values, "pred_shape", path, (F, 10)), rows, T),
        body_pose=rotations[:, 1:],
        valid=np.isin(np.arange(T), rows),
        camera=Placement(rotations[:, 0], spread_rows(transl, rows, T)),
    )
