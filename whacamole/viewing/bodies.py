"""The people of a sequence or of a prediction, posed frame by frame, ready to be drawn."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from whacamole.body import BodyModel, BodyParams
from whacamole.dataset import Sequence
from whacamole.errors import DatasetError

__all__ = ["Actor", "ContactPoints", "actors_of", "contact_points", "model_for"]

Floats = NDArray[np.float64]
Float32s = NDArray[np.float32]


@dataclass(frozen=True, eq=False)
class Actor:
    """One person over the frames of a sequence.

    Attributes:
        track_id: the person's.
        params: in the world, T frames; where not ``valid`` they may hold anything finite.
        valid: (T,) whether the person is to be drawn.
        model: the body model of the parameters.
    """

    track_id: int
    params: BodyParams
    valid: NDArray[np.bool_]
    model: BodyModel

    def vertices(self, frame: int) -> Float32s:
        """All vertices (V, 3) of a frame in the world [m]."""
        posed: Float32s = self.model.pose(self.params.slice(frame, frame + 1)).vertices[0]
        return posed

    def pelvis(self) -> Floats:
        """The pelvis joint (T, 3) in the world [m], NaN where not valid."""
        joints = self.model.pose_joints(self.params)[:, 0]
        return np.where(self.valid[:, None], joints, np.nan)


@dataclass(frozen=True, eq=False)
class ContactPoints:
    """The vertices of all people that touch something in one frame.

    Attributes:
        ground: (n, 3) those within the ground's threshold [m].
        person: (m, 3) the others, which touch a person [m].
    """

    ground: Float32s
    person: Float32s


def model_for(sequence: Sequence, path: Path | None) -> BodyModel:
    """Return the body model that a sequence's labels refer to: the embedded one, or that of ``path``.

    Raises:
        DatasetError: the labels are about another model.
        BodyModelError: the file cannot be used.
    """
    model = BodyModel.embedded() if path is None else BodyModel.load(path)
    stated, name = str(sequence.people["body_model_sha256"]), str(sequence.people["body_model"])
    if not model.matches(stated):
        given = "the included body" if path is None else str(path)
        raise DatasetError(
            f"{sequence.layout.people}: labels are about the body model {name} of sha256 {stated[:12]}, not "
            f"about {given} ({model.sha256[:12]}); give its file with --body-model, or view it with the "
            "version of whacamole that made it"
        )
    return model


def actors_of(sequence: Sequence, model: BodyModel) -> list[Actor]:
    """The labelled people, drawn in every frame: a person out of view is still in the world."""
    people = sequence.people
    everywhere = np.ones(len(sequence), dtype=np.bool_)
    return [
        Actor(int(track_id), BodyParams.from_arrays(people, "world", number), everywhere, model)
        for number, track_id in enumerate(people["track_id"])
    ]


def contact_points(contact: Mapping[str, NDArray[Any]], posed: list[Float32s], frame: int) -> ContactPoints:
    """The touching vertices of a frame.

    Args:
        contact: arrays of ``contact.npz``.
        posed: vertices (V, 3) of each person in the world [m].
        frame: which.
    """
    found = []
    for number, vertices in enumerate(posed):
        bits = np.unpackbits(contact["vertex_contact"][number, frame])[: len(vertices)]
        found.append(vertices[bits.astype(np.bool_)])
    points = np.concatenate(found) if found else np.zeros((0, 3), np.float32)
    on_ground = points[:, 2] <= float(contact["ground_threshold"])
    return ContactPoints(points[on_ground], points[~on_ground])
