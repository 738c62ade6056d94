"""The SMPL-X skeleton on the MakeHuman rig: which bone belongs to which joint, and where the joints are."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from open_people.rig import Rig

FINGERS: Final = ("index", "middle", "pinky", "ring", "thumb")
"""In the order of SMPL-X."""

FINGER_NUMBERS: Final = {"thumb": 1, "index": 2, "middle": 3, "ring": 4, "pinky": 5}
"""MakeHuman numbers the fingers from the thumb."""

SIDES: Final = (("left", "L", 1.0), ("right", "R", -1.0))
"""Side in joint names, side in bone names, sign of x."""

_BODY: Final = (
    ("pelvis", ""), ("left_hip", "pelvis"), ("right_hip", "pelvis"), ("spine1", "pelvis"),
    ("left_knee", "left_hip"), ("right_knee", "right_hip"), ("spine2", "spine1"),
    ("left_ankle", "left_knee"), ("right_ankle", "right_knee"), ("spine3", "spine2"),
    ("left_foot", "left_ankle"), ("right_foot", "right_ankle"), ("neck", "spine3"),
    ("left_collar", "spine3"), ("right_collar", "spine3"), ("head", "neck"),
    ("left_shoulder", "left_collar"), ("right_shoulder", "right_collar"),
    ("left_elbow", "left_shoulder"), ("right_elbow", "right_shoulder"),
    ("left_wrist", "left_elbow"), ("right_wrist", "right_elbow"),
    ("jaw", "head"), ("left_eye", "head"), ("right_eye", "head"),
)  # fmt: skip

_HANDS: Final = tuple(
    (f"{side}_{finger}{k}", f"{side}_{finger}{k - 1}" if k > 1 else f"{side}_wrist")
    for side, _, _ in SIDES
    for finger in FINGERS
    for k in (1, 2, 3)
)

JOINTS: Final = tuple(name for name, _ in _BODY + _HANDS)
INDEX: Final = {name: k for k, name in enumerate(JOINTS)}
PARENTS: Final = tuple(INDEX.get(parent, -1) for _, parent in _BODY + _HANDS)
MIRRORED: Final = tuple(
    INDEX[n.replace("left", "@").replace("right", "left").replace("@", "right")] for n in JOINTS
)
"""Joint on the other side, by joint."""

PELVIS_AT_REST: Final = np.array([0.0, -0.3514, 0.012])
"""Where SMPL-X has its pelvis at rest; the body is placed so that ours is there too."""

_CENTRE_BONES: Final = {
    "root": "pelvis", "spine05": "pelvis", "spine04": "spine1", "spine03": "spine1", "spine02": "spine2",
    "spine01": "spine3", "neck01": "neck", "neck02": "neck", "neck03": "neck", "head": "head", "jaw": "jaw",
}  # fmt: skip

_SIDE_BONES: Final = {
    "pelvis": "pelvis", "breast": "spine3", "eye": "eye", "clavicle": "collar", "shoulder01": "collar",
    "upperarm01": "shoulder", "upperarm02": "shoulder", "lowerarm01": "elbow", "lowerarm02": "elbow",
    "wrist": "wrist", "metacarpal1": "wrist", "metacarpal2": "wrist", "metacarpal3": "wrist",
    "metacarpal4": "wrist", "upperleg01": "hip", "upperleg02": "hip", "lowerleg01": "knee",
    "lowerleg02": "knee", "foot": "ankle",
}  # fmt: skip


def _own_joint(bone: str) -> str | None:
    """The joint a bone is mapped to by name, None where its parent decides."""
    if bone in _CENTRE_BONES:
        return _CENTRE_BONES[bone]
    stem, _, letter = bone.rpartition(".")
    side = {"L": "left", "R": "right"}.get(letter)
    if side is None:
        return None
    if stem in _SIDE_BONES:
        joint = _SIDE_BONES[stem]
        return joint if joint in INDEX else f"{side}_{joint}"
    if stem.startswith("toe"):
        return f"{side}_foot"
    for finger, number in FINGER_NUMBERS.items():
        if stem.startswith(f"finger{number}-"):
            return f"{side}_{finger}{stem[-1]}"
    return None


def joint_of_bones(rig: Rig) -> NDArray[np.int64]:
    """``(B,)`` the joint each bone moves with: its own, or that of the nearest ancestor that has one."""
    out = []
    for name in rig.names:
        bone = name
        while (joint := _own_joint(bone)) is None:
            bone = rig.parent_name(bone)
        out.append(INDEX[joint])
    return np.array(out)


def joint_weights(rig: Rig) -> sparse.csr_matrix:
    """``(N, 55)`` skinning weights: the weights of a joint's bones, summed."""
    bones = np.arange(len(rig.names))
    gather = sparse.csr_matrix(
        (np.ones(len(bones)), (bones, joint_of_bones(rig))), shape=(len(bones), len(JOINTS))
    )
    return (rig.weights @ gather).tocsr()


def joint_positions(rig: Rig, heads: NDArray[np.float64]) -> NDArray[np.float64]:
    """Joints ``(55, 3)`` from bone heads ``(B, 3)`` in the T-pose, where SMPL-X would have them.

    Most are the head of their bone. The offsets (metres) bring the pelvis, head, collars and hips from
    MakeHuman's anatomy to SMPL-X's, so that motion made for one plays on the other: pelvis to sole is
    0.974 m on both.
    """

    def head(bone: str) -> NDArray[np.float64]:
        return heads[rig.index[bone]]

    at: dict[str, NDArray[np.float64]] = {
        "pelvis": head("spine04") + np.array([0, -0.021, 0.055]),
        "spine1": 0.75 * head("spine03") + 0.25 * head("spine02"),
        "spine2": 0.5 * (head("spine02") + head("spine01")),
        "spine3": head("spine01"),
        "neck": head("neck01"),
        "head": head("head") + np.array([0, 0.02, -0.015]),
        "jaw": head("jaw"),
    }
    for side, s, sign in SIDES:
        collar, shoulder = head(f"clavicle.{s}"), head(f"upperarm01.{s}")
        at[f"{side}_collar"] = collar + 0.15 * (shoulder - collar) + [0, -0.02, 0]
        at[f"{side}_shoulder"] = shoulder
        at[f"{side}_elbow"] = head(f"lowerarm01.{s}")
        at[f"{side}_wrist"] = head(f"wrist.{s}")
        at[f"{side}_hip"] = head(f"upperleg01.{s}") + np.array([-0.01 * sign, 0, 0])
        at[f"{side}_knee"] = head(f"lowerleg01.{s}")
        at[f"{side}_ankle"] = head(f"foot.{s}")
        at[f"{side}_foot"] = np.mean([head(f"toe{k}-1.{s}") for k in (1, 2, 3)], axis=0)
        at[f"{side}_eye"] = head(f"eye.{s}")
        for finger, number in FINGER_NUMBERS.items():
            for k in (1, 2, 3):
                at[f"{side}_{finger}{k}"] = head(f"finger{number}-{k}.{s}")
    return np.stack([at[name] for name in JOINTS])
