"""A method's people and camera, brought into the world of the labels for looking at."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from whacamole.body import NUM_BETAS, BodyModel, BodyParams
from whacamole.dataset import Sequence
from whacamole.errors import EvaluationError
from whacamole.evaluation.bodies import full_expression
from whacamole.evaluation.io.predictions import PredictionFolder
from whacamole.evaluation.records import PersonTrack, Recording
from whacamole.viewing.bodies import Actor, Floats

__all__ = ["Alignment", "Prediction", "read_prediction"]

Alignment = Literal["camera", "stored"]
Bools = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Prediction:
    """A prediction in the world of the labels.

    Attributes:
        actors: its people.
        T_world_camera: (T, 4, 4), NaN where there is no camera.
        method: its name, "" where it gives none.
        notes: how it was placed and what was left out, a sentence each.
    """

    actors: list[Actor]
    T_world_camera: Floats
    method: str
    notes: tuple[str, ...]


def read_prediction(folder: Path, sequence: Sequence, model: BodyModel, align: Alignment) -> Prediction:
    """Read the prediction of a sequence, in any format that `evaluate` reads.

    Args:
        align: "camera" moves the prediction as a rigid whole, unscaled, so that its first camera is the true
            camera of that frame; "stored" leaves its numbers alone.

    Raises:
        EvaluationError: there is no prediction of this sequence, or nothing in it can be drawn.
    """
    read = PredictionFolder(folder).read(sequence.id, float(sequence.facts["fps"]))
    rows = _rows(read, sequence)
    camera = np.full((len(sequence), 4, 4), np.nan)
    if read.camera is not None:
        kept = read.camera.valid[rows.there]
        camera[rows.here[kept]] = read.camera.T_world_camera[rows.there[kept]]
    move, placed = _move(camera, sequence.camera["T_world_camera"], align)
    actors, notes = [], [placed]
    for person in read.people:
        actor = _actor(person, rows, sequence, model, move)
        if isinstance(actor, Actor):
            actors.append(actor)
        else:
            notes.append(actor)
    if not actors and np.isnan(camera).all():
        raise EvaluationError(f"{folder}: {sequence.id}: nothing to draw ({'; '.join(notes[1:]) or 'empty'})")
    if any(person.model_sha256 and not model.matches(person.model_sha256) for person in read.people):
        notes.append("It names another body model; it is drawn with that of the labels.")
    return Prediction(actors, move @ camera, read.method, tuple(notes))


@dataclass(frozen=True, eq=False)
class _Rows:
    """Which row of a prediction is which frame of the sequence."""

    here: NDArray[np.intp]
    there: NDArray[np.intp]


def _rows(read: Recording, sequence: Sequence) -> _Rows:
    numbers = np.arange(len(sequence)) if read.by_position else sequence.camera["frame_index"]
    _, here, there = np.intersect1d(numbers, read.frame_index, return_indices=True)
    if not len(here):
        raise EvaluationError(
            f"{sequence.id}: the prediction's frames {read.frame_index[0]} to {read.frame_index[-1]} are "
            f"none of the sequence's {numbers[0]} to {numbers[-1]}"
        )
    return _Rows(here, there)


def _move(predicted: Floats, true: NDArray[Any], align: Alignment) -> tuple[Floats, str]:
    """The transform (4, 4) to apply, and the sentence that says so."""
    frames = np.flatnonzero(np.isfinite(predicted).all(axis=(1, 2)))
    if align == "stored" or not len(frames):
        why = "as stored" if align == "stored" else "as stored, as it has no camera to align by"
        return np.eye(4), f"Its world is drawn {why}."
    first = int(frames[0])
    move = true[first] @ np.linalg.inv(predicted[first])
    move[:3, :3] = Rotation.from_matrix(move[:3, :3]).as_matrix()  # rid of the rounding of float32
    return move, f"Its world is moved, unscaled, so that its camera is the true one in frame {first}."


def _actor(
    person: PersonTrack, rows: _Rows, sequence: Sequence, model: BodyModel, move: Floats
) -> Actor | str:
    """A person in the world of the labels, or the reason why there is none."""
    if person.kind != "smplx":
        return f"Track {person.track_id} is in {person.kind.upper()} parameters and is not drawn."
    placement = person.world or person.camera
    if placement is None:
        return f"Track {person.track_id} has no place and is not drawn."
    T = len(sequence)
    valid = np.zeros(T, dtype=np.bool_)
    valid[rows.here] = person.valid[rows.there]
    columns = {
        "expression": full_expression(person.expression, len(person.valid)), "transl": placement.transl,
        "global_orient": placement.orient, "body_pose": person.body_pose[:, :21],
        "jaw_pose": person.jaw_pose, "leye_pose": person.leye_pose, "reye_pose": person.reye_pose,
        "left_hand_pose": _hand(person.left_hand_pose), "right_hand_pose": _hand(person.right_hand_pose),
    }  # fmt: skip
    blank = BodyParams.zeros(T)
    values: dict[str, Any] = {}
    for name, column in columns.items():
        filled = getattr(blank, name).copy()
        if column is not None:
            filled[rows.here] = np.nan_to_num(column[rows.there])
        values[name] = filled
    params = BodyParams(betas=_betas(person, rows, T), **values)
    pelvis = model.rest_joints(params.betas)[..., 0, :]
    placing = move if person.world is not None else sequence.camera["T_world_camera"]
    return Actor(person.track_id, params.transformed(placing, pelvis), valid, model)


def _hand(pose: Floats | None) -> Floats | None:
    """Axis angles; principal components need the model's own basis and are left out: flat hands."""
    return pose if pose is not None and pose.ndim == 3 else None


def _betas(person: PersonTrack, rows: _Rows, T: int) -> Floats:
    betas = np.nan_to_num(person.betas)[..., :NUM_BETAS]
    betas = np.pad(betas, [(0, 0)] * (betas.ndim - 1) + [(0, NUM_BETAS - betas.shape[-1])])
    if betas.ndim == 1:
        return betas
    filled = np.zeros((T, NUM_BETAS))
    filled[rows.here] = betas[rows.there]
    return filled
