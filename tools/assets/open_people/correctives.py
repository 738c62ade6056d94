"""Pose correctives: what to add at rest so that plain skinning looks like the fine rig.

SMPL's form: the offset is linear in the entries of R_j − I, for each of the 54 joints below the pelvis.
Each joint is fitted on its own, on the left side, and mirrored.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from open_people.base_mesh import BODY_VERTICES
from open_people.fine_rig import FineRig
from open_people.skeleton import INDEX, JOINTS, MIRRORED
from open_people.targets import TargetLibrary

Array = NDArray[np.float64]

RANGES_DEG: Final[dict[str, tuple[tuple[float, float], tuple[float, float], tuple[float, float]]]] = {
    "hip": ((-120, 35), (-35, 35), (-35, 45)),
    "knee": ((0, 135), (-12, 12), (-5, 5)),
    "ankle": ((-30, 45), (-20, 20), (-20, 20)),
    "foot": ((-40, 25), (-3, 3), (-3, 3)),
    "spine": ((-20, 35), (-25, 25), (-20, 20)),
    "neck": ((-30, 35), (-40, 40), (-25, 25)),
    "head": ((-30, 30), (-40, 40), (-25, 25)),
    "collar": ((-10, 10), (-20, 20), (-12, 30)),
    "shoulder": ((-60, 60), (-80, 35), (-85, 75)),
    "elbow": ((-40, 40), (-140, 5), (-15, 15)),
    "wrist": ((-80, 80), (-30, 30), (-60, 60)),
    "thumb": ((-35, 35), (-45, 45), (-35, 35)),
    "index": ((-10, 10), (-15, 15), (-95, 12)),
    "middle": ((-10, 10), (-15, 15), (-95, 12)),
    "ring": ((-10, 10), (-15, 15), (-95, 12)),
    "pinky": ((-10, 10), (-15, 15), (-95, 12)),
}
"""Range of each axis of a left (or middle) joint's rotation vector, by a part of the joint's name."""

GIRTH_KEPT: Final = ("hip", "knee", "elbow", "spine", "index", "middle", "ring", "pinky")
"""Joints at which the flesh keeps its girth. At a raised shoulder that rule makes the armpit bulge."""

BODY_POSES: Final = 36
FINGER_POSES: Final = 18
RIDGE: Final = 6e-4
"""Ridge a pose, against coefficients that grow where the data say nothing."""

STILL: Final = 2e-4
"""A vertex coordinate that never moves more than this (metres) gets no corrective."""

JAW_STEPS: Final = np.linspace(0, 1.3, 14)[1:]
EYE_STEPS: Final = np.array([0.33, 0.67, 1.0])
EYE_LOOK_DEG: Final = 28.0
"""Eye rotation that the looking face units stand for."""

EYE_LOOKS: Final = {"Down": (1.0, 0.0), "Up": (-1.0, 0.0), "Out": (0.0, 1.0), "In": (0.0, -1.0)}
"""Rotation of the left eye about x and y, by face unit."""


def fit_correctives(
    fine: FineRig, face_units: TargetLibrary, mirror: NDArray[np.int64], seed: int
) -> NDArray[np.float32]:
    """Correctives ``(N, 3, 54, 9)`` in metres for every base vertex; row-major entries of R − I last."""
    rng = np.random.default_rng(seed)
    out = np.zeros((len(mirror), 3, len(JOINTS) - 1, 9), np.float32)
    base = fine.tpose.vertices
    for joint, name in enumerate(JOINTS):
        if joint == 0 or name.startswith("right"):
            continue
        if name == "jaw":
            features, offsets = _jaw_examples(fine, base, face_units)
        elif name.endswith("eye"):
            features, offsets = _eye_examples(face_units)
        else:
            features, offsets = _limb_examples(fine, base, joint, rng)
        out[:, :, joint - 1] = _ridge(features, offsets).reshape(9, -1, 3).transpose(1, 2, 0)
    _mirror_to_right(out, mirror)
    return out


def _local(joint: int, rotation: Array) -> Array:
    local = np.repeat(np.eye(3)[None], len(JOINTS), axis=0)
    local[joint] = rotation
    return local


def _feature(rotation: Array) -> Array:
    return (rotation - np.eye(3)).ravel()


def _limb_examples(fine: FineRig, base: Array, joint: int, rng: np.random.Generator) -> tuple[Array, Array]:
    """The ends of each axis, then random poses within the range."""
    low, high = np.deg2rad(next(r for key, r in RANGES_DEG.items() if key in JOINTS[joint])).T
    count = BODY_POSES if joint < INDEX["jaw"] else FINGER_POSES
    vectors = [
        np.where(np.arange(3) == k, end, np.clip(0, low, high)) for k in range(3) for end in (low, high)
    ]
    vectors += list(rng.uniform(low, high, (count - len(vectors), 3)))
    rotations = Rotation.from_rotvec(vectors).as_matrix()
    keep_girth = any(part in JOINTS[joint] for part in GIRTH_KEPT)
    offsets = []
    for rotation in rotations:
        local = _local(joint, rotation)
        offsets.append((fine.unpose(fine.pose(local, keep_girth=keep_girth), local) - base).ravel())
    return np.stack([_feature(r) for r in rotations]), np.stack(offsets)


def _jaw_examples(fine: FineRig, base: Array, face_units: TargetLibrary) -> tuple[Array, Array]:
    """Opening the jaw joint looks like the face unit ``jawOpen``; its angle is the best rigid fit of the
    chin."""
    jaw = INDEX["jaw"]
    opening = face_units.dense("jawOpen")
    chin = (fine.joint_weights[:, jaw].toarray().ravel() > 0.97) & (np.linalg.norm(opening, axis=1) > 1e-3)
    closed = base[chin] - fine.joints[jaw]
    opened = closed + opening[chin]
    rigid, _ = Rotation.align_vectors(opened - opened.mean(axis=0), closed - closed.mean(axis=0))
    angle = float(rigid.magnitude())
    features, offsets = [], []
    for step in JAW_STEPS:
        local = _local(jaw, Rotation.from_rotvec([angle * step, 0, 0]).as_matrix())
        features.append(_feature(local[jaw]))
        offsets.append((fine.unpose(base + step * opening, local) - base).ravel())
    return np.stack(features), np.stack(offsets)


def _eye_examples(face_units: TargetLibrary) -> tuple[Array, Array]:
    """The lids follow the eye. They do not move with the eye joint, so the face unit is the offset itself."""
    features, offsets = [], []
    for look, axis in EYE_LOOKS.items():
        lids = face_units.dense(f"eyeLook{look}Left")
        lids[BODY_VERTICES:] = 0
        for step in EYE_STEPS:
            angle = np.deg2rad(EYE_LOOK_DEG) * step
            features.append(_feature(Rotation.from_rotvec([axis[0] * angle, axis[1] * angle, 0]).as_matrix()))
            offsets.append((step * lids).ravel())
    return np.stack(features), np.stack(offsets)


def _ridge(features: Array, offsets: Array) -> Array:
    """``(9, M)`` coefficients: offsets ≈ features @ coefficients."""
    normal = features.T @ features + RIDGE * len(features) * np.eye(9)
    coefficients = np.linalg.solve(normal, features.T @ offsets)
    coefficients[:, np.abs(offsets).max(axis=0) <= STILL] = 0
    return coefficients


def _mirror_to_right(out: NDArray[np.float32], mirror: NDArray[np.int64]) -> None:
    """Fills the right side: across x = 0 a vector changes the sign of x, a rotation R becomes M R M."""
    flip = np.array([-1.0, 1.0, 1.0], np.float32)
    flip_matrix = np.outer(flip, flip).ravel()
    for joint, name in enumerate(JOINTS):
        if name.startswith("right"):
            left = out[mirror, :, MIRRORED[joint] - 1]
            out[:, :, joint - 1] = left * flip[:, None] * flip_matrix
