"""RenderJob: everything a renderer needs, as plain data, in memory and on disk.

A job folder::

    JOB/
      job.json                 settings, materials, lights; the sha256 of every other file
      camera.npz               K, T_world_camera of the frames and of their two neighbours
      meshes/0000/*.npy        vertices, faces, uv, placements
      textures/<hash>.<suffix> copies, named by content
      out/                     what the renderer writes (see render_jobs.passes)

The same job gives the same bytes on every machine. A folder appears complete or not at all.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from render_jobs.errors import RenderJobError
from render_jobs.passes import DEFAULT_PASSES, checked_passes
from render_jobs.quality import QUALITIES, Quality
from render_jobs.scene import Environment, Lamp, Mesh, Sun

if TYPE_CHECKING:
    from camera_rigs import CameraPath

ImageFormat = Literal["jpg", "png"]
Tone = Literal["standard", "agx"]

FILM_WIDTH_M = 0.036
"""Of the film that focal lengths and f-numbers refer to, along the longer side of the image."""

MAX_LENS_SHIFT = 8.0
"""Principal points further than this many image widths from the centre are taken for a mistake."""


@dataclass(frozen=True, eq=False)
class RenderJob:
    """A scene, a camera path and what to make of them.

    Attributes:
        camera: T frames of intrinsics and poses; also gives the image size.
        meshes: at least one; animated ones hold T + 2 frames.
        lights: suns and lamps.
        environment: what surrounds the scene.
        quality: a preset of :data:`render_jobs.quality.QUALITIES` or own settings.
        passes: names from :data:`render_jobs.passes.PASSES`.
        image_format: of the rgb files.
        camera_neighbours: the camera at frames −1 and T, as a path of two frames. Flow of the last frame
            and motion blur at both ends use them. None holds the first and the last pose, so that the last
            flow is that of the scene alone.
        shutter: share of the frame time during which the shutter is open, for motion blur; 0 is a sharp
            image. Labels are never blurred: they hold at the frame's time, the middle of the exposure.
        f_number: focal length over the diameter of the lens's opening, for depth of field; None is a pinhole,
            sharp everywhere. The focal length is that on film 36 mm along the longer side of the image.
            Labels are never out of focus.
        focus_distance: (T + 2,) planar depth [m] that is in focus, frames −1 … T; needed with ``f_number``.
        exposure: in stops.
        noise: standard deviation of the sensor's noise at middle grey, in 8-bit levels
            (:mod:`render_jobs.noise`).
        tone: ``agx`` compresses highlights as a film camera does, ``standard`` is plain sRGB.
        seed: of the noise of sampling and of the sensor.
    """

    camera: CameraPath
    meshes: tuple[Mesh, ...]
    lights: tuple[Sun | Lamp, ...] = ()
    environment: Environment = field(default_factory=Environment)
    quality: Quality = field(default_factory=lambda: QUALITIES["standard"])
    passes: tuple[str, ...] = DEFAULT_PASSES
    image_format: ImageFormat = "jpg"
    camera_neighbours: CameraPath | None = None
    shutter: float = 0.0
    f_number: float | None = None
    focus_distance: NDArray[np.float64] | None = None
    exposure: float = 0.0
    noise: float = 0.0
    tone: Tone = "agx"
    seed: int = 0

    def __post_init__(self) -> None:
        object.__setattr__(self, "meshes", tuple(self.meshes))
        object.__setattr__(self, "lights", tuple(self.lights))
        object.__setattr__(self, "passes", checked_passes(self.passes))
        self._check_settings()
        self._check_focus()
        _check_meshes(self.meshes, self.num_frames)
        _check_image(self.camera)
        neighbours = self.camera_neighbours
        if neighbours is not None and neighbours.num_frames != 2:
            raise RenderJobError(
                f"camera_neighbours has {neighbours.num_frames} frames, expected 2: −1 and T"
            )
        _check_camera(*self.camera_with_neighbours(), self.camera.width, self.camera.height)

    @property
    def num_frames(self) -> int:
        """The number of images, T."""
        return int(self.camera.num_frames)

    @property
    def max_track_id(self) -> int:
        """The largest value in the masks."""
        return max(mesh.track_id for mesh in self.meshes)

    @property
    def apertures(self) -> NDArray[np.float64]:
        """Diameter (T + 2,) [m] of the lens's opening in the frames −1 … T; zero for a pinhole."""
        K, _ = self.camera_with_neighbours()
        if self.f_number is None:
            return np.zeros(len(K))
        focal_length = K[:, 0, 0] * FILM_WIDTH_M / max(self.camera.width, self.camera.height)
        return np.asarray(focal_length / self.f_number, np.float64)

    def camera_with_neighbours(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """``K`` ``(T + 2, 3, 3)`` and ``T_world_camera`` ``(T + 2, 4, 4)`` of the frames −1 … T."""
        ends = self.camera if self.camera_neighbours is None else self.camera_neighbours
        K = np.concatenate([ends.K[:1], self.camera.K, ends.K[-1:]])
        pose = np.concatenate([ends.T_world_camera[:1], self.camera.T_world_camera, ends.T_world_camera[-1:]])
        return K.astype(np.float64), pose.astype(np.float64)

    def save(self, folder: Path | str) -> None:
        """Write the job folder in one step.

        A folder that already holds this very job is left as it is, finished frames included; one that holds
        another job is replaced.

        Raises:
            RenderJobError: a texture cannot be read, or ``folder`` exists and is no job folder.
        """
        from render_jobs.storage import save_job

        save_job(self, Path(folder))

    @classmethod
    def load(cls, folder: Path | str) -> RenderJob:
        """Read a job folder.

        Raises:
            RenderJobError: a file is missing, damaged or says something impossible; the message names it.
        """
        from render_jobs.storage import load_job

        return load_job(Path(folder))

    def _check_settings(self) -> None:
        if self.image_format not in get_args(ImageFormat):
            raise RenderJobError(
                f"image_format {self.image_format!r} is not one of {', '.join(get_args(ImageFormat))}"
            )
        if self.tone not in get_args(Tone):
            raise RenderJobError(f"tone {self.tone!r} is not one of {', '.join(get_args(Tone))}")
        if not 0.0 <= self.shutter <= 1.0:
            raise RenderJobError(f"shutter {self.shutter} is outside 0..1, a share of the frame time")
        if not -20.0 <= self.exposure <= 20.0:
            raise RenderJobError(f"exposure {self.exposure} is outside -20..20 stops")
        if not 0.0 <= self.noise <= 255.0:
            raise RenderJobError(f"noise {self.noise} is outside 0..255, 8-bit levels at middle grey")
        if not 0 <= self.seed < 2**31:
            raise RenderJobError(f"seed {self.seed} is outside 0..2³¹−1")

    def _check_focus(self) -> None:
        if self.f_number is None:
            return
        if not 0.1 <= self.f_number <= 1000.0:
            raise RenderJobError(f"f_number {self.f_number} is outside 0.1..1000")
        if self.focus_distance is None:
            raise RenderJobError("f_number is given without focus_distance: say what is in focus")
        distance = np.asarray(self.focus_distance, np.float64)
        object.__setattr__(self, "focus_distance", distance)
        if distance.shape != (self.num_frames + 2,) or not (distance > 0).all():
            raise RenderJobError(
                f"focus_distance needs {self.num_frames + 2} positive distances, frames −1 to "
                f"{self.num_frames}; it has shape {distance.shape}"
            )


def _check_meshes(meshes: Sequence[Mesh], num_frames: int) -> None:
    if not meshes:
        raise RenderJobError("the job has no mesh: there is nothing to see")
    names = [mesh.name for mesh in meshes]
    twice = {name for name in names if names.count(name) > 1}
    if twice:
        raise RenderJobError(f"two meshes are named {min(twice)!r}: names must be unique")
    for mesh in meshes:
        if mesh.animated and len(mesh.vertices) != num_frames + 2:
            raise RenderJobError(
                f"mesh {mesh.name!r}: {len(mesh.vertices)} frames of vertices, expected {num_frames + 2}: "
                f"frames −1 to {num_frames} of a path of {num_frames}"
            )


def _check_image(camera: CameraPath) -> None:
    if camera.num_frames < 1:
        raise RenderJobError("the camera path has no frame")
    if not 16 <= camera.width <= 16384 or not 16 <= camera.height <= 16384:
        raise RenderJobError(f"image size {camera.width}x{camera.height} is outside 16..16384 pixels")


def _check_camera(K: NDArray[np.float64], pose: NDArray[np.float64], width: int, height: int) -> None:
    if not (np.isfinite(K).all() and np.isfinite(pose).all()):
        raise RenderJobError("the camera path holds NaN or infinity")
    if (K[:, 0, 0] <= 0).any() or (K[:, 1, 1] <= 0).any() or (np.abs(K[:, 0, 1]) > 1e-9).any():
        raise RenderJobError("the camera matrix K needs positive focal lengths and no skew")
    if np.ptp(K[:, 1, 1] / K[:, 0, 0]) > 1e-6:
        raise RenderJobError(
            "the camera matrix K changes its ratio of focal lengths (pixel aspect) on the way"
        )
    off_centre = np.abs(K[:, :2, 2] / (width, height) - 0.5)
    if (off_centre > MAX_LENS_SHIFT).any():
        raise RenderJobError(f"a principal point lies over {MAX_LENS_SHIFT:.0f} image sizes from the centre")
    R = pose[:, :3, :3]
    if np.abs(R @ R.transpose(0, 2, 1) - np.eye(3)).max() > 1e-5 or (np.linalg.det(R) < 0).any():
        raise RenderJobError("T_world_camera holds matrices that are no rotation with a translation")
