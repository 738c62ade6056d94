"""All labels of one sequence, from the take and the rendered frames."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from camera_rigs import Plan
from render_jobs import PASSES, Mesh
from render_jobs.images import read_exr
from whacamole.body import BodyModel, triangulated
from whacamole.dataset import SequenceLayout
from whacamole.dataset.files import write_arrays, write_json
from whacamole.labels import FrameImages, LabelledPerson, label_sequence, read_regions
from whacamole.labels.camera import Film
from whacamole.labels.cutout import Cutout
from whacamole.labels.people import WorldMesh
from whacamole.recipe import Recipe
from whacamole.take import Performer, Take

__all__ = ["worn_over", "write_labels"]


def write_labels(
    take: Take,
    plan: Plan,
    body: BodyModel,
    frames: Path,
    sequence: SequenceLayout,
    film: Film,
    ready: Callable[[int], None],
    on_frame: Callable[[int], None],
    recipe: Recipe,
) -> dict[str, NDArray[Any]]:
    """Write the three ``.npz`` files and ``shot.json``; return the arrays of ``people.npz``.

    Args:
        frames: folder of the rendered passes.
        film: how they were exposed.
        ready: called before the images of a frame are read; returns when they are there.
        on_frame: told after each frame.
        recipe: says which contacts are labelled, and by which parts.

    Raises:
        BodyModelError: the region file cannot be used.
    """

    def images(frame: int) -> FrameImages:
        ready(frame)
        mask = np.asarray(Image.open(frames / PASSES["mask"].file(frame)))
        return FrameImages(mask, read_exr(frames / PASSES["depth"].file(frame))["Z"])

    people = [_labelled(person) for person in take.performers]
    parts = None
    if recipe.contact_regions is not None:
        parts = read_regions(recipe.contact_regions, body.num_vertices)
    labels = label_sequence(
        people,
        body,
        plan.path,
        images,
        parts=parts,
        self_contact=recipe.self_contact,
        film=film,
        on_frame=on_frame,
    )
    write_arrays(sequence.camera, labels.camera)
    write_arrays(sequence.people, labels.people)
    write_arrays(sequence.contact, labels.contact)
    write_json(sequence.shot, plan.to_json())
    return labels.people


def _labelled(person: Performer) -> LabelledPerson:
    inner = person.params.slice(1, person.params.num_frames - 1)
    worn = worn_over(person.meshes)
    return LabelledPerson(person.track_id, person.motion_id, person.role.gender, inner, worn)


def worn_over(meshes: Sequence[Mesh]) -> Callable[[int], list[WorldMesh]] | None:
    """Return what gives the clothes and hair of a frame; the first mesh of a performer is the skin."""
    if len(meshes) == 1:
        return None
    worn = [(mesh, triangulated(mesh.faces), _cutout(mesh)) for mesh in meshes[1:]]
    return lambda frame: [WorldMesh(mesh.frame(frame), faces, cutout) for mesh, faces, cutout in worn]


def _cutout(mesh: Mesh) -> Cutout | None:
    """Return what the alpha of a mesh's texture leaves of it, as the renderers cut it."""
    material = mesh.material
    if material.alpha_mode == "opaque" or material.base_color_texture is None or mesh.uv is None:
        return None
    with Image.open(material.base_color_texture) as picture:
        if "A" not in picture.getbands():
            return None
        alpha = np.asarray(picture.getchannel("A"))
    corner = np.where(mesh.faces < 0, -1, np.arange(mesh.faces.size).reshape(mesh.faces.shape))
    uv = mesh.uv.reshape(-1, 2)[triangulated(corner)].astype(np.float64) * material.uv_scale
    return Cutout(alpha, uv)
