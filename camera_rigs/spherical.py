"""The human-centric spherical frame of the paper: (r, θ, φ) around an anchor, and back.

θ is the polar angle from +z: 90° is eye level with the anchor, less is above it. φ is the azimuth in the
ground plane. The azimuth of a camera φ_c is counted from the azimuth of the facing, φ = φ_c + φ_facing, so
that φ_c = 0 stands in front of the person whatever way the person looks. The polar angle has no such term:
the facing is taken in the ground plane (θ_facing = 0), or else a nod would lift the camera.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def spherical_to_cartesian(r: ArrayLike, theta: ArrayLike, phi: ArrayLike) -> Array:
    """The offset r·(sin θ cos φ, sin θ sin φ, cos θ) (…, 3) [m] of a camera from its anchor; angles [rad]."""
    ring = np.asarray(r, float) * np.sin(np.asarray(theta, float))
    x, y = ring * np.cos(np.asarray(phi, float)), ring * np.sin(np.asarray(phi, float))
    z = np.asarray(r, float) * np.cos(np.asarray(theta, float))
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1)


def cartesian_to_spherical(offset: ArrayLike) -> tuple[Array, Array, Array]:
    """(r [m], θ [rad], φ [rad]) of offsets (…, 3): inverts `spherical_to_cartesian` for θ in (0, π)."""
    offset = np.asarray(offset, float)
    ring = np.hypot(offset[..., 0], offset[..., 1])
    r = np.hypot(ring, offset[..., 2])
    return r, np.arctan2(ring, offset[..., 2]), np.arctan2(offset[..., 1], offset[..., 0])


def wrap(angle: ArrayLike) -> Array:
    """The same angle in [-π, π) [rad]."""
    return (np.asarray(angle, float) + np.pi) % (2.0 * np.pi) - np.pi
