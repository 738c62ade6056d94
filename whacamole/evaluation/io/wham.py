"""WHAM: ``wham_output.pkl`` of its demo (joblib)."""

from pathlib import Path

import numpy as np

from whacamole.errors import EvaluationError
from whacamole.evaluation.io import inert
from whacamole.evaluation.io.arrays import axis_angles, frame_numbers, spread_rows, take
from whacamole.evaluation.records import PersonTrack, Placement, Recording


def read_wham(path: Path, sequence_id: str, fps: float) -> Recording:
    """Read a result: by track ``pose``, ``trans`` (camera), ``pose_world``, ``trans_world``, ``betas``,
    ``frame_ids``.

    SMPL, neutral. The world is each track's own and has no camera.

    Raises:
        EvaluationError: the file cannot be used; one line.
    """
    tracks = inert.load(path)
    if not isinstance(tracks, dict) or not tracks or not all(isinstance(t, dict) for t in tracks.values()):
        raise EvaluationError(
            f"{path}: holds no tracks; give the wham_output.pkl of WHAM's demo (--save_pkl)"
        )
    frames = {key: frame_numbers(track, "frame_ids", path) for key, track in tracks.items()}
    last = max((int(ids.max()) for ids in frames.values() if len(ids)), default=-1)
    people = []
    for number, (key, track) in enumerate(tracks.items()):
        F = len(frames[key])
        widths = {"pose": 72, "pose_world": 72, "trans": 3, "trans_world": 3, "betas": 10}
        arrays = {
            name: spread_rows(take(track, name, path, (F, width)), frames[key], last + 1)
            for name, width in widths.items()
        }
        people.append(
            PersonTrack(
                track_id=int(key) if str(key).isdigit() else number,
                kind="smpl",
                betas=arrays["betas"],
                body_pose=axis_angles(arrays["pose"][:, 3:]),
                valid=np.isin(np.arange(last + 1), frames[key]),
                world=Placement(arrays["pose_world"][:, :3], arrays["trans_world"]),
                camera=Placement(arrays["pose"][:, :3], arrays["trans"]),
            )
        )
    return Recording(
        id=sequence_id,
        frame_index=np.arange(last + 1),
        fps=fps,
        people=tuple(people),
        method="WHAM",
        by_position=True,
    )
