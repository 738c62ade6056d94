"""What a person shows from all around: a z-buffer over points spread on its surfaces, in plain NumPy.

Skin under clothes and clothes under clothes are left out of the meshes, so a person is hollow. Where a gap
opens, one looks at the back of a surface.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np
from numpy.typing import NDArray

from render_jobs.scene import Mesh

Floats = NDArray[np.float64]

PIXEL_M: Final = 0.004
SPACING: Final = 0.6
"""Distance of the points on a face, in pixels: every pixel of a surface that faces the view gets one."""

VIEWS: Final = 12
"""Parallel views, from directions spread evenly over the sphere."""

GRAZING: Final = 0.25
"""Surfaces seen at a flatter angle (cosine) say nothing: the picture's pixels are too coarse for them."""


def directions(count: int = VIEWS) -> Floats:
    """``(count, 3)`` unit vectors from the person to the eye, on a Fibonacci spiral."""
    height = 1 - (2 * np.arange(count) + 1) / count
    angle = np.arange(count) * np.pi * (3 - np.sqrt(5))
    ring = np.sqrt(1 - height**2)
    return np.stack([ring * np.cos(angle), height, ring * np.sin(angle)], axis=1)


def surface(vertices: Floats, faces: NDArray[np.int32]) -> tuple[Floats, Floats, NDArray[np.int64]]:
    """Points ``(n, 3)`` spread over triangles or quads, the unit normals there, and the faces they are on."""
    corners = faces if faces.shape[1] == 4 else np.column_stack([faces, np.full(len(faces), -1)])
    corners = np.where(corners < 0, corners[:, 2:3], corners)
    p = vertices[corners]
    normal = np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    longest = np.max([np.linalg.norm(p[:, k] - p[:, (k + 1) % 4], axis=1) for k in range(4)], axis=0)
    steps = np.ceil(longest / (SPACING * PIXEL_M)).astype(int).clip(1)
    points, of_face = [], []
    for count in np.unique(steps):
        chosen = np.flatnonzero(steps == count)
        t = (np.arange(count) + 0.5) / count
        u, v = (grid.ravel()[:, None] for grid in np.meshgrid(t, t))
        a, b, c, d = (p[chosen, k][:, None] for k in range(4))
        points.append(((1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * d + u * c)).reshape(-1, 3))
        of_face.append(np.repeat(chosen, count * count))
    number = np.concatenate(of_face)
    return np.concatenate(points), normal[number], number


def first_hits(points: Floats, towards: Floats) -> NDArray[np.int64]:
    """The point that is seen in each pixel that shows any, looking along ``−towards``."""
    side = np.cross(towards, [0.0, 0.0, 1.0] if abs(towards[2]) < 0.9 else [1.0, 0.0, 0.0])
    side /= np.linalg.norm(side)
    flat = np.floor(points @ np.stack([side, np.cross(towards, side)], axis=1) / PIXEL_M).astype(np.int64)
    flat -= flat.min(axis=0)
    pixel = flat[:, 0] * (flat[:, 1].max() + 1) + flat[:, 1]
    near = points @ towards
    order = np.lexsort((near, pixel))
    last = np.append(pixel[order][1:] != pixel[order][:-1], True)
    return np.asarray(order[last])


def inside_seen(meshes: dict[str, Mesh], frame: int) -> Iterator[tuple[int, dict[str, int]]]:
    """A view after another: pixels that show the person, and those of the backs of surfaces by mesh name."""
    names = list(meshes)
    parts = [surface(np.asarray(mesh.vertices[frame], float), mesh.faces) for mesh in meshes.values()]
    points, normals = (np.concatenate([part[k] for part in parts]) for k in (0, 1))
    owner = np.repeat(np.arange(len(parts)), [len(part[0]) for part in parts])
    for towards in directions():
        seen = first_hits(points, towards)
        back = seen[normals[seen] @ towards < -GRAZING]
        counts = np.bincount(owner[back], minlength=len(names))
        yield len(seen), {name: int(n) for name, n in zip(names, counts, strict=True) if n}
