"""The humanoid clips of the PyPI package ``pybullet``: parsing and forward kinematics.

A clip is JSON: ``Loop`` (``wrap`` or ``none``) and ``Frames``, each with the duration, the root position
[m], the root rotation and the rotations of chest, neck, hips, knees, ankles, shoulders and elbows;
quaternions as w, x, y, z, knees and elbows as one angle about z. Axes: x forward, y up, z right. In the
rest pose everything is upright, arms hanging.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp

FloatArray = NDArray[np.float64]

# name, parent, number of values in a frame, offset from the parent [m]: humanoid/humanoid.urdf of the same
# package, at the scale 0.25 at which the package itself loads it.
JOINTS: tuple[tuple[str, str, int, tuple[float, float, float]], ...] = (
    ("root", "", 4, (0.0, 0.0, 0.0)),
    ("chest", "root", 4, (0.0, 0.236151, 0.0)),
    ("neck", "chest", 4, (0.0, 0.223894, 0.0)),
    ("right_hip", "root", 4, (0.0, 0.0, 0.084887)),
    ("right_knee", "right_hip", 1, (0.0, -0.421546, 0.0)),
    ("right_ankle", "right_knee", 4, (0.0, -0.409870, 0.0)),
    ("right_shoulder", "chest", 4, (-0.024050, 0.243500, 0.183110)),
    ("right_elbow", "right_shoulder", 1, (0.0, -0.274788, 0.0)),
    ("left_hip", "root", 4, (0.0, 0.0, -0.084887)),
    ("left_knee", "left_hip", 1, (0.0, -0.421546, 0.0)),
    ("left_ankle", "left_knee", 4, (0.0, -0.409870, 0.0)),
    ("left_shoulder", "chest", 4, (-0.024050, 0.243500, -0.183110)),
    ("left_elbow", "left_shoulder", 1, (0.0, -0.274788, 0.0)),
)
NAMES = tuple(name for name, _, _, _ in JOINTS)
FRAME_WIDTH = 4 + sum(count for _, _, count, _ in JOINTS)
# The sole, heel and ball: lower corners of the foot's box, as far apart as on the target's foot [m].
SOLE = np.array(
    [[-0.0435, -0.05, -0.028], [-0.0435, -0.05, 0.028], [0.1335, -0.05, -0.042], [0.1335, -0.05, 0.042]]
)

# To the axes of the SMPL family: x left, y up, z forward.
TO_SMPL = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])


@dataclass(frozen=True)
class Clip:
    """A clip at a constant rate in SMPL's axes (x left, y up, z forward), T frames.

    ``local`` maps each joint to its rotation within its parent, ``root (T,3)`` is the position [m] of the
    point midway between the hips, ``wraps`` says that the last frame is the first of the next repetition.
    """

    local: dict[str, Rotation]
    root: FloatArray
    fps: float
    wraps: bool

    @property
    def num_frames(self) -> int:
        """T."""
        return len(self.root)


def load(path: Path, fps: float) -> Clip:
    """Reads the clip ``path`` and resamples it to ``fps``."""
    data = json.loads(path.read_text())
    frames = np.array(data["Frames"], dtype=np.float64)
    if frames.ndim != 2 or frames.shape[1] != FRAME_WIDTH:
        raise ValueError(f"{path}: frames of {frames.shape}, expected {FRAME_WIDTH} values each")
    times = np.concatenate([[0.0], np.cumsum(frames[:-1, 0])])
    count = int(np.floor(times[-1] * fps + 1e-6)) + 1
    wraps = data["Loop"] == "wrap"
    # A repeated clip must end exactly where the next repetition starts, so the rate bends a little instead.
    at = np.linspace(0.0, times[-1], round(times[-1] * fps) + 1) if wraps else np.arange(count) / fps
    at = np.minimum(at, times[-1])
    root = np.stack([np.interp(at, times, frames[:, 1 + axis]) for axis in range(3)], axis=1)
    local, column = {}, 4
    for name, _, width, _ in JOINTS:
        values = frames[:, column : column + width]
        column += width
        local[name] = Slerp(times, _rotation(values))(at)
    return Clip(local, root @ TO_SMPL.T, fps, wraps)


def _rotation(values: FloatArray) -> Rotation:
    if values.shape[1] == 1:
        turn = Rotation.from_rotvec(values * np.array([[0.0, 0.0, 1.0]]))
    else:
        turn = Rotation.from_quat(values[:, [1, 2, 3, 0]])
    return Rotation.from_matrix(TO_SMPL @ turn.as_matrix() @ TO_SMPL.T)


def forward(clip: Clip) -> tuple[dict[str, FloatArray], dict[str, Rotation]]:
    """World position ``(T,3)`` [m] and world rotation of every joint."""
    positions, rotations = {"root": clip.root}, {"root": clip.local["root"]}
    for name, parent, _, offset in JOINTS[1:]:
        positions[name] = positions[parent] + rotations[parent].apply(TO_SMPL @ np.array(offset))
        rotations[name] = rotations[parent] * clip.local[name]
    return positions, rotations
