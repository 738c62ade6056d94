"""From Blender's raw layers to labels in the contract's form."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from render_jobs.blender.compat import OBJECT_INDEX_CHANNEL
from render_jobs.blender.render import LABEL_LAYER
from render_jobs.images import read_exr
from render_jobs.job import RenderJob
from render_jobs.optics import flow_at_infinity

NO_HIT = 1e9
"""Cycles writes a depth of 1e10 where it hits nothing."""

Floats = NDArray[np.float32]


def read_labels(path: Path, job: RenderJob, frame: int) -> dict[str, NDArray[Any]]:
    """The label passes of a frame from the multilayer file that Blender wrote.

    Args:
        path: the file.
        job: tells which passes are wanted, and the camera.
        frame: the frame's number.

    Returns:
        by pass name: mask ``(H, W)`` int, depth ``(H, W)`` m, normal ``(H, W, 3)``, flow ``(H, W, 2)`` px.
    """
    layers = read_exr(path)
    found: dict[str, NDArray[Any]] = {}
    if "mask" in job.passes:
        found["mask"] = np.rint(layers[f"{LABEL_LAYER}.{OBJECT_INDEX_CHANNEL}"]).astype(np.int32)
    if "depth" in job.passes:
        found["depth"] = _depth(layers)
    if "normal" in job.passes:
        world = np.stack([layers[f"{LABEL_LAYER}.Normal.{axis}"] for axis in "XYZ"], axis=-1)
        found["normal"] = camera_normals(world, job.camera.T_world_camera[frame])
    if "flow" in job.passes:
        found["flow"] = _flow(layers, job, frame)
    return found


def camera_normals(world: Floats, T_world_camera: NDArray[np.float64]) -> Floats:
    """World-frame normals ``(H, W, 3)`` turned into the camera's frame, of unit length; zero stays zero."""
    turned = world @ T_world_camera[:3, :3].astype(np.float32)
    length = np.linalg.norm(turned, axis=-1, keepdims=True)
    return np.divide(turned, length, out=np.zeros_like(turned), where=length > 0.5)


def _depth(layers: dict[str, NDArray[Any]]) -> Floats:
    depth = layers[f"{LABEL_LAYER}.Depth.Z"].astype(np.float32)
    return np.where(depth < NO_HIT, depth, np.float32(np.inf))


def _flow(layers: dict[str, NDArray[Any]], job: RenderJob, frame: int) -> Floats:
    """Blender's Vector holds (previous − current, current − next) with y up: flow is (−Z, W).

    It knows of motion and zoom, but not of a moving principal point, which is added here.
    """
    flow = np.stack([-layers[f"{LABEL_LAYER}.Vector.Z"], layers[f"{LABEL_LAYER}.Vector.W"]], axis=-1)
    K, pose = job.camera_with_neighbours()
    now, after = frame + 1, frame + 2
    flow += (K[after, :2, 2] - K[now, :2, 2]).astype(np.float32)
    beyond = flow_at_infinity(K[now], K[after], pose[now], pose[after], job.camera.width, job.camera.height)
    return np.where(np.isfinite(_depth(layers))[..., None], flow, beyond).astype(np.float32)
