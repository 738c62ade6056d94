"""Camera geometry of whole images."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def pixel_rays(K: Floats, width: int, height: int) -> Floats:
    """Directions ``(H, W, 3)`` through the pixel centres in the camera frame, with z = 1."""
    x = (np.arange(width) + 0.5 - K[0, 2]) / K[0, 0]
    y = (np.arange(height) + 0.5 - K[1, 2]) / K[1, 1]
    rays = np.ones((height, width, 3))
    rays[..., 0] = x[None, :]
    rays[..., 1] = y[:, None]
    return rays


def flow_at_infinity(
    K: Floats, K_next: Floats, T_world_camera: Floats, T_world_camera_next: Floats, width: int, height: int
) -> Floats:
    """Flow ``(H, W, 2)`` in pixels of a static scene at infinity: the sky's, which only rotation and zoom
    move.

    It is the homography K' R'ᵀ R K⁻¹ applied to the pixel centres. Directions behind the next camera have
    no flow; they get NaN.
    """
    rays = pixel_rays(K, width, height)
    turn = T_world_camera_next[:3, :3].T @ T_world_camera[:3, :3]
    seen = rays @ (K_next @ turn).T
    depth = np.where(seen[..., 2:] > 0, seen[..., 2:], np.nan)
    flow: Floats = seen[..., :2] / depth - rays @ K[:2].T
    return flow
