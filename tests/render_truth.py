"""What a frame must hold, found ray by ray from the job's arrays; no code is shared with the renderers."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
from numpy.typing import NDArray
from PIL import Image

from camera_rigs import CameraPath, look_at
from render_jobs import Mesh, RenderJob

Floats = NDArray[np.float64]

BOX = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (0.0, 1.0)])
BOX_FACES = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
SQUARE = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]])
SQUARE_FACES = np.array([[0, 1, 2, 3]])


@dataclass(frozen=True)
class Frame:
    """The labels of a frame: mask (H, W), depth (H, W), normal (H, W, 3), flow (H, W, 2)."""

    mask: NDArray[Any]
    depth: NDArray[Any]
    normal: NDArray[Any]
    flow: NDArray[Any]


def camera(eye: Any, target: Any, focal: Any, centre: Any, size: tuple[int, int] = (96, 64)) -> CameraPath:
    """A path of as many frames as ``eye`` has; ``focal`` is (T,) or (T, 2), ``centre`` (T, 2), in pixels."""
    eye = np.atleast_2d(np.asarray(eye, float))
    T = len(eye)
    K = np.zeros((T, 3, 3))
    both = np.asarray(focal, float).reshape(-1, 1) if np.ndim(focal) < 2 else np.asarray(focal, float)
    K[:, 0, 0], K[:, 1, 1] = both[:, 0], both[:, -1]
    K[:, :2, 2] = centre
    K[:, 2, 2] = 1.0
    pose = look_at(eye, np.broadcast_to(np.asarray(target, float), eye.shape))
    return CameraPath(K, pose, 30.0, *size)


def moving(points: Any, step: Any, frames: int) -> NDArray[np.float32]:
    """Vertices (T + 2, V, 3) of points that move by ``step`` a frame and are in place at frame 0."""
    times = np.arange(-1, frames + 1)
    return (np.asarray(points) + times[:, None, None] * np.asarray(step, float)).astype(np.float32)


def expected_frame(job: RenderJob, frame: int) -> Frame:
    """Cast a ray through every pixel centre at every triangle (Möller and Trumbore 1997)."""
    K, poses = job.camera_with_neighbours()
    (K0, K1), (P0, P1) = K[frame + 1 : frame + 3], poses[frame + 1 : frame + 3]
    width, height = job.camera.width, job.camera.height
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    pixels = np.stack([x, y], axis=-1).reshape(-1, 2)
    rays = np.column_stack([pixels, np.ones(len(pixels))]) @ np.linalg.inv(K0).T @ P0[:3, :3].T
    eye = P0[:3, 3]
    depth = np.full(len(pixels), np.inf)
    mask = np.zeros(len(pixels), int)
    normal = np.zeros((len(pixels), 3))
    later = eye + rays * 1e9  # where the point seen is at the next frame
    for mesh in job.meshes:
        for now, after in zip(_triangles(mesh, frame), _triangles(mesh, frame + 1), strict=True):
            edges = now[1:] - now[0]
            cross = np.cross(rays, edges[1])
            det = cross @ edges[0]
            with np.errstate(all="ignore"):
                u = (cross @ (eye - now[0])) / det
                turned = np.cross(eye - now[0], edges[0])
                v = (rays @ turned) / det
                t = (turned @ edges[1]) / det
            hit = (np.abs(det) > 1e-12) & (u >= 0) & (v >= 0) & (u + v <= 1) & (t > 1e-6) & (t < depth)
            outward = np.cross(*edges) / np.linalg.norm(np.cross(*edges))
            depth[hit], mask[hit] = t[hit], mesh.track_id
            normal[hit] = -np.sign(rays[hit] @ outward)[:, None] * outward
            later[hit] = (
                after[0] + u[hit, None] * (after[1] - after[0]) + v[hit, None] * (after[2] - after[0])
            )
    seen = (later - P1[:3, 3]) @ P1[:3, :3] @ K1.T
    flow = seen[:, :2] / seen[:, 2:] - pixels
    return Frame(
        mask.reshape(height, width),
        depth.reshape(height, width),
        (normal @ P0[:3, :3]).reshape(height, width, 3),
        flow.reshape(height, width, 2),
    )


def rendered_frame(folder: Path, frame: int) -> Frame:
    """Read the labels of a frame as anybody would, with Pillow and OpenEXR alone."""
    out = folder / "out"
    channels = {}
    for name in ("depth", "normal", "flow"):
        with OpenEXR.File(str(out / name / f"{frame:06d}.exr"), separate_channels=True) as file:
            channels[name] = {key: value.pixels for key, value in file.channels().items()}
    return Frame(
        read_picture(out / "mask" / f"{frame:06d}.png"),
        channels["depth"]["Z"],
        np.stack([channels["normal"][axis] for axis in "XYZ"], axis=-1),
        np.stack([channels["flow"][axis] for axis in "XY"], axis=-1),
    )


def read_picture(path: Path) -> NDArray[Any]:
    """The pixels of a PNG or JPEG file."""
    with Image.open(path) as image:
        return np.asarray(image)


def _triangles(mesh: Mesh, frame: int) -> Floats:
    """Corners (N, 3, 3) in the world, of all placements."""
    corners = mesh.faces[:, :3]
    if mesh.faces.shape[1] == 4:
        quads = mesh.faces[mesh.faces[:, 3] >= 0]
        corners = np.concatenate([corners, quads[:, [0, 2, 3]]])
    local = mesh.frame(frame).astype(float)[corners]
    placements = np.eye(4)[None] if mesh.placements is None else mesh.placements
    placed = np.einsum("nij,fcj->nfci", placements[:, :3, :3], local) + placements[:, None, None, :3, 3]
    return placed.reshape(-1, 3, 3)
