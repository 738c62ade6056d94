"""Brings the MakeHuman rest pose (arms down at an angle, elbows bent) to the T-pose that SMPL-X rests in.

Every bone is given a global rotation, then the mesh is skinned with all 163 bones. Directions are those
of the neutral SMPL-X skeleton, so that the same axis-angle means the same movement on both bodies.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from open_people.rig import Rig, skin
from open_people.skeleton import FINGER_NUMBERS, SIDES

Array = NDArray[np.float64]

UPPER_ARM: Final = np.array([0.971, -0.201, -0.128])
FOREARM: Final = np.array([0.999, 0.037, -0.035])
HAND_X: Final = np.array([0.984, -0.114, -0.140])
HAND_Y: Final = np.array([0.098, 0.988, -0.119])
FINGER_DIRECTIONS: Final[dict[str, tuple[tuple[float, float, float], tuple[float, float, float]]]] = {
    "index": ((0.993, 0.069, 0.093), (0.995, -0.104, 0.004)),
    "middle": ((0.991, 0.026, -0.130), (0.982, -0.084, -0.171)),
    "ring": ((0.981, 0.053, -0.186), (0.953, -0.063, -0.297)),
    "pinky": ((0.789, -0.056, -0.611), (0.807, -0.089, -0.583)),
    "thumb": ((0.562, 0.033, 0.826), (0.782, -0.198, 0.591)),
}
"""Directions of the left arm and hand at rest, and of the first two bones of each finger (the third
follows)."""

THIGH: Final = np.array([0.0495, -0.3706, -0.0131])
SHIN: Final = np.array([-0.0295, -0.4069, -0.0261])
"""Hip to knee and knee to ankle of the left leg of the neutral SMPL-X skeleton, metres."""

LEG_X: Final = 0.108
"""Distance of knee and ankle from the middle, for the leg of that skeleton. SMPL-X has its ankle *joint*
3 cm inside the middle of the foot: copying joint directions would give knock knees."""

CLAVICLE_LIFT_DEG: Final = 4.0
"""A shoulder girdle rises when the arms do, by about 13 degrees to the T-pose. Motion capture on SMPL-X,
however, drops the arms with the shoulder joints alone: a girdle at full height would then stay up, and
people would look hunched."""

TOE_OUT_DEG: Final = 4.0

THUMB_SHARE: Final = (0.7, 0.8, 0.8)
"""The thumb turns only this much of the way: the web of the hand tears otherwise."""


def unit(v: Array) -> Array:
    """``v`` at length 1."""
    return v / np.linalg.norm(v)


def between(a: Array, b: Array) -> Array:
    """The smallest rotation that turns direction ``a`` into ``b``."""
    a, b = unit(a), unit(b)
    axis = np.cross(a, b)
    sine = float(np.linalg.norm(axis))
    if sine < 1e-9:
        return np.eye(3)
    return Rotation.from_rotvec(axis / sine * np.arctan2(sine, a @ b)).as_matrix()


def frame(x: Array, hint: Array) -> Array:
    """Columns x, y, z: x along ``x``, z across ``x`` and ``hint``."""
    x = unit(x)
    z = unit(np.cross(x, hint))
    return np.stack([x, np.cross(z, x), z], axis=1)


def part_way(a: Array, b: Array, share: float) -> Array:
    """The rotation that lies ``share`` of the way from ``a`` to ``b``."""
    return Rotation.from_rotvec(Rotation.from_matrix(b @ a.T).as_rotvec() * share).as_matrix() @ a


@dataclass(frozen=True, eq=False)
class TPose:
    """One shape brought to the T-pose.

    Attributes:
        vertices: ``(N, 3)``.
        rest_heads: ``(B, 3)`` bone heads before.
        heads: ``(B, 3)`` bone heads after.
        turn: ``(B, 3, 3)`` global rotation of every bone.
    """

    vertices: Array
    rest_heads: Array
    heads: Array
    turn: Array


def to_tpose(rig: Rig, vertices: Array) -> TPose:
    """Poses ``vertices (N, 3)`` of the MakeHuman rest pose into the T-pose."""
    heads, tails = rig.heads @ vertices, rig.tails @ vertices
    turn, posed_heads = rig.forward(heads, tpose_rotations(rig, heads, tails))
    return TPose(skin(vertices, rig.weights, turn, heads, posed_heads), heads, posed_heads, turn)


def tpose_rotations(rig: Rig, heads: Array, tails: Array) -> dict[str, Array]:
    """Global rotation by bone name for the given bone ends ``(B, 3)``."""
    out: dict[str, Array] = {}
    for _, s, sign in SIDES:
        side = _Side(rig, heads, tails, s, sign)
        out.update(side.leg())
        out.update(side.arm())
        out.update(side.fingers(out[f"wrist.{s}"]))
    return out


class _Side:
    """Bones and target directions of one side of the body."""

    def __init__(self, rig: Rig, heads: Array, tails: Array, letter: str, sign: float) -> None:
        self._index, self._heads, self._tails = rig.index, heads, tails
        self._letter, self._sign = letter, sign
        self._mirror = np.array([sign, 1.0, 1.0])

    def _head(self, bone: str) -> Array:
        return self._heads[self._index[f"{bone}.{self._letter}"]]

    def _tail(self, bone: str) -> Array:
        return self._tails[self._index[f"{bone}.{self._letter}"]]

    def _named(self, **rotations: Array) -> dict[str, Array]:
        return {f"{bone}.{self._letter}": rotation for bone, rotation in rotations.items()}

    def leg(self) -> dict[str, Array]:
        """Straight legs, knees and feet pointing ahead."""
        hip, knee, ankle = self._head("upperleg01"), self._head("lowerleg01"), self._head("foot")
        thigh, shin = float(np.linalg.norm(knee - hip)), float(np.linalg.norm(ankle - knee))
        scale = (thigh + shin) / (np.linalg.norm(THIGH) + np.linalg.norm(SHIN))
        x = self._sign * LEG_X * scale
        down = unit(THIGH) * thigh
        thigh_to = unit(np.array([x - hip[0], down[1], down[2]]))
        new_knee = hip + thigh * thigh_to
        down = unit(SHIN) * shin
        shin_to = unit(np.array([x - new_knee[0], down[1], down[2]]))
        upper = between(knee - hip, thigh_to)
        lower = between(upper @ (ankle - knee), shin_to) @ upper
        ball = self._tail("foot")
        yaw = np.arctan2(ball[0] - ankle[0], ball[2] - ankle[2])
        foot = Rotation.from_euler("y", self._sign * np.deg2rad(TOE_OUT_DEG) - yaw).as_matrix()
        return self._named(upperleg01=upper, upperleg02=upper, lowerleg01=lower, lowerleg02=lower, foot=foot)

    def arm(self) -> dict[str, Array]:
        """Arms out, palms down; bending the elbow moves the forearm forward (+z)."""
        shoulder, elbow, wrist = self._head("upperarm01"), self._head("lowerarm01"), self._head("wrist")
        upper_to, lower_to = UPPER_ARM * self._mirror, FOREARM * self._mirror
        clavicle = Rotation.from_euler("z", self._sign * np.deg2rad(CLAVICLE_LIFT_DEG)).as_matrix()
        hinge = unit(np.cross(elbow - shoulder, wrist - elbow))
        hinge_to = unit(np.cross(unit(upper_to), np.array([0.0, 0.0, 1.0])))
        upper = frame(upper_to, hinge_to) @ frame(elbow - shoulder, hinge).T
        untwisted = between(clavicle @ (elbow - shoulder), upper_to) @ clavicle
        lower = frame(lower_to, hinge_to) @ frame(wrist - elbow, hinge).T
        hand = self._hand_target() @ self._hand_frame().T
        twisted = between(hand @ (wrist - elbow), lower_to) @ hand
        return self._named(
            clavicle=clavicle,
            shoulder01=clavicle,
            upperarm01=part_way(untwisted, upper, 0.5),
            upperarm02=upper,
            lowerarm01=part_way(lower, twisted, 0.25),
            lowerarm02=part_way(lower, twisted, 0.75),
            wrist=hand,
        )

    def _hand_frame(self) -> Array:
        """Columns: along the hand, out of its back, across, from the four knuckles."""
        wrist = self._head("wrist")
        knuckles = [self._head(f"finger{k}-1") for k in (2, 3, 4, 5)]
        x = unit(sum(knuckles) / 4 - wrist)
        y = unit(np.cross(knuckles[0] - knuckles[3], x))
        return np.stack([x, y, np.cross(x, y)], axis=1)

    def _hand_target(self) -> Array:
        # A mirrored frame keeps its handedness when its second axis is turned round once more.
        x = unit(HAND_X * self._mirror)
        y = unit(HAND_Y * self._mirror * self._sign)
        y = unit(y - x * (x @ y))
        return np.stack([x, y, np.cross(x, y)], axis=1)

    def fingers(self, hand: Array) -> dict[str, Array]:
        """Straight fingers, laid flat; the thumb part of the way."""
        out: dict[str, Array] = {}
        for finger, number in FINGER_NUMBERS.items():
            first, second = (np.array(d) * self._mirror for d in FINGER_DIRECTIONS[finger])
            turn = hand
            for k, direction in enumerate((first, second, second)):
                bone = f"finger{number}-{k + 1}"
                flat = direction if finger == "thumb" else unit(direction * [1, 0, 1] - [0, 0.03, 0])
                whole = between(turn @ (self._tail(bone) - self._head(bone)), flat) @ turn
                turn = part_way(turn, whole, THUMB_SHARE[k]) if finger == "thumb" else whole
                out[f"{bone}.{self._letter}"] = turn
        return out
