"""Other worlds: the same people and cameras with another axis pointing up.

The dataset's world has z up. BEDLAM's and the published WHAC-A-Mole labels have y down, EMDB has y up.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

__all__ = ["Y_DOWN_FROM_Z_UP", "Y_UP_FROM_Z_UP", "WorldPeople", "cameras_in", "people_in", "rest_pelvis"]

Floats = NDArray[np.float64]

Y_UP_FROM_Z_UP: Floats = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""(x, y, z) → (x, z, −y)."""

Y_DOWN_FROM_Z_UP: Floats = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""(x, y, z) → (x, −z, y)."""


@dataclass(frozen=True, eq=False)
class WorldPeople:
    """Root parameters in another world: ``global_orient`` and ``transl`` (P, T, 3)."""

    global_orient: Floats
    transl: Floats


def rest_pelvis(people: Mapping[str, NDArray[Any]]) -> Floats:
    """Return j0 (P, T, 3), the pelvis at rest [m]: SMPL-X stands with it at ``j0 + transl``."""
    return np.asarray(people["joints_world"][:, :, 0] - people["transl_world"], dtype=np.float64)


def people_in(R_new_world: Floats, people: Mapping[str, NDArray[Any]]) -> WorldPeople:
    """Return the roots of all people in the world turned by ``R_new_world`` (3, 3).

    SMPL-X turns about the pelvis: R' = R_n R and t' = R_n (t + j0) − j0.
    """
    shape = people["global_orient_world"].shape
    old = Rotation.from_rotvec(people["global_orient_world"].reshape(-1, 3))
    orient = (Rotation.from_matrix(R_new_world) * old).as_rotvec().reshape(shape)
    j0 = rest_pelvis(people)
    return WorldPeople(orient, (people["transl_world"] + j0) @ R_new_world.T - j0)


def cameras_in(R_new_world: Floats, camera: Mapping[str, NDArray[Any]]) -> Floats:
    """Return world-to-camera matrices (T, 4, 4) for the world turned by ``R_new_world`` (3, 3)."""
    turn = np.eye(4)
    turn[:3, :3] = R_new_world.T
    return np.asarray(camera["T_camera_world"] @ turn, dtype=np.float64)
