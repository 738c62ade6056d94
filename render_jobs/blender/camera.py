"""The camera path in Blender: pose, focal length and principal point keyed at every frame."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from render_jobs.blender.compat import animate
from render_jobs.job import RenderJob

SENSOR_WIDTH_MM = 36.0
CLIP_START_M = 0.01
CLIP_END_M = 10_000.0
BLENDER_FROM_OPENCV = np.diag([1.0, -1.0, -1.0])
"""Blender's camera looks along −z with y up."""


def add_camera(job: RenderJob) -> None:
    """Add the animated camera and set the size and the pixel aspect of the image."""
    K, pose = job.camera_with_neighbours()
    width, height = job.camera.width, job.camera.height
    aspect = float(K[0, 1, 1] / K[0, 0, 0])
    scene: Any = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = max(aspect, 1.0), max(1.0 / aspect, 1.0)

    data = bpy.data.cameras.new("camera")
    entity = bpy.data.objects.new("camera", data)
    scene.collection.objects.link(entity)
    scene.camera = entity
    data.sensor_fit = "HORIZONTAL"
    data.sensor_width = SENSOR_WIDTH_MM
    data.clip_start, data.clip_end = CLIP_START_M, CLIP_END_M
    _add_lens(data, job)

    frames = np.arange(-1, job.num_frames + 1)
    entity.rotation_mode = "QUATERNION"
    rotation = Rotation.from_matrix(pose[:, :3, :3] @ BLENDER_FROM_OPENCV).as_quat()[:, [3, 0, 1, 2]]
    animate(entity, "location", frames, pose[:, :3, 3])
    animate(entity, "rotation_quaternion", frames, _continuous(rotation))
    animate(data, "lens", frames, K[:, 0, 0] * SENSOR_WIDTH_MM / width)
    # both shifts are in image widths; up and left in the image are positive and negative
    animate(data, "shift_x", frames, (width / 2 - K[:, 0, 2]) / width)
    animate(data, "shift_y", frames, (K[:, 1, 2] - height / 2) / (aspect * width))


def _add_lens(data: Any, job: RenderJob) -> None:
    """Open the lens and pull the focus, if the job has depth of field."""
    data.dof.use_dof = job.f_number is not None
    if job.f_number is None or job.focus_distance is None:
        return
    # Blender takes the opening from its own focal length, which is for film 36 mm *wide*.
    data.dof.aperture_fstop = job.f_number * max(job.camera.width, job.camera.height) / job.camera.width
    animate(data, "dof.focus_distance", np.arange(-1, job.num_frames + 1), job.focus_distance)


def _continuous(quaternions: NDArray[np.float64]) -> NDArray[np.float64]:
    """The same rotations without a change of sign on the way, so that blur interpolates the short way."""
    flips = np.sum(quaternions[1:] * quaternions[:-1], axis=1) < 0.0
    signs: NDArray[np.float64] = np.where(np.cumsum(np.concatenate([[False], flips])) % 2 == 1, -1.0, 1.0)
    return quaternions * signs[:, None]
