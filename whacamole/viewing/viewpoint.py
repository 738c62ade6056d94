"""Where to look at a scene from, so that camera and people are both seen."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Viewpoint"]

Floats = NDArray[np.float64]

FOV = 0.8
"""Horizontal field of view [rad] of a picture 16 wide and 9 high."""

ROOM = 0.85
"""Share of the picture that the scene may fill."""


@dataclass(frozen=True, eq=False)
class Viewpoint:
    """A place to look from, and what to look at.

    Attributes:
        eye, target: (3,) in the world [m].
        reach: how large the scene is [m].
        middle: (3,) its middle [m].
    """

    eye: Floats
    target: Floats
    reach: float
    middle: Floats

    @classmethod
    def of(cls, eyes: Floats, people: Floats) -> "Viewpoint":
        """From behind the camera's way and aside.

        Args:
            eyes: (T, 3) the camera's way [m].
            people: (N, 3) where people are, N ≥ 1 [m].
        """
        both = np.concatenate([eyes, people])
        low, high = both.min(axis=0), both.max(axis=0)
        reach = float(np.linalg.norm((high - low)[:2])) + 2.5
        towards = people.mean(axis=0) - eyes.mean(axis=0)
        towards = towards / max(float(np.linalg.norm(towards)), 1e-6)
        aside = np.array([0.8 * towards[1] - 0.6 * towards[0], -0.8 * towards[0] - 0.6 * towards[1], 0.4])
        back = aside / np.linalg.norm(aside)
        target = (low + high) / 2
        target[2] = min(target[2], 1.0)
        heads, feet = people + np.array([0.0, 0.0, 1.0]), people * np.array([1.0, 1.0, 0.0])
        around = np.concatenate([eyes, heads, feet]) - target
        right, up = _axes(-back)
        wide, tall = ROOM * np.tan(FOV / 2), ROOM * np.tan(FOV / 2) * 9 / 16
        sideways = np.maximum(np.abs(around @ right) / wide, np.abs(around @ up) / tall)
        away = max(float((sideways + around @ back).max()), 3.0)
        return cls(target + away * back, target, reach, (low + high) / 2)

    def camera(self, width: int, height: int) -> tuple[Floats, Floats]:
        """Intrinsics (3, 3) [px] and world-to-camera (4, 4), OpenCV axes, of a level camera."""
        forward = (self.target - self.eye) / np.linalg.norm(self.target - self.eye)
        right, up = _axes(forward)
        R = np.stack([right, -up, forward])
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = R, -R @ self.eye
        focal = width / 2 / np.tan(FOV / 2)
        return np.array([[focal, 0.0, width / 2], [0.0, focal, height / 2], [0.0, 0.0, 1.0]]), T


def _axes(forward: Floats) -> tuple[Floats, Floats]:
    """To the right and up on the picture of a level camera."""
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right = right / np.linalg.norm(right)
    return right, np.cross(right, forward)
