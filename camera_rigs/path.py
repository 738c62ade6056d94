"""`CameraPath`: one calibrated pose per frame; and the look-at rotation that makes it."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from camera_rigs.errors import PlanError
from camera_rigs.lens import Lens
from camera_rigs.spherical import Array


@dataclass(frozen=True)
class CameraPath:
    """Intrinsics and pose per frame: OpenCV axes (x right, y down, z forward), world z up, metres.

    Attributes:
        K: intrinsics (T, 3, 3) [px].
        T_world_camera: camera to world (T, 4, 4).
        fps: frames per second.
        width, height: image size [px].
    """

    K: Array
    T_world_camera: Array
    fps: float
    width: int
    height: int

    def __post_init__(self) -> None:
        if self.K.shape[1:] != (3, 3) or self.T_world_camera.shape != (len(self.K), 4, 4):
            raise PlanError(
                f"camera arrays of shape {self.K.shape} and {self.T_world_camera.shape}: "
                "need K (T, 3, 3) and T_world_camera (T, 4, 4) of one length"
            )

    @property
    def num_frames(self) -> int:
        """Number of frames T."""
        return len(self.K)

    @property
    def location(self) -> Array:
        """Centre of projection (T, 3) in the world [m]."""
        return self.T_world_camera[:, :3, 3]

    @property
    def forward(self) -> Array:
        """Viewing direction (T, 3), unit vectors in the world."""
        return self.T_world_camera[:, :3, 2]

    @property
    def focal(self) -> Array:
        """Focal length (T,) [px]."""
        return self.K[:, 1, 1]

    @property
    def T_camera_world(self) -> Array:  # noqa: N802 - the name of the array in camera.npz
        """World to camera (T, 4, 4), the exact rigid inverse."""
        R_camera_world = self.T_world_camera[:, :3, :3].transpose(0, 2, 1)
        inverse = np.zeros_like(self.T_world_camera)
        inverse[:, :3, :3] = R_camera_world
        inverse[:, :3, 3] = -np.einsum("tij,tj->ti", R_camera_world, self.location)
        inverse[:, 3, 3] = 1.0
        return inverse

    def project(self, points_world: ArrayLike) -> tuple[Array, Array]:
        """Project points (T, …, 3) [m], one set per frame.

        Returns:
            Pixels (T, …, 2), pixel (0, 0) covering [0, 1)×[0, 1), and planar depth (T, …) [m]. Points at or
            behind the camera (depth ≤ 0) have NaN for pixels.
        """
        points = np.asarray(points_world, float)
        offset = points.reshape(len(points), -1, 3) - self.location[:, None]
        camera = np.einsum("tni,tij->tnj", offset, self.T_world_camera[:, :3, :3])
        depth = camera[..., 2]
        ahead = np.where(depth > 0.0, depth, np.nan)
        pixels = np.einsum("tij,tnj->tni", self.K[:, :2], camera / ahead[..., None])
        return pixels.reshape(*points.shape[:-1], 2), depth.reshape(points.shape[:-1])


def look_at(eye: ArrayLike, target: ArrayLike, roll: ArrayLike = 0.0) -> Array:
    """Camera to world (T, 4, 4) of cameras at `eye` (T, 3) that look at `target` (T, 3), the horizon level.

    `roll` [rad] turns the camera about its viewing axis: positive turns x towards y, clockwise for the
    operator.
    """
    eye, target = np.asarray(eye, float), np.asarray(target, float)
    forward = target - eye
    forward = forward / np.linalg.norm(forward, axis=-1, keepdims=True)
    right = np.stack([forward[..., 1], -forward[..., 0], np.zeros(forward.shape[:-1])], axis=-1)
    right = right / np.linalg.norm(right, axis=-1, keepdims=True)
    down = np.cross(forward, right)
    cos, sin = np.cos(np.asarray(roll, float))[..., None], np.sin(np.asarray(roll, float))[..., None]
    pose = np.zeros((*eye.shape[:-1], 4, 4))
    pose[..., :3, 0] = cos * right + sin * down
    pose[..., :3, 1] = cos * down - sin * right
    pose[..., :3, 2] = forward
    pose[..., :3, 3] = eye
    pose[..., 3, 3] = 1.0
    return pose


def aimed_path(eye: Array, target: Array, focal: Array, roll: Array, lens: Lens, fps: float) -> CameraPath:
    """The path of cameras at `eye` that look at `target` (T, 3); focal lengths [px], rolls [rad] (T,)."""
    return CameraPath(lens.intrinsics(focal), look_at(eye, target, roll), fps, lens.width, lens.height)
