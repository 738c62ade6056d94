"""This project's predictions: ``PRED/<sequence id>.npz``, the names and frames of the dataset's own files."""

from pathlib import Path
from typing import Any

import numpy as np

from whacamole.errors import EvaluationError
from whacamole.evaluation.core.alignment import FloatArray
from whacamole.evaluation.io.arrays import read_npz, take, text, whole_numbers
from whacamole.evaluation.records import CameraTrack, GroundContact, PersonTrack, Placement, Recording

_PER_FRAME = {
    "left_hand_pose": (15, 3), "right_hand_pose": (15, 3), "jaw_pose": (3,), "leye_pose": (3,),
    "reye_pose": (3,), "expression": (10,),
}  # fmt: skip


def read_native(path: Path, sequence_id: str, fps: float) -> Recording:
    """Read one file of arrays.

    Needed: ``frame_index`` (T,), and people (``track_id`` (P,), ``betas`` (P, 10) or (P, T, 10),
        ``body_pose``
    (P, T, 21, 3), ``global_orient_…`` and ``transl_…`` (P, T, 3) for ``world``, ``camera`` or both) or a
    camera (``T_world_camera`` (T, 4, 4)). May be there: hands, jaw, eyes, expression, ``valid`` (P, T),
    ``camera_valid`` (T,), ``K``, ``ground_contact`` (P, T, C) with ``part_names`` (C,),
    ``body_model_sha256``, ``gender``, ``method``, ``ground_truth_used``.

    Raises:
        EvaluationError: the file cannot be used; one line.
    """
    values = read_npz(path)
    frame_index = whole_numbers(values, "frame_index", path, (None,))
    if (np.diff(frame_index) <= 0).any():
        raise EvaluationError(f"{path}: 'frame_index' does not ascend; sort the frames")
    T = len(frame_index)
    people = people_of(values, path, T) if "body_pose" in values else ()
    camera = camera_of(values, path, T)
    if not people and camera is None:
        raise EvaluationError(f"{path}: neither people (body_pose) nor a camera (T_world_camera)")
    return Recording(
        id=sequence_id,
        frame_index=frame_index,
        fps=fps,
        people=people,
        camera=camera,
        contact=contact_of(values, "ground_contact"),
        method=text(values, "method"),
        ground_truth_used=text(values, "ground_truth_used"),
    )


def people_of(values: dict[str, Any], path: Path, T: int) -> tuple[PersonTrack, ...]:
    """The people of a file in the dataset's names.

    Raises:
        EvaluationError: a key is absent or has a wrong shape.
    """
    P = len(take(values, "body_pose", path, (None, T, 21, 3)))
    body_pose = take(values, "body_pose", path, (P, T, 21, 3))
    betas = take(values, "betas", path, (P, 10), (P, T, 10))
    given = {key: take(values, key, path, (P, T, *tail)) for key, tail in _PER_FRAME.items() if key in values}
    valid = take(values, "valid", path, (P, T), default=np.ones((P, T))).astype(bool)
    placed = {space: _placements(values, space, path, P, T) for space in ("world", "camera")}
    if placed["world"] is None and placed["camera"] is None:
        raise EvaluationError(
            f"{path}: no global_orient_world/transl_world and no global_orient_camera/transl_camera"
        )
    track_id = whole_numbers(values, "track_id", path, (P,), default=np.arange(1, P + 1))
    genders = np.broadcast_to(np.asarray(values.get("gender", "neutral")).astype(str), (P,))
    return tuple(
        PersonTrack(
            track_id=int(track_id[i]),
            kind="smplx",
            betas=betas[i],
            body_pose=body_pose[i],
            valid=valid[i],
            world=None if placed["world"] is None else placed["world"][i],
            camera=None if placed["camera"] is None else placed["camera"][i],
            gender=str(genders[i]),
            model_sha256=text(values, "body_model_sha256"),
            **{key: array[i] for key, array in given.items()},
        )
        for i in range(P)
    )


def _placements(values: dict[str, Any], space: str, path: Path, P: int, T: int) -> list[Placement] | None:
    orient, transl = f"global_orient_{space}", f"transl_{space}"
    if orient not in values and transl not in values:
        return None
    both: list[FloatArray] = [take(values, key, path, (P, T, 3)) for key in (orient, transl)]
    return [Placement(both[0][i], both[1][i]) for i in range(P)]


def camera_of(values: dict[str, Any], path: Path, T: int) -> CameraTrack | None:
    """The camera of a file in the dataset's names, ``None`` without ``T_world_camera``."""
    if "T_world_camera" not in values:
        return None
    pose = take(values, "T_world_camera", path, (T, 4, 4))
    valid = take(values, "camera_valid", path, (T,), default=np.ones(T)).astype(bool)
    K = take(values, "K", path, (T, 3, 3)) if "K" in values else None
    return CameraTrack(pose, valid, K)


def contact_of(values: dict[str, Any], key: str) -> GroundContact | None:
    """Labels of ground contact, ``None`` where the file has none."""
    if key not in values or "part_names" not in values:
        return None
    return GroundContact(
        tuple(str(name) for name in values["part_names"]), np.asarray(values[key]).astype(bool)
    )
