"""Staging: from a motion and seeds to a scene that can be filmed."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from camera_rigs import SubjectTrack
from render_jobs import Mesh
from whacamole.body import JOINT_INDEX, BodyModel, BodyParams, Posed, facing
from whacamole.labels.people import stored_params
from whacamole.motion import Motion
from whacamole.seeds import generator
from whacamole.stage import Stage, stage_rand
from whacamole.take.casting import Role, cast_role
from whacamole.take.placing import body_params, choose_window, ground_shift, path_scale, scene_transform

__all__ = ["Performer", "Take", "stage_take"]


@dataclass(frozen=True, eq=False)
class Performer:
    """One person of a take, over frames −1 … T (T + 2 of them, one neighbour at either end).

    Attributes:
        track_id: the value of this person in masks and labels, from 1.
        role: who plays: gender, shape, looks.
        params: SMPL-X parameters in the world frame, T + 2 frames.
        posed: body vertices (T + 2, V, 3) and joints (T + 2, 55, 3) in the world frame [m].
        meshes: what is drawn of this person, each with T + 2 frames of vertices.
    """

    track_id: int
    role: Role
    params: BodyParams
    posed: Posed
    meshes: tuple[Mesh, ...]


@dataclass(frozen=True, eq=False)
class Take:
    """A staged scene of T frames.

    Attributes:
        motion: where the movement comes from.
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


def stage_take(
    motion: Motion,
    body: BodyModel,
    *,
    frames: int,
    seed: int,
    shot_index: int,
    textures: Path,
    stages: tuple[str, ...] = (),
) -> Take:
    """Stage sequence ``shot_index`` of ``motion``.

    Args:
        frames: most frames to film; 0 for the whole motion.
        seed: of the dataset.
        textures: folder for texture files that the stage paints.
        stages: names of stages to draw from; none: all.

    Raises:
        TakeError: the motion is too short.
    """

    def rng(purpose: str) -> np.random.Generator:
        return generator(seed, motion.id, shot_index, purpose)

    window = choose_window(motion.num_frames, frames, rng("window"))
    roles = [
        cast_role(rng(f"cast {index}"), person, body, interactive=motion.interactive)
        for index, person in enumerate(motion.people)
    ]
    whole = [
        body_params(person, body, role.betas, role.relaxed_hands, path_scale(motion, body, role.betas))
        for person, role in zip(motion.people, roles, strict=True)
    ]
    # Rounded as the label file will hold them before anything is posed: labels reproduce the pixels.
    filmed = [stored_params(part.slice(window.start, window.stop)) for part in whole]
    params = _placed(filmed, body, rng("place"))
    performers = _performed(params, roles, body)
    paths = np.concatenate([person.posed.joints[:, 0, :2] for person in performers])
    stage = stage_rand(rng("stage"), paths, textures, stages)
    return Take(motion, window.start + 1, performers, stage)


def _placed(params: list[BodyParams], body: BodyModel, rng: np.random.Generator) -> list[BodyParams]:
    """Move the scene as one to the middle of the stage, turned by a random angle."""
    rest = [body.rest_joints(person.betas, person.expression)[..., 0, :] for person in params]
    pelvis = np.stack([person.transl + j0 for person, j0 in zip(params, rest, strict=True)])
    transform = scene_transform(pelvis, float(rng.uniform(0.0, 2.0 * np.pi)))
    return [person.transformed(transform, j0) for person, j0 in zip(params, rest, strict=True)]


def _performed(params: list[BodyParams], roles: list[Role], body: BodyModel) -> tuple[Performer, ...]:
    """Pose and dress everybody, and stand the scene on the ground by one vertical shift."""
    floating = [body.pose(person) for person in params]
    shift = np.array([0.0, 0.0, ground_shift(floating)])
    performers = []
    for index, (person, role, shape) in enumerate(zip(params, roles, floating, strict=True)):
        standing = Posed(shape.vertices + shift.astype(np.float32), shape.joints + shift)
        meshes = role.meshes(body, standing, index + 1)
        moved = replace(person, transl=person.transl + shift)
        performers.append(Performer(index + 1, role, moved, standing, meshes))
    return tuple(performers)
