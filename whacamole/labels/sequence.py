"""All labels of a sequence in one pass over its frames."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from camera_rigs import CameraPath
from whacamole.body import BodyModel
from whacamole.labels.arrays import AnyArray
from whacamole.labels.camera import Film, camera_arrays
from whacamole.labels.contact import ContactLabels
from whacamole.labels.ground import ContactThresholds
from whacamole.labels.parts import BodyParts
from whacamole.labels.people import FrameImages, LabelledPerson, PeopleLabels, stored_params

_BLOCK = 16  # frames posed at once: bounds the memory of a long sequence

FrameVertices = list[NDArray[np.float32]]


@dataclass(frozen=True, eq=False)
class SequenceLabels:
    """What goes into ``camera.npz``, ``people.npz`` and ``contact.npz``, by key."""

    camera: dict[str, AnyArray]
    people: dict[str, AnyArray]
    contact: dict[str, AnyArray]


def label_sequence(
    people: Sequence[LabelledPerson],
    model: BodyModel,
    camera: CameraPath,
    images: Callable[[int], FrameImages],
    *,
    limits: ContactThresholds | None = None,
    parts: BodyParts | None = None,
    self_contact: bool = False,
    film: Film | None = None,
    on_frame: Callable[[int], None] | None = None,
) -> SequenceLabels:
    """Label every frame of a sequence. Equal input gives equal bytes; few frames are held in memory.

    Args:
        people: P people, world-frame parameters of T frames each.
        model: the body model they all use.
        camera: T frames.
        images: gives the rendered mask (and depth, if any) of a frame; called once a frame, in order.
        limits: what counts as contact.
        parts: body parts for the contact labels; by default those of the model's skinning weights.
        self_contact: also label which parts of a person touch others of their own.
        film: how the pictures were exposed.
        on_frame: told after each frame.

    Raises:
        ValueError: frame counts, image sizes or track ids do not fit together.
    """
    rounded = [replace(person, params=stored_params(person.params)) for person in people]
    seen = PeopleLabels(rounded, model, camera)
    touched = ContactLabels(
        model,
        len(people),
        camera.num_frames,
        camera.fps,
        limits=limits,
        parts=parts,
        self_contact=self_contact,
    )
    for frame, (before, now, after) in enumerate(_windows(posed_frames(rounded, model))):
        seen.add(frame, now, images(frame))
        touched.add(frame, before, now, after)
        if on_frame is not None:
            on_frame(frame)
    return SequenceLabels(camera_arrays(camera, film), seen.arrays(), touched.arrays())


def posed_frames(people: Sequence[LabelledPerson], model: BodyModel) -> Iterator[FrameVertices]:
    """The vertices ``(V, 3)`` of each person in the world, frame by frame, posed in blocks."""
    frames = people[0].params.num_frames if people else 0
    for start in range(0, frames, _BLOCK):
        blocks = [model.pose(person.params.slice(start, start + _BLOCK)).vertices for person in people]
        for offset in range(len(blocks[0])):
            yield [block[offset] for block in blocks]


def _windows(
    frames: Iterator[FrameVertices],
) -> Iterator[tuple[FrameVertices | None, FrameVertices, FrameVertices | None]]:
    """Each frame with its neighbours: (previous, this, next), None beyond the ends."""
    before: FrameVertices | None = None
    now = next(frames, None)
    while now is not None:
        after = next(frames, None)
        yield before, now, after
        before, now = now, after
