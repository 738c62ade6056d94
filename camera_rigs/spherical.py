"""The human-centric spherical frame of the paper: (r, θ, φ) around an anchor, and back.

θ is the polar angle from +z (90° is eye level with the anchor, less is above it), φ the azimuth in the ground
plane. An azimuth of the camera φ_c is counted from the azimuth of the facing: φ = φ_c + φ_facing, so φ_c = 0 stands
in front of the person whatever way the person looks. The polar angle needs no such term: a facing lies in the
ground plane (θ_facing = 0), or else a nod would lift the camera.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def spherical_to_cartesian(r: ArrayLike, theta: ArrayLike, phi: ArrayLike) -> Array:
    """The offset r·(sin θ cos φ, sin θ sin φ, cos θ) (…, 3) [m] of a camera from its anchor; angles in rad."""
    r, theta, phi = np.broadcast_arrays(
        np.asarray(r, float), np.asarray(theta, float), np.asarray(phi, float)
    )
    ring = r * np.sin(theta)
    return np.stack([ring * np.cos(phi), ring * np.sin(phi), r * np.cos(theta)], axis=-1)


def cartesian_to_spherical(offset: ArrayLike) -> tuple[Array, Array, Array]:
    """(r [m], θ [rad], φ [rad]) of offsets (…, 3); the inverse of `spherical_to_cartesian` for θ in (0, π)."""
    offset = np.asarray(offset, float)
    ring = np.hypot(offset[..., 0], offset[..., 1])
    r = np.hypot(ring, offset[..., 2])
    return r, np.arctan2(ring, offset[..., 2]), np.arctan2(offset[..., 1], offset[..., 0])


def wrap(angle: ArrayLike) -> Array:
    """The same angle in [-π, π)."""
    return (np.asarray(angle, float) + np.pi) % (2.0 * np.pi) - np.pi
