"""Putting a motion into the world: which part of it, on whose legs, where, with the feet on the ground."""

import numpy as np
from numpy.typing import NDArray

from whacamole.body import BodyModel, BodyParams, Posed
from whacamole.errors import TakeError
from whacamole.motion import Motion, MotionPerson

__all__ = ["GROUND_QUANTILE", "body_params", "choose_window", "ground_shift", "scene_transform"]

GROUND_QUANTILE = 0.1
"""The ground is at this quantile of the lowest points of the frames: above the noise of single frames, below
the flight of a run or a jump."""

NOMINAL_PELVIS_HEIGHT = 0.974
"""Pelvis above the soles of the mean SMPL-X body [m], the size that motions of unknown shape get."""


def choose_window(total: int, frames: int, rng: np.random.Generator) -> slice:
    """Return the part of a motion to film, with one frame more at either end.

    The neighbours give the first and the last frame their flow and their velocity, so a motion of N frames
    holds at most N − 2 to film.

    Args:
        total: frames of the motion.
        frames: most frames to film; 0 for all.

    Raises:
        TakeError: the motion is too short.
    """
    if total < 3:
        raise TakeError(f"{total} frames at this frame rate, at least 3 are needed; leave the file out")
    length = min(total, frames + 2) if frames else total
    start = int(rng.integers(0, total - length + 1))
    return slice(start, start + length)


def body_params(
    person: MotionPerson,
    body: BodyModel,
    betas: NDArray[np.float64],
    relaxed_hands: NDArray[np.float64],
    scale: float,
) -> BodyParams:
    """Return the motion of ``person`` on a body of shape ``betas``.

    Args:
        relaxed_hands: (2, 15, 3) left and right pose for motions that carry none.
        scale: factor on the path of the pelvis, so that legs of another length neither slide nor float.
    """
    frames = person.num_frames
    left, right = person.left_hand_pose, person.right_hand_pose
    if not person.has_hands:
        left, right = (np.broadcast_to(pose, (frames, 15, 3)) for pose in relaxed_hands)
    rest_pelvis = body.rest_joints(betas, person.expression)[..., 0, :]
    return BodyParams(
        betas=betas,
        expression=person.expression,
        global_orient=person.global_orient,
        transl=person.pelvis * scale - rest_pelvis,
        body_pose=person.body_pose,
        left_hand_pose=left,
        right_hand_pose=right,
        jaw_pose=person.jaw_pose,
        leye_pose=person.leye_pose,
        reye_pose=person.reye_pose,
    )


def path_scale(motion: Motion, body: BodyModel, betas: NDArray[np.float64]) -> float:
    """Return the factor on a pelvis path for a body of shape ``betas``.

    A single person's path is scaled with the height of the pelvis. People captured together keep theirs:
    where they touch matters more than a foot that slides a centimetre.
    """
    return 1.0 if motion.interactive else body.pelvis_height(betas) / NOMINAL_PELVIS_HEIGHT


def scene_transform(pelvis: NDArray[np.float64], yaw: float) -> NDArray[np.float64]:
    """Return the 4×4 transform that centres a scene on the origin and turns it by ``yaw`` [rad].

    Args:
        pelvis: (P, T, 3) all people's paths; the middle of their bounding rectangle goes to x = y = 0.
    """
    flat = pelvis[..., :2].reshape(-1, 2)
    middle = (flat.min(axis=0) + flat.max(axis=0)) / 2.0
    c, s = np.cos(yaw), np.sin(yaw)
    transform = np.eye(4)
    transform[:2, :2] = [[c, -s], [s, c]]
    transform[:2, 3] = -transform[:2, :2] @ middle
    return transform


def ground_shift(people: list[Posed]) -> float:
    """Return the one vertical shift [m] that stands the scene on z = 0."""
    lowest = np.min([person.vertices[..., 2].min(axis=1) for person in people], axis=0)
    return -float(np.quantile(lowest, GROUND_QUANTILE))
