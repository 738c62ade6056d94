"""How a body should look when a SMPL-X joint turns: skinned with the fine rig, from the pose it was
modelled in.

The fine rig has bones that share a twist (upper arm, forearm, thigh, neck). Shoulders, neck and wrists are
skinned once from the modelled A-pose, so that they do not collapse as they do from a T-pose. Hips, knees,
elbows, trunk and fingers are blended as rigid motions, which keeps the girth of what bends. What the fine rig
does better becomes the pose correctives.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.spatial.transform import Rotation

from open_people.rig import Rig, skin, skin_rigidly
from open_people.skeleton import INDEX, JOINTS, PARENTS, SIDES, joint_of_bones, joint_weights
from open_people.tpose import TPose

Array = NDArray[np.float64]

UPPER_ARM_TWIST: Final = 0.45
THIGH_TWIST: Final = 0.4
FOREARM_TWIST: Final = (0.2, 0.65)
GIRDLE_SHARE: Final = 0.2
NECK_SHARES: Final = (0.55, 0.85, 0.3)
"""Shares of a joint's rotation that the fine bones above it take. The neck's bones: the first two of the
neck joint, the third of the head joint."""


def swing_twist(rotation: Array, axis: Array) -> tuple[Rotation, Rotation]:
    """``rotation (3, 3)`` = swing · twist, with the twist about ``axis``."""
    whole = Rotation.from_matrix(rotation)
    x, y, z, w = whole.as_quat()
    along = axis / np.linalg.norm(axis)
    part = along * (np.array([x, y, z]) @ along)
    size = np.hypot(np.linalg.norm(part), w)
    twist = Rotation.identity() if size < 1e-9 else Rotation.from_quat([*part, w] / size)
    return whole * twist.inv(), twist


def share(rotation: Array, fraction: float) -> Array:
    """A fraction of a rotation about the same axis."""
    return Rotation.from_rotvec(fraction * Rotation.from_matrix(rotation).as_rotvec()).as_matrix()


def _swing_and_part_of_twist(rotation: Array, axis: Array, fraction: float) -> Array:
    swing, twist = swing_twist(rotation, axis)
    return (swing * Rotation.from_rotvec(fraction * twist.as_rotvec())).as_matrix()


@dataclass(frozen=True, eq=False)
class FineRig:
    """The neutral body on both rigs.

    Attributes:
        rig: the 163 bones.
        modelled: ``(N, 3)`` vertices in the modelled pose.
        tpose: the same body in the T-pose.
        joints: ``(55, 3)`` of the T-pose, as the regressor gives them.
    """

    rig: Rig
    modelled: Array
    tpose: TPose
    joints: Array

    @cached_property
    def joint_weights(self) -> sparse.csr_matrix:
        """``(N, 55)``."""
        return joint_weights(self.rig)

    @cached_property
    def _bone_joint(self) -> NDArray[np.int64]:
        return joint_of_bones(self.rig)

    def forward(self, local: Array) -> tuple[Array, Array]:
        """Global rotations ``(55, 3, 3)`` and joint places ``(55, 3)`` for local rotations ``(55, 3, 3)``."""
        turn, place = local.copy(), self.joints.copy()
        for joint, parent in enumerate(PARENTS[1:], start=1):
            turn[joint] = turn[parent] @ local[joint]
            place[joint] = place[parent] + turn[parent] @ (self.joints[joint] - self.joints[parent])
        return turn, place

    def pose(self, local: Array, *, keep_girth: bool = False) -> Array:
        """The wanted surface ``(N, 3)``; with ``keep_girth`` by blending rigid motions from the T-pose."""
        turn, place = self.forward(local)
        bone_turn = turn[self._bone_joint]
        own_joint = self._bone_joint.copy()
        for name, rotation in self._shared_twists(local, turn).items():
            bone_turn[self.rig.index[name]] = rotation
        carried = turn[own_joint]
        for name in ("upperarm01", "upperleg01"):
            # These bones turn less than their joint, but hang where the parent joint puts them.
            for _, s, _ in SIDES:
                k = self.rig.index[f"{name}.{s}"]
                carried[k] = turn[PARENTS[own_joint[k]]]
        offset = self.tpose.heads - self.joints[own_joint]
        heads = place[own_joint] + np.einsum("bij,bj->bi", carried, offset)
        if keep_girth:
            return skin_rigidly(
                self.rig, self.tpose.vertices, self.rig.weights, bone_turn, self.tpose.heads, heads
            )
        whole = bone_turn @ self.tpose.turn
        return skin(self.modelled, self.rig.weights, whole, self.tpose.rest_heads, heads)

    def _shared_twists(self, local: Array, turn: Array) -> dict[str, Array]:
        """Global rotation of the bones that take part of a joint's rotation."""
        out: dict[str, Array] = {}
        for side, s, _ in SIDES:
            collar, shoulder, elbow, wrist, hip, knee = (
                INDEX[f"{side}_{n}"] for n in ("collar", "shoulder", "elbow", "wrist", "hip", "knee")
            )
            upper_arm = self.joints[elbow] - self.joints[shoulder]
            out[f"upperarm01.{s}"] = turn[collar] @ _swing_and_part_of_twist(
                local[shoulder], upper_arm, UPPER_ARM_TWIST
            )
            out[f"shoulder01.{s}"] = turn[collar] @ share(local[shoulder], GIRDLE_SHARE)
            _, twist = swing_twist(local[wrist], self.joints[wrist] - self.joints[elbow])
            for k, fraction in enumerate(FOREARM_TWIST, start=1):
                out[f"lowerarm0{k}.{s}"] = turn[elbow] @ share(twist.as_matrix(), fraction)
            thigh = self.joints[knee] - self.joints[hip]
            out[f"upperleg01.{s}"] = turn[0] @ _swing_and_part_of_twist(local[hip], thigh, THIGH_TWIST)
        spine, neck, head = INDEX["spine3"], INDEX["neck"], INDEX["head"]
        out["neck01"] = turn[spine] @ share(local[neck], NECK_SHARES[0])
        out["neck02"] = turn[spine] @ share(local[neck], NECK_SHARES[1])
        out["neck03"] = turn[neck] @ share(local[head], NECK_SHARES[2])
        return out

    def unpose(self, posed: Array, local: Array) -> Array:
        """The rest surface ``(N, 3)`` that plain skinning with 55 joints carries to ``posed``."""
        turn, place = self.forward(local)
        shift = place - np.einsum("jab,jb->ja", turn, self.joints)
        blended = (
            self.joint_weights @ np.concatenate([turn, shift[:, :, None]], 2).reshape(len(JOINTS), 12)
        ).reshape(-1, 3, 4)
        return np.linalg.solve(blended[:, :, :3], (posed - blended[:, :, 3])[:, :, None])[:, :, 0]
