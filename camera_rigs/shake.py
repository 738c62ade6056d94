"""Hand-held shake: band-limited noise on the place and the direction of the camera."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from camera_rigs.errors import PlanError
from camera_rigs.path import CameraPath
from camera_rigs.spherical import Array

_WAVES = 12
"""Sinusoids an axis: enough that the eye finds no period."""


@dataclass(frozen=True)
class Shake:
    """How a hand-held camera trembles.

    Attributes:
        millimetres: RMS displacement on each axis [mm].
        degrees: RMS rotation about each axis [°].
        low, high: band [Hz]: breathing and steps below, muscle tremor above.
    """

    millimetres: float = 6.0
    degrees: float = 0.25
    low: float = 0.3
    high: float = 2.5

    def __post_init__(self) -> None:
        if not (self.millimetres >= 0.0 and self.degrees >= 0.0 and 0.0 < self.low <= self.high):
            raise PlanError(f"{self}: amplitudes must not be negative and the band must be 0 < low <= high")

    def bound(self, derivative: int) -> float:
        """The largest displacement [m] an axis can reach, or its derivative of that order [m/sⁿ]."""
        return self._bound(self.millimetres / 1000.0, derivative)

    def angle_bound(self, derivative: int = 0) -> float:
        """The largest rotation [rad] about an axis, or its derivative of that order [rad/sⁿ]."""
        return self._bound(float(np.radians(self.degrees)), derivative)

    def _bound(self, rms: float, derivative: int) -> float:
        return rms * float(np.sqrt(2.0 * _WAVES)) * (2.0 * np.pi * self.high) ** derivative


def shake_rand(rng: np.random.Generator, shake: Shake, num_frames: int, fps: float) -> tuple[Array, Array]:
    """Displacements (T, 3) [m] and rotation vectors (T, 3) [rad] in the axes of the camera.

    Each axis is a sum of sinusoids of equal amplitude with frequencies drawn from the band, so that nothing
    lies outside it however short the clip is, and every derivative has a known bound.
    """
    time = np.arange(num_frames) / fps
    frequency = rng.uniform(shake.low, shake.high, size=(6, _WAVES))
    phase = rng.uniform(0.0, 2.0 * np.pi, size=(6, _WAVES))
    angle = 2.0 * np.pi * frequency[:, :, None] * time + phase[:, :, None]
    noise = np.sin(angle).sum(axis=1).T * np.sqrt(2.0 / _WAVES)
    return noise[:, :3] * shake.millimetres / 1000.0, noise[:, 3:] * np.radians(shake.degrees)


def shaken(path: CameraPath, displacement: Array, rotation: Array) -> CameraPath:
    """`path` with every camera displaced (T, 3) [m] and turned (T, 3) [rad] in its own axes."""
    pose = path.T_world_camera.copy()
    axes = path.T_world_camera[:, :3, :3]
    pose[:, :3, 3] += np.einsum("tij,tj->ti", axes, displacement)
    pose[:, :3, :3] = axes @ Rotation.from_rotvec(rotation).as_matrix()
    return CameraPath(path.K, pose, path.fps, path.width, path.height)
