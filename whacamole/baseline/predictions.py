"""Predictions on disk: ``PRED/<sequence id>.npz``, the names and frames of the dataset's own files."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from whacamole.baseline.people import PersonEstimate
from whacamole.baseline.recover import Recovery, place_people
from whacamole.baseline.rigid import FloatArray
from whacamole.body import BodyModel

Arrays = dict[str, NDArray[Any]]

_POSES = (
    "body_pose", "left_hand_pose", "right_hand_pose", "jaw_pose", "leye_pose", "reye_pose", "expression",
)  # fmt: skip


def prediction_arrays(
    people: Sequence[PersonEstimate],
    recovery: Recovery,
    frame_index: NDArray[np.int64],
    fps: float,
    K: FloatArray,
    body: BodyModel,
    about: Mapping[str, str],
) -> Arrays:
    """All keys of a prediction (docs/baseline.md lists them).

    Where a person is not valid, the rows hold NaN: nothing is filled in. ``scale`` is NaN where it is not
    known.

    Args:
        people: estimates in the camera frame, at least none.
        about: ``method``, ``ground_truth_used`` and ``notes``.
    """
    T = len(frame_index)
    placed = place_people(people, recovery, body)
    T_world_camera = recovery.T_world_camera.copy()
    T_world_camera[~recovery.camera_valid] = np.nan
    arrays: Arrays = {
        "track_id": np.array([person.track_id for person in people], dtype=np.int64),
        "frame_index": np.asarray(frame_index, dtype=np.int64),
        "fps": np.array(fps),
        "valid": _stack([world.valid for _, world in placed], (T,), np.bool_),
        "detected": _stack([camera.valid for camera, _ in placed], (T,), np.bool_),
        "T_world_camera": T_world_camera,
        "camera_valid": recovery.camera_valid,
        "scale": np.array(recovery.scale),
        "K": K,
        "body_model": np.array(body.name),
        "body_model_sha256": np.array(body.sha256),
        **{key: np.array(value) for key, value in about.items()},
    }
    shapes = [person.params.betas for person in people]
    per_frame = any(betas.ndim == 2 for betas in shapes)
    full = [np.broadcast_to(betas, (T, betas.shape[-1])) if per_frame else betas for betas in shapes]
    arrays["betas"] = _stack(full, (T, 10) if per_frame else (10,), np.float32)
    for name in _POSES:
        values = [_known(getattr(person.params, name), person.valid) for person in people]
        arrays[name] = _stack(values, np.shape(_EMPTY[name]), np.float32, T)
    for frame in ("camera", "world"):
        for name in ("global_orient", "transl"):
            values = []
            for pair in placed:
                estimate = pair[0] if frame == "camera" else pair[1]
                values.append(_known(getattr(estimate.params, name), estimate.valid))
            arrays[f"{name}_{frame}"] = _stack(values, (3,), np.float64, T)
    return arrays


_EMPTY: Mapping[str, FloatArray] = {
    "body_pose": np.zeros((21, 3)),
    "left_hand_pose": np.zeros((15, 3)),
    "right_hand_pose": np.zeros((15, 3)),
    "jaw_pose": np.zeros(3),
    "leye_pose": np.zeros(3),
    "reye_pose": np.zeros(3),
    "expression": np.zeros(10),
}


def _known(values: FloatArray, valid: NDArray[np.bool_]) -> FloatArray:
    shown = values.copy()
    shown[~valid] = np.nan
    return shown


def _stack(
    values: Sequence[NDArray[Any]], tail: tuple[int, ...], dtype: type[np.generic], frames: int | None = None
) -> NDArray[Any]:
    """Stack over the people; with nobody, an array of the right shape with no rows."""
    if values:
        stacked: NDArray[Any] = np.stack(values).astype(dtype)
        return stacked
    return np.zeros((0, *(() if frames is None else (frames,)), *tail), dtype=dtype)


def write_prediction(path: Path, arrays: Mapping[str, Any]) -> None:
    """Write a prediction; complete or not at all."""
    from whacamole.dataset.files import write_arrays

    path.parent.mkdir(parents=True, exist_ok=True)
    write_arrays(path, arrays)
