"""Staging: from motions and seeds to a scene that can be filmed."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from camera_rigs import SubjectTrack
from render_jobs import Mesh
from whacamole.body import JOINT_INDEX, BodyModel, BodyParams, Posed, facing
from whacamole.labels.people import stored_params
from whacamole.motion import Motion
from whacamole.seeds import generator
from whacamole.stage import Places, Stage
from whacamole.take.casting import Role, cast_role
from whacamole.take.crowd import Footprint, Placement, place_crowd
from whacamole.take.location import choose_location
from whacamole.take.metering import metered
from whacamole.take.placing import body_params, choose_window, ground_shift, path_scale, scene_transform

__all__ = ["Performer", "Take", "stage_take"]


Draw = Callable[[str], np.random.Generator]
"""Gives the generator for a purpose."""


@dataclass(frozen=True, eq=False)
class Performer:
    """One person of a take, over frames −1 … T (T + 2 of them, one neighbour at either end).

    Attributes:
        track_id: the value of this person in masks and labels, from 1.
        motion_id: where the movement comes from.
        role: who plays: gender, shape, looks.
        params: SMPL-X parameters in the world frame, T + 2 frames.
        posed: body vertices (T + 2, V, 3) and joints (T + 2, 55, 3) in the world frame [m].
        meshes: what is drawn of this person, each with T + 2 frames of vertices, the skin first; none where
            the take is only planned.
    """

    track_id: int
    motion_id: str
    role: Role
    params: BodyParams
    posed: Posed
    meshes: tuple[Mesh, ...]


@dataclass(frozen=True, eq=False)
class Take:
    """A staged scene of T frames.

    Attributes:
        motion: the motion that gives the take its name.
        first_frame: the motion's frame that became frame 0.
        performers: the people, in the order of their track ids.
        stage: the place.
    """

    motion: Motion
    first_frame: int
    performers: tuple[Performer, ...]
    stage: Stage

    @property
    def num_frames(self) -> int:
        """T."""
        return self.performers[0].params.num_frames - 2

    @property
    def subject(self) -> SubjectTrack:
        """What the camera films, frames 0 … T − 1."""
        inner = slice(1, -1)
        joints = [person.posed.joints[inner] for person in self.performers]
        vertices = [person.posed.vertices[inner] for person in self.performers]
        return SubjectTrack.from_people(
            pelvis=np.stack([j[:, JOINT_INDEX["pelvis"]] for j in joints]),
            neck=np.stack([j[:, JOINT_INDEX["neck"]] for j in joints]),
            facing=np.stack([facing(j) for j in joints]),
            box_min=np.stack([v.min(axis=1) for v in vertices]).astype(np.float64),
            box_max=np.stack([v.max(axis=1) for v in vertices]).astype(np.float64),
            fps=self.motion.fps,
        )


@dataclass(frozen=True, eq=False)
class _Scene:
    """The people of one motion, standing on the ground where the motion puts them."""

    motion: Motion
    first: int
    roles: list[Role]
    params: list[BodyParams]
    posed: list[Posed]


def stage_take(
    motion: Motion,
    body: BodyModel,
    *,
    frames: int,
    seed: int,
    shot_index: int,
    textures: Path | None,
    places: Places | None = None,
    companions: Sequence[Motion] = (),
    subdivision: int = 0,
    uv_textures: Path | None = None,
) -> Take:
    """Stage sequence ``shot_index`` of ``motion``.

    Args:
        frames: most frames to film; 0 for the whole motion.
        seed: of the dataset.
        textures: folder for textures made for this take; None stages for planning alone, with nothing drawn.
        places: stages to draw from; none: all built-in ones.
        companions: motions of further people, unrelated to the first; those that find no free place stay out.
        subdivision: levels for skin and clothes.
        uv_textures: the user's folder of pictures for the UV map of the body model.

    Raises:
        TakeError: a motion is too short, no stage has room for it, or ``uv_textures`` has no fitting picture.
    """

    def rng(purpose: str) -> np.random.Generator:
        return generator(seed, motion.id, shot_index, purpose)

    scene = _scene(motion, body, frames, rng, "")
    length = len(scene.posed[0].joints) - 2
    others = [
        _scene(other, body, length, rng, f" companion {number}") for number, other in enumerate(companions)
    ]
    footprints = [Footprint.of(posed) for posed in scene.posed]
    location = choose_location(rng("stage"), places or Places(), footprints)
    placements = place_crowd(
        footprints, [Footprint.of(other.posed[0]) for other in others], rng("crowd"), location.allows
    )
    people = [
        (scene.motion.id, *_moved(person, location.spot, body))
        for person in zip(scene.roles, scene.params, scene.posed, strict=True)
    ]
    for other, placement in zip(others, placements, strict=True):
        if placement is not None:
            person = _moved((other.roles[0], other.params[0], other.posed[0]), placement, body)
            people.append((other.motion.id, *_moved(person, location.spot, body)))
    performers = tuple(
        Performer(
            number,
            motion_id,
            role,
            params,
            posed,
            ()
            if textures is None
            else role.meshes(
                body,
                params,
                textures=textures,
                uv_textures=uv_textures,
                track_id=number,
                subdivision=subdivision,
            ),
        )
        for number, (motion_id, role, params, posed) in enumerate(people, start=1)
    )
    paths = np.concatenate([person.posed.joints[:, 0, :2] for person in performers])
    stage = location.build(paths, textures)
    if location.ground is None:
        tones = [person.role.member.tone for person in performers]
        stage = metered(stage, [person.posed.joints for person in performers], tones)
    return Take(motion, scene.first, performers, stage)


Person = tuple[Role, BodyParams, Posed]


def _moved(person: Person, placement: Placement | None, body: BodyModel) -> Person:
    """Return a person who stands elsewhere, posed anew: bodies follow their parameters to the last bit."""
    if placement is None:
        return person
    role, params, _ = person
    j0 = body.rest_joints(params.betas, params.expression)[..., 0, :]
    moved = params.transformed(placement.as_transform(), j0)
    return role, moved, body.pose(moved)


def _scene(motion: Motion, body: BodyModel, frames: int, rng: Draw, purpose: str) -> _Scene:
    """Cast the people of a motion, cut its window, stand them on the ground in the middle of the stage."""
    window = choose_window(motion.num_frames, frames, rng(f"window{purpose}"))
    roles = [
        cast_role(rng(f"cast {number}{purpose}"), person, body, interactive=motion.interactive)
        for number, person in enumerate(motion.people)
    ]
    whole = [
        body_params(person, body, role.betas, role.relaxed_hands, path_scale(motion, body, role.betas))
        for person, role in zip(motion.people, roles, strict=True)
    ]
    # Rounded as the label file will hold them before anything is posed: labels reproduce the pixels.
    filmed = [stored_params(part.slice(window.start, window.stop)) for part in whole]
    placed = _placed(filmed, body, rng(f"place{purpose}"))
    floating = [body.pose(person) for person in placed]
    shift = np.array([0.0, 0.0, ground_shift(floating)])
    return _Scene(
        motion,
        window.start + 1,
        roles,
        [replace(person, transl=person.transl + shift) for person in placed],
        [Posed(shape.vertices + shift.astype(np.float32), shape.joints + shift) for shape in floating],
    )


def _placed(params: list[BodyParams], body: BodyModel, rng: np.random.Generator) -> list[BodyParams]:
    """Move the scene as one to the middle of the stage, turned by a random angle."""
    rest = [body.rest_joints(person.betas, person.expression)[..., 0, :] for person in params]
    pelvis = np.stack([person.transl + j0 for person, j0 in zip(params, rest, strict=True)])
    transform = scene_transform(pelvis, float(rng.uniform(0.0, 2.0 * np.pi)))
    return [person.transformed(transform, j0) for person, j0 in zip(params, rest, strict=True)]
