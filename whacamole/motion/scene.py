"""From the people of a file to a :class:`Motion`: one frame rate, z up, near the ground."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from whacamole.errors import MotionError
from whacamole.motion import skeleton, up_axis
from whacamole.motion.data import FPS, FloatArray, Motion, MotionPerson
from whacamole.motion.rate import Resampler, rational_rate
from whacamole.motion.reader import NUM_BODY, NUM_HAND, RawPerson

RestPelvis = Callable[[str, str, FloatArray], FloatArray]
"""(model, gender, betas) to the rest pelvis j0 (3,) [m] of the model the file was made with."""

MAX_LENGTH_DIFFERENCE = 5
"""Frames by which the two takes of a pair may differ; the longer is cut."""

_HAND_MOVES = 0.02


def nominal_rest_pelvis(model: str, _gender: str, _betas: FloatArray) -> FloatArray:
    """Rest pelvis of the mean shape of ``model``, for when the model itself is not at hand.

    The error is constant over the motion: it moves a single person by nothing that matters (the scene is
    placed anyway) and the people of a pair against each other by the difference of their rest pelvises, a
    few centimetres at most.
    """
    return np.array(skeleton.SOURCE_REST_PELVIS[model])


def build_motion(
    raw: tuple[RawPerson, ...],
    *,
    id: str,  # noqa: A002
    source: str,
    path: Path,
    licence: str,
    convention: str,
    stated: bool = True,
    up: str | None = None,
    rest_pelvis: RestPelvis = nominal_rest_pelvis,
    fps: float = FPS,
) -> Motion:
    """One scene from ``raw``; ``up``, one of :data:`up_axis.AXES`, overrides convention and content.

    Raises :class:`MotionError` where the takes of a pair differ in length, or nothing is left at ``fps``.
    """
    people = _equal_lengths([_resample(person, rest_pelvis, fps) for person in raw], path)
    joints, points = _pose(people)
    axis = up or up_axis.choose(convention, joints, points, fps=fps, stated=stated)
    people = [_turn(person, up_axis.to_z_up(axis)) for person in people]
    _, points = _pose(people)
    floor = float(np.percentile((points[..., 2] - skeleton.TOUCH_RADII).min(axis=(0, 2)), 2.0))
    grounded = tuple(replace(p, pelvis=p.pelvis - np.array([0.0, 0.0, floor])) for p in people)
    return Motion(id, source, path, grounded, len(grounded) > 1, licence, axis, fps)


def _pose(people: list[MotionPerson]) -> tuple[FloatArray, FloatArray]:
    """Joints ``(P,T,22,3)`` and touch points ``(P,T,C,3)`` of the nominal skeleton."""
    posed = [skeleton.forward(p.global_orient, p.body_pose, p.pelvis) for p in people]
    joints = np.stack([joints for joints, _ in posed])
    return joints, np.stack([skeleton.touch_points(*pose) for pose in posed])


def _resample(raw: RawPerson, rest_pelvis: RestPelvis, fps: float) -> MotionPerson:
    resampler = Resampler(len(raw.pose), raw.rate, rational_rate(fps))
    T = resampler.num_frames
    if T < 2:
        raise MotionError(f"{raw.where}: shorter than two frames at {fps:g} fps; give a longer motion")
    pose = resampler.rotations(raw.pose)
    jaw, leye, reye, left, right = _face_and_hands(pose)
    expression = np.zeros((T, 10))
    if raw.expression is not None:
        given = resampler.linear(raw.expression)[:, :10]
        expression[:, : given.shape[1]] = given
    fingers = np.concatenate([left, right], axis=1)
    return MotionPerson(
        gender=raw.gender,
        betas=raw.betas,
        global_orient=pose[:, 0],
        pelvis=resampler.linear(raw.trans) + rest_pelvis(raw.model, raw.gender, raw.betas),
        body_pose=pose[:, 1 : 1 + NUM_BODY],
        left_hand_pose=left,
        right_hand_pose=right,
        jaw_pose=jaw,
        leye_pose=leye,
        reye_pose=reye,
        expression=expression,
        has_hands=bool(np.ptp(fingers, axis=0).max() > _HAND_MOVES),
        shape_space=raw.model,
    )


def _face_and_hands(pose: FloatArray) -> tuple[FloatArray, ...]:
    """Jaw, eyes and fingers of a pose of 22, 52 or 55 joints; zeros where it has none."""
    T, J = pose.shape[:2]
    still, flat = np.zeros((T, 3)), np.zeros((T, NUM_HAND, 3))
    if J == 22:
        return still, still.copy(), still.copy(), flat, flat.copy()
    left, right = pose[:, -2 * NUM_HAND : -NUM_HAND], pose[:, -NUM_HAND:]
    if J == 52:
        return still, still.copy(), still.copy(), left, right
    return pose[:, 22], pose[:, 23], pose[:, 24], left, right


def _equal_lengths(people: list[MotionPerson], path: Path) -> list[MotionPerson]:
    lengths = [person.num_frames for person in people]
    T = min(lengths)
    if max(lengths) - T > MAX_LENGTH_DIFFERENCE:
        raise MotionError(
            f"{path}: the people of the pair have {' and '.join(map(str, lengths))} frames; "
            "give two takes of one length"
        )
    return [_cut(person, T) for person in people]


def _cut(person: MotionPerson, T: int) -> MotionPerson:
    fields = (
        "global_orient", "pelvis", "body_pose", "left_hand_pose", "right_hand_pose",
        "jaw_pose", "leye_pose", "reye_pose", "expression",
    )  # fmt: skip
    return replace(person, **{name: getattr(person, name)[:T] for name in fields})


def _turn(person: MotionPerson, turn: Rotation) -> MotionPerson:
    """The person in turned world axes: R' = C R about the pelvis, which goes to C · pelvis."""
    orient = (turn * Rotation.from_rotvec(person.global_orient)).as_rotvec()
    return replace(person, global_orient=orient, pelvis=turn.apply(person.pelvis))
