"""A relaxed hand, for motions that carry none."""

from typing import Final

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

FloatArray = npt.NDArray[np.float64]

_CURL_DEG: Final = {
    "index": (14.0, 20.0, 12.0),
    "middle": (20.0, 26.0, 15.0),
    "pinky": (27.0, 30.0, 18.0),
    "ring": (24.0, 29.0, 17.0),
}
"""Flexion of the three joints of each finger, in the order of SMPL-X; a hand at rest closes towards the
pinky."""

_SPREAD_DEG: Final = {"index": -3.0, "middle": 0.0, "pinky": 6.0, "ring": 2.0}
_THUMB_DEG: Final = ((14.0, -16.0, 10.0), (0.0, -12.0, 6.0), (0.0, -14.0, 8.0))
"""Rotation vectors of the left thumb's joints: it falls in front of the palm."""


def relaxed_hands(curl: float = 1.0) -> tuple[FloatArray, FloatArray]:
    """Left and right hand pose (15, 3), axis-angle, fingers loosely bent; ``curl`` scales the bend.

    At rest the palms face down and the left fingers point to +x, so a left finger bends about −z.
    """
    joints = []
    for finger, angles in _CURL_DEG.items():
        for k, angle in enumerate(angles):
            spread = _SPREAD_DEG[finger] if k == 0 else 0.0
            bend = Rotation.from_euler("yz", [-spread, -angle * curl], degrees=True)
            joints.append(bend.as_rotvec())
    joints += [np.deg2rad(vector) * curl for vector in _THUMB_DEG]
    left = np.stack(joints)
    return left, left * np.array([1.0, -1.0, -1.0])
