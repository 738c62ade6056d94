"""All labels of one sequence, from the take and the rendered frames."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from camera_rigs import Plan
from render_jobs import PASSES, read_exr
from whacamole.body import BodyModel
from whacamole.dataset import SequenceLayout
from whacamole.dataset.files import write_arrays, write_json
from whacamole.labels.camera import camera_arrays
from whacamole.labels.contact import contact_arrays
from whacamole.labels.overlay import preview_strip
from whacamole.labels.people import FrameImages, LabelledPerson, PeopleLabels, WorldMesh
from whacamole.recipe import Recipe
from whacamole.take import Performer, Take

__all__ = ["label_sequence"]


def label_sequence(
    take: Take, plan: Plan, body: BodyModel, frames: Path, recipe: Recipe, sequence: SequenceLayout
) -> dict[str, NDArray[Any]]:
    """Write ``camera.npz``, ``people.npz``, ``contact.npz``, ``shot.json`` and ``preview.jpg``.

    Args:
        frames: folder of the rendered passes.

    Returns:
        The arrays of ``people.npz``.
    """
    write_arrays(sequence.camera, camera_arrays(plan.path))
    write_json(sequence.shot, plan.to_json())
    labels = PeopleLabels([_labelled(person, take) for person in take.performers], body, plan.path)
    for frame in range(take.num_frames):
        images = FrameImages(
            mask=np.asarray(Image.open(frames / PASSES["mask"].file(frame))),
            depth=read_exr(frames / PASSES["depth"].file(frame))["Z"],
        )
        labels.add(frame, [person.posed.vertices[frame + 1] for person in take.performers], images)
    people = labels.arrays()
    write_arrays(sequence.people, people)
    write_arrays(sequence.contact, contact_arrays(take, body))
    preview_strip(sequence, frames, recipe.image_format)
    return people


def _labelled(person: Performer, take: Take) -> LabelledPerson:
    inner = person.params.slice(1, person.params.num_frames - 1)
    return LabelledPerson(person.track_id, take.motion.id, person.role.gender, inner, _worn(person))


def _worn(person: Performer) -> Callable[[int], list[WorldMesh]] | None:
    """Return the clothes and hair of a frame; the first mesh of a performer is the body."""
    if len(person.meshes) == 1:
        return None
    return lambda frame: [(mesh.frame(frame), mesh.faces) for mesh in person.meshes[1:]]
