"""All labels of one sequence, from the take and the rendered frames."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from camera_rigs import Plan
from render_jobs import PASSES
from render_jobs.images import read_exr
from whacamole.body import BodyModel
from whacamole.dataset import SequenceLayout
from whacamole.dataset.files import write_arrays, write_json
from whacamole.labels import FrameImages, LabelledPerson, label_sequence
from whacamole.labels.camera import Film
from whacamole.labels.people import WorldMesh
from whacamole.take import Performer, Take

__all__ = ["write_labels"]


def write_labels(
    take: Take,
    plan: Plan,
    body: BodyModel,
    frames: Path,
    sequence: SequenceLayout,
    film: Film,
    ready: Callable[[int], None],
    on_frame: Callable[[int], None],
) -> dict[str, NDArray[Any]]:
    """Write the three ``.npz`` files and ``shot.json``; return the arrays of ``people.npz``.

    Args:
        frames: folder of the rendered passes.
        film: how they were exposed.
        ready: called before the images of a frame are read; returns when they are there.
        on_frame: told after each frame.
    """

    def images(frame: int) -> FrameImages:
        ready(frame)
        mask = np.asarray(Image.open(frames / PASSES["mask"].file(frame)))
        return FrameImages(mask, read_exr(frames / PASSES["depth"].file(frame))["Z"])

    people = [_labelled(person) for person in take.performers]
    labels = label_sequence(people, body, plan.path, images, film=film, on_frame=on_frame)
    write_arrays(sequence.camera, labels.camera)
    write_arrays(sequence.people, labels.people)
    write_arrays(sequence.contact, labels.contact)
    write_json(sequence.shot, plan.to_json())
    return labels.people


def _labelled(person: Performer) -> LabelledPerson:
    inner = person.params.slice(1, person.params.num_frames - 1)
    return LabelledPerson(person.track_id, person.motion_id, person.role.gender, inner, _worn(person))


def _worn(person: Performer) -> Callable[[int], list[WorldMesh]] | None:
    """Return the clothes and hair of a frame; the first mesh of a performer is the skin."""
    if len(person.meshes) == 1:
        return None
    worn = [(mesh, _triangles(mesh.faces)) for mesh in person.meshes[1:]]
    return lambda frame: [(mesh.frame(frame), triangles) for mesh, triangles in worn]


def _triangles(faces: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return (F, 3) triangles of (F, 3) or (F, 4) faces; −1 in the fourth column marks a triangle."""
    if faces.shape[1] == 3:
        return faces
    quads = faces[faces[:, 3] >= 0]
    return np.concatenate([faces[:, :3], quads[:, [0, 2, 3]]])
