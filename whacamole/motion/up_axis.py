"""Which way is up: the format's convention, unless the content clearly contradicts it.

For each of the six signed axes two measures are taken with the nominal skeleton:

* *upright*, in [−1, 1]: the median over all frames and people of the cosine between the axis and the spine;
* *support*, in [0, 1]: the share of frames in which a point near the lowest level of the whole motion rests
  (within 8 cm of that level, slower than 0.3 m/s). People stand, walk, crawl and lie *on* something.

The axis with the greatest sum wins over the convention only if it leads by 0.4, and, where the format's
documents state the convention, only if people rest on nothing under it (support below 0.5) and on more
under the other. So a walk or a dance in the wrong axes is turned upright, while somebody who sleeps, does
push-ups or swims, whose spine is level, stays as the format says. Someone who stands quite still in wrong
axes cannot be told from someone who lies: name the axis then (``up=``).
"""

from __future__ import annotations

from typing import NamedTuple

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
MARGIN = 0.4
UNSUPPORTED, MORE_SUPPORT = 0.5, 0.1
REST_HEIGHT, REST_SPEED = 0.08, 0.3


class Evidence(NamedTuple):
    """What speaks for an axis being up; see the module's text."""

    upright: float
    support: float


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


def evidence(joints: FloatArray, points: FloatArray, fps: float = FPS) -> dict[str, Evidence]:
    """The evidence for each axis.

    ``joints (P,T,22,3)`` and ``points (P,T,C,3)`` of the nominal skeleton at ``fps``, in the file's axes [m].
    """
    spine = joints[:, :, JOINT_NAMES.index("neck")] - joints[:, :, 0]
    spine /= np.linalg.norm(spine, axis=-1, keepdims=True)
    speed = np.linalg.norm(np.gradient(points, axis=1), axis=-1) * fps
    result = {}
    for name, axis in AXES.items():
        direction = np.array(axis, dtype=np.float64)
        height = points @ direction - TOUCH_RADII
        floor = np.percentile(height.min(axis=2), 2.0)
        resting = (height < floor + REST_HEIGHT) & (speed < REST_SPEED)
        result[name] = Evidence(float(np.median(spine @ direction)), float(resting.any(axis=2).mean()))
    return result


def choose(
    convention: str, joints: FloatArray, points: FloatArray, *, fps: float = FPS, stated: bool = True
) -> str:
    """The up axis by the rule above; ``stated`` says that the format's documents name the ``convention``.

    Other arguments as for :func:`evidence`.
    """
    found = evidence(joints, points, fps)
    best = max(found, key=lambda name: sum(found[name]))
    if sum(found[best]) <= sum(found[convention]) + MARGIN:
        return convention
    support = found[convention].support
    contradicted = support < UNSUPPORTED and found[best].support > support + MORE_SUPPORT
    return best if contradicted or not stated else convention
