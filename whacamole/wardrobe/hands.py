"""A relaxed hand, for motions that carry none."""

from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

FloatArray = npt.NDArray[np.float64]

_FAN_DEG: Final = {"index": -4.0, "middle": 8.0, "pinky": 37.0, "ring": 13.0}
"""How far each left finger points from +x towards −z at rest; in the order of SMPL-X."""

_CLOSE_DEG: Final = {"index": -4.0, "middle": 0.0, "pinky": 19.0, "ring": 6.0}
"""How far each turns back towards its neighbours: a hand at rest does not spread its fingers."""

_CURL_DEG: Final = {
    "index": (16.0, 22.0, 12.0),
    "middle": (21.0, 27.0, 15.0),
    "pinky": (28.0, 30.0, 18.0),
    "ring": (25.0, 29.0, 17.0),
}
"""Flexion of the three joints; a hand at rest closes towards the pinky."""

_THUMB_DEG: Final = ((24.0, 16.0, 0.0), (6.0, 12.0, 0.0), (8.0, 16.0, 0.0))
"""Rotation vectors of the left thumb: it drops below the palm (x) and lies along the index (y)."""


def relaxed_hands(curl: float = 1.0) -> tuple[FloatArray, FloatArray]:
    """Left and right hand pose (15, 3), axis-angle, fingers loosely bent; ``curl`` scales the bend.

    At rest the palms face down and the left fingers point to +x. A finger bends about the axis across
    it, which for one that points ``fan`` degrees towards −z is −z turned by as much about y.
    """
    joints = []
    for finger, angles in _CURL_DEG.items():
        fan = np.deg2rad(_FAN_DEG[finger])
        across = np.array([-np.sin(fan), 0.0, -np.cos(fan)])
        close = Rotation.from_euler("y", -_CLOSE_DEG[finger], degrees=True)
        for k, angle in enumerate(angles):
            bend = Rotation.from_rotvec(np.deg2rad(angle * curl) * across)
            joints.append(((close * bend) if k == 0 else bend).as_rotvec())
    joints += [np.deg2rad(vector) * curl for vector in _THUMB_DEG]
    left = np.stack(joints)
    return left, left * np.array([1.0, -1.0, -1.0])
