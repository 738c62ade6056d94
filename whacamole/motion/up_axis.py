"""Which way is up: the format's convention, unless the content clearly says otherwise.

The rule. For each of the six signed axes a score in [−1, 2] is formed:

* upright: the median over all frames and people of the cosine between the axis and the spine (pelvis to
  neck);
* support: the share of frames in which a point near the lowest level of the whole motion rests (within 8 cm
  of that level, slower than 0.3 m/s). People stand, walk, crawl and lie *on* something.

The convention stands unless another axis beats it by 0.6. One such axis wins over a wrong label on any
motion that is upright most of the time; a crawl or a push-up, whose spine is level, keeps the convention,
because no wrong axis gains that much from the spine alone without losing the support.
"""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from whacamole.motion.data import FPS, FloatArray
from whacamole.motion.skeleton import JOINT_NAMES, TOUCH_RADII

AXES: dict[str, tuple[int, int, int]] = {
    "+z": (0, 0, 1),
    "-z": (0, 0, -1),
    "+y": (0, 1, 0),
    "-y": (0, -1, 0),
    "+x": (1, 0, 0),
    "-x": (-1, 0, 0),
}
MARGIN = 0.6
REST_HEIGHT, REST_SPEED = 0.08, 0.3


def to_z_up(axis: str) -> Rotation:
    """The quarter or half turn that takes ``axis`` to +z and leaves the third axis in place."""
    turns = {
        "+z": (0.0, 0.0, 0.0),
        "-z": (np.pi, 0.0, 0.0),
        "+y": (np.pi / 2, 0.0, 0.0),
        "-y": (-np.pi / 2, 0.0, 0.0),
        "+x": (0.0, -np.pi / 2, 0.0),
        "-x": (0.0, np.pi / 2, 0.0),
    }
    return Rotation.from_rotvec(turns[axis])


def scores(joints: FloatArray, points: FloatArray) -> dict[str, float]:
    """The score of each axis.

    ``joints (P,T,22,3)`` and ``points (P,T,C,3)`` of the nominal skeleton at 30 fps, in the file's axes [m].
    """
    spine = joints[:, :, JOINT_NAMES.index("neck")] - joints[:, :, 0]
    spine /= np.linalg.norm(spine, axis=-1, keepdims=True)
    speed = np.linalg.norm(np.gradient(points, axis=1), axis=-1) * FPS
    result = {}
    for name, axis in AXES.items():
        direction = np.array(axis, dtype=np.float64)
        height = points @ direction - TOUCH_RADII
        floor = np.percentile(height.min(axis=2), 2.0)
        resting = (height < floor + REST_HEIGHT) & (speed < REST_SPEED)
        result[name] = float(np.median(spine @ direction) + resting.any(axis=2).mean())
    return result


def choose(convention: str, joints: FloatArray, points: FloatArray) -> str:
    """The up axis by the rule above; arguments as for :func:`scores`."""
    score = scores(joints, points)
    best = max(score, key=lambda name: score[name])
    return best if score[best] > score[convention] + MARGIN else convention
