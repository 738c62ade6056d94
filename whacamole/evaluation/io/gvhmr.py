"""GVHMR (and GENMO, which writes the same): ``hmr4d_results.pt`` of its demo (torch)."""

from pathlib import Path
from typing import Any

import numpy as np

from whacamole.errors import EvaluationError
from whacamole.evaluation.io import inert
from whacamole.evaluation.io.arrays import axis_angles, take
from whacamole.evaluation.records import PersonTrack, Placement, Recording


def read_gvhmr(path: Path, sequence_id: str, fps: float) -> Recording:
    """Read a result: ``smpl_params_global`` and ``smpl_params_incam``, SMPL-X, neutral, one person, no camera
    path.

    Raises:
        EvaluationError: the file cannot be used; one line.
    """
    values = inert.load(path)
    keys = ("smpl_params_global", "smpl_params_incam")
    both: list[Any] = [values.get(key) if isinstance(values, dict) else None for key in keys]
    if not all(isinstance(params, dict) for params in both):
        raise EvaluationError(
            f"{path}: no smpl_params_global and smpl_params_incam; give GVHMR's hmr4d_results.pt"
        )
    world, camera = both
    T = len(take(world, "transl", path, (None, 3)))
    person = PersonTrack(
        track_id=0,
        kind="smplx",
        betas=take(camera, "betas", path, (T, 10), (10,)),
        body_pose=axis_angles(take(camera, "body_pose", path, (T, 63))),
        valid=np.ones(T, dtype=bool),
        world=_placement(world, path, T),
        camera=_placement(camera, path, T),
    )
    return Recording(
        id=sequence_id, frame_index=np.arange(T), fps=fps, people=(person,), method="GVHMR", by_position=True
    )


def _placement(params: Any, path: Path, T: int) -> Placement:
    return Placement(take(params, "global_orient", path, (T, 3)), take(params, "transl", path, (T, 3)))
