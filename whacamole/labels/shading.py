"""Bodies drawn from their labels: smooth shading over the rasteriser."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from whacamole.body import unit_vectors, vertex_normals
from whacamole.labels.arrays import Bools, Float64s, Integers
from whacamole.labels.raster import Raster, RasterMesh, rasterize

PALETTE: tuple[tuple[int, int, int], ...] = (
    (64, 150, 255),
    (255, 140, 60),
    (80, 200, 120),
    (225, 90, 150),
    (240, 200, 60),
    (150, 110, 230),
    (70, 205, 205),
    (190, 150, 110),
)
"""Colours of tracks, by track id: id 1 is the first, and they repeat."""

_LIGHT = np.array([-0.35, -0.6, -0.72])  # from over the viewer's left shoulder, OpenCV axes
_AMBIENT, _DIFFUSE, _RIM = 0.38, 0.62, 0.25


@dataclass(frozen=True, eq=False)
class Shaded:
    """Bodies drawn on nothing.

    Attributes:
        colour: ``(H, W, 3)`` float in 0 … 255.
        mesh: ``(H, W)`` index of the body, -1 for none.
    """

    colour: Float64s
    mesh: Integers


def track_colour(track_id: int) -> tuple[int, int, int]:
    """The colour of a track."""
    return PALETTE[(track_id - 1) % len(PALETTE)]


def shade(
    meshes: Sequence[RasterMesh],
    colours: Sequence[tuple[int, int, int]],
    K: Float64s,
    width: int,
    height: int,
) -> Shaded:
    """Draw meshes in the camera frame, each in its colour, lit softly with a light rim."""
    raster = rasterize(meshes, K, width, height)
    colour = np.zeros((height, width, 3))
    for number, (mesh, base) in enumerate(zip(meshes, colours, strict=True)):
        seen = raster.mesh == number
        normals, view = _surface(mesh, raster, seen, K)
        facing = np.abs((normals * view).sum(axis=1))
        light = np.maximum(normals @ (_LIGHT / np.linalg.norm(_LIGHT)), 0.0)
        strength = _AMBIENT + _DIFFUSE * light
        rim = _RIM * (1 - facing) ** 3
        colour[seen] = np.minimum(strength[:, None] * np.array(base) + 255 * rim[:, None], 255)
    return Shaded(colour, raster.mesh)


def _surface(mesh: RasterMesh, raster: Raster, seen: Bools, K: Float64s) -> tuple[Float64s, Float64s]:
    """Unit normals and unit viewing directions ``(N, 3)`` at the seen pixels, row by row."""
    rows, columns = np.nonzero(seen)
    rays = np.column_stack([columns + 0.5, rows + 0.5, np.ones(len(rows))]) @ np.linalg.inv(K).T
    points = rays * raster.depth[seen][:, None]
    corners = mesh.faces[raster.triangle[seen]]
    vertices = np.asarray(mesh.vertices, dtype=np.float64)
    weights = _barycentric(points, vertices[corners])
    normals = (weights[..., None] * vertex_normals(vertices, mesh.faces)[corners]).sum(axis=1)
    return unit_vectors(normals), unit_vectors(rays)


def _barycentric(points: Float64s, corners: Float64s) -> Float64s:
    """Weights ``(N, 3)`` of points on triangles ``(N, 3, 3)``: the areas opposite the corners, sum 1."""
    to = corners - points[:, None]
    areas = np.linalg.norm(np.cross(to[:, [1, 2, 0]], to[:, [2, 0, 1]]), axis=-1)
    weights: Float64s = areas / np.maximum(areas.sum(axis=1, keepdims=True), np.finfo(np.float64).tiny)
    return weights
