"""From the 13 joints of the source humanoid to the 22 body joints of the SMPL family.

The rest poses differ: the source stands with hanging arms, SMPL in a T. So each target segment takes the
*world* rotation of the source segment, times the fixed turn that brings the target's rest bone onto the
source's. For the arms that is a quarter turn about the sagittal axis; it also brings the elbow's hinge
(across the body in the source, vertical in the T) into place, so that palms face the thighs and elbows bend
forward.

What the source does not have is shared out: the chest's rotation over three spine joints, the neck's over
neck and head, a part of the arm's swing to the collar bone, the toes bend where the heel lifts, a wrist
bends where a hand meets the floor. Legs are solved so that the soles are where the source's soles are,
whatever the lengths of the bones.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d, maximum_filter1d
from scipy.spatial.transform import Rotation

from tools.motions.feet import correction, travel
from tools.motions.source import SOLE, TO_SMPL, Clip, FloatArray, forward
from whacamole.motion.skeleton import JOINT_NAMES, PARENTS, REST_JOINTS, TOUCH_RADII, touch_points
from whacamole.motion.skeleton import forward as pose_skeleton

REST = dict(zip(JOINT_NAMES, REST_JOINTS, strict=True))
SIDES = ("left", "right")
COLLAR_SHARE = 0.15
ANKLE = 0.072
"""Height [m] of the target's ankle above its sole; the source has 0.05."""
LIFT = ANKLE - 0.05
REACH = 0.9985
HAND = 0.185
"""From the wrist to the fingertips [m]."""


@dataclass(frozen=True)
class Person:
    """A body in SMPL axes (y up), T frames: ``pose (T,22,3)`` axis-angle, ``pelvis (T,3)`` world position."""

    pose: FloatArray
    pelvis: FloatArray
    fps: float


def retarget(clip: Clip, *, on_feet: bool = False) -> Person:
    """``clip`` as a :class:`Person` on the floor y = 0, whose feet do not slide where they rest.

    ``on_feet`` says that only feet carry the body; then its path is made to fit the steps.
    """
    if on_feet:
        soles = np.stack([_sole(*forward(clip), side) for side in SIDES])
        clip = Clip(clip.local, clip.root + travel(soles, clip.fps), clip.fps, clip.wraps)
    positions, rotations = forward(clip)
    world = _trunk(clip, rotations)
    pelvis = positions["root"] + [0.0, LIFT, 0.0] - rotations["root"].apply(_hip_centre())
    ankles = {side: _ankle(positions, rotations, side, clip.fps) for side in SIDES}
    for side in SIDES:
        _arm(world, rotations, side)
    pelvis = pelvis - _overreach(world, pelvis, ankles, clip.fps)
    for side in SIDES:
        _leg(world, positions, rotations, pelvis, ankles[side], side, clip.fps)
    return _settle(world, pelvis, clip.fps)


def _hip_centre() -> FloatArray:
    return np.asarray(0.5 * (REST["left_hip"] + REST["right_hip"]) - REST["pelvis"])


def _trunk(clip: Clip, rotations: dict[str, Rotation]) -> dict[str, Rotation]:
    chest, neck = clip.local["chest"].as_rotvec(), clip.local["neck"].as_rotvec()
    root = rotations["root"]
    return {
        "pelvis": root,
        "spine1": root * Rotation.from_rotvec(chest / 3.0),
        "spine2": root * Rotation.from_rotvec(chest * 2.0 / 3.0),
        "spine3": rotations["chest"],
        "neck": rotations["chest"] * Rotation.from_rotvec(neck / 2.0),
        "head": rotations["neck"],
    }


def arc(source: FloatArray, target: FloatArray) -> Rotation:
    """The shortest rotation from directions ``source (...,3)`` to ``target (...,3)``."""
    source, target = np.broadcast_arrays(np.atleast_2d(source), np.atleast_2d(target))
    source = source / np.linalg.norm(source, axis=-1, keepdims=True)
    target = target / np.linalg.norm(target, axis=-1, keepdims=True)
    axis = np.cross(source, target)
    sine, cosine = np.linalg.norm(axis, axis=-1), (source * target).sum(axis=-1)
    angle = np.arctan2(sine, cosine)
    return Rotation.from_rotvec(axis * (angle / np.maximum(sine, 1e-12))[:, None])


def _bone(joint: str, child: str) -> FloatArray:
    return np.asarray(REST[child] - REST[joint])


def _arm(world: dict[str, Rotation], rotations: dict[str, Rotation], side: str) -> None:
    quarter = Rotation.from_rotvec([0.0, 0.0, -np.pi / 2 if side == "left" else np.pi / 2])
    down = np.array([0.0, -1.0, 0.0])
    for joint, child in (("shoulder", "elbow"), ("elbow", "wrist")):
        bone = quarter.apply(_bone(f"{side}_{joint}", f"{side}_{child}"))
        world[f"{side}_{joint}"] = rotations[f"{side}_{joint}"] * arc(bone, down)[0] * quarter
    world[f"{side}_wrist"] = world[f"{side}_elbow"]
    # The collar bone follows the arm: down where it hangs, up where it is raised.
    bone = _bone(f"{side}_shoulder", f"{side}_elbow")
    now = (world["spine3"].inv() * world[f"{side}_shoulder"]).apply(bone)
    swing = arc(np.broadcast_to(bone, now.shape), now).as_rotvec()
    world[f"{side}_collar"] = world["spine3"] * Rotation.from_rotvec(COLLAR_SHARE * swing)


def _sole(positions: dict[str, FloatArray], rotations: dict[str, Rotation], side: str) -> FloatArray:
    """Corners of the sole of the source's foot ``(T,4,3)``."""
    ankle, turn = positions[f"{side}_ankle"], rotations[f"{side}_ankle"]
    return np.stack([ankle + turn.apply(TO_SMPL @ point) for point in SOLE], axis=1)


def _ankle(
    positions: dict[str, FloatArray], rotations: dict[str, Rotation], side: str, fps: float
) -> FloatArray:
    """The target's ankle ``(T,3)`` that puts its sole where the source's is, at rest where that rests."""
    ankle = positions[f"{side}_ankle"] + correction(_sole(positions, rotations, side), fps)
    return ankle + rotations[f"{side}_ankle"].apply([0.0, LIFT, 0.0])


def _hip(world: dict[str, Rotation], pelvis: FloatArray, side: str) -> FloatArray:
    return pelvis + world["pelvis"].apply(_bone("pelvis", f"{side}_hip"))


def _overreach(
    world: dict[str, Rotation], pelvis: FloatArray, ankles: dict[str, FloatArray], fps: float
) -> FloatArray:
    """How far the pelvis must sink ``(T,3)`` for both feet to be reached, smoothly."""
    sink = np.zeros(len(pelvis))
    for side in SIDES:
        length = sum(
            np.linalg.norm(_bone(f"{side}_{a}", f"{side}_{b}"))
            for a, b in (("hip", "knee"), ("knee", "ankle"))
        )
        gap = _hip(world, pelvis, side) - ankles[side]
        level = np.hypot(gap[:, 0], gap[:, 2])
        height = np.sqrt(np.maximum((REACH * length) ** 2 - level**2, 0.01))
        sink = np.maximum(sink, np.where(gap[:, 1] > 0.3, gap[:, 1] - height, 0.0))
    return np.outer(_envelope(sink, 0.12 * fps), [0.0, 1.0, 0.0])


def _envelope(values: FloatArray, reach: float) -> FloatArray:
    """A smooth curve nowhere below ``values (T,)`` that knows of a peak ``reach`` frames ahead."""
    highest = maximum_filter1d(values, 2 * round(reach) + 1, mode="nearest")
    return np.asarray(gaussian_filter1d(highest, 0.5 * round(reach), mode="nearest", truncate=2.0))


def _leg(
    world: dict[str, Rotation],
    positions: dict[str, FloatArray],
    rotations: dict[str, Rotation],
    pelvis: FloatArray,
    ankle: FloatArray,
    side: str,
    fps: float,
) -> None:
    """Two-bone inverse kinematics; the knee stays in the plane in which the source's knee bends."""
    hip = _hip(world, pelvis, side)
    thigh, shank = _bone(f"{side}_hip", f"{side}_knee"), _bone(f"{side}_knee", f"{side}_ankle")
    a, b = np.linalg.norm(thigh), np.linalg.norm(shank)
    reach = ankle - hip
    distance = np.linalg.norm(reach, axis=1, keepdims=True)
    along = reach / distance
    c = np.minimum(distance, REACH * (a + b))
    # The knee's side: forward of the thigh by its own rotation, so that a straight leg has a side too.
    front = rotations[f"{side}_hip"].apply([0.0, 0.0, 1.0])
    front = front - (front * along).sum(axis=1, keepdims=True) * along
    front /= np.linalg.norm(front, axis=1, keepdims=True)
    cosine = np.clip((a * a + c * c - b * b) / (2.0 * a * c), -1.0, 1.0)
    knee = hip + a * (cosine * along + np.sqrt(1.0 - cosine**2) * front)
    for joint, bone, span in (("hip", thigh, knee - hip), ("knee", shank, hip + c * along - knee)):
        given = rotations[f"{side}_{joint}"]
        world[f"{side}_{joint}"] = arc(given.apply(bone), span) * given
    world[f"{side}_ankle"] = rotations[f"{side}_ankle"]
    world[f"{side}_foot"] = world[f"{side}_ankle"] * _toes(world[f"{side}_ankle"], ankle, fps)


def _toes(foot: Rotation, ankle: FloatArray, fps: float) -> Rotation:
    """Toes bend up by what the heel lifts, while the ball is near the floor."""
    ahead = foot.apply([0.0, 0.0, 1.0])
    pitch = np.clip(np.arcsin(np.clip(-ahead[:, 1], -1.0, 1.0)), 0.0, np.radians(60.0))
    ball = ankle + foot.apply([0.0, -ANKLE, 0.135])
    near = np.clip(1.0 - (ball[:, 1] - 0.03) / 0.06, 0.0, 1.0)
    bend = _envelope(pitch * near, 0.06 * fps)
    return Rotation.from_rotvec(np.outer(bend, [-1.0, 0.0, 0.0]))


def _settle(world: dict[str, Rotation], pelvis: FloatArray, fps: float) -> Person:
    """Local rotations; nothing below the floor: wrists bend where hands would, then the body is lifted."""
    pose = np.zeros((len(pelvis), len(JOINT_NAMES), 3))
    for j, name in enumerate(JOINT_NAMES):
        parent = world[JOINT_NAMES[PARENTS[j]]] if j else Rotation.identity()
        pose[:, j] = (parent.inv() * world[name]).as_rotvec()
    joints, turns = pose_skeleton(pose[:, 0], pose[:, 1:], pelvis)
    for side, out in (("left", 1.0), ("right", -1.0)):
        j = JOINT_NAMES.index(f"{side}_wrist")
        hand, back = turns[:, j] @ np.array([out, 0.0, 0.0]), turns[:, j] @ np.array([0.0, 1.0, 0.0])
        lifted = _lifted_hand(hand, back, joints[:, j, 1], turns[:, PARENTS[j]])
        pose[:, j] = gaussian_filter1d(lifted, 0.04 * fps, axis=0, mode="nearest")
    joints, turns = pose_skeleton(pose[:, 0], pose[:, 1:], pelvis)
    low = (touch_points(joints, turns)[..., 1] - TOUCH_RADII).min(axis=1)
    lift = np.maximum(-low, 0.0)
    lift = np.maximum(lift, gaussian_filter1d(lift, 0.06 * fps, mode="nearest"))
    return Person(pose, pelvis + lift[:, None] * np.array([0.0, 1.0, 0.0]), fps)


def _lifted_hand(
    hand: FloatArray, back: FloatArray, wrist_height: FloatArray, forearm: FloatArray
) -> FloatArray:
    """Wrist rotation ``(T,3)`` that keeps the fingertips out of the floor.

    ``hand`` and ``back (T,3)`` are the directions of the fingers and of the back of the hand. A hand that
    points straight down opens towards its back, as a wrist does: the palm comes to lie on the floor.
    """
    slope = np.clip(-(wrist_height - 0.015) / HAND, -1.0, 0.9)
    wanted = np.maximum(hand[:, 1], slope)
    level = (hand + back) * np.array([1.0, 0.0, 1.0])
    level /= np.maximum(np.linalg.norm(level, axis=1, keepdims=True), 1e-9)
    target = level * np.sqrt(1.0 - wanted**2)[:, None]
    target[:, 1] = wanted
    turn = arc(hand, target).as_rotvec() * (wanted > hand[:, 1])[:, None]
    return np.asarray(np.einsum("tji,tj->ti", forearm, turn))
