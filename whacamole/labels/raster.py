"""An exact z-buffer in NumPy: which triangle every pixel centre sees, and how deep. No GL, no GPU.

A pixel is covered where its centre (x + 0.5, y + 0.5) lies inside a projected triangle. Triangles are filled
row by row between half-open spans; both triangles at an edge compute the crossing from the same two points in
the same order, so neighbours neither overlap nor leave a crack. Depth is planar z, interpolated as 1 / z:
affine on the screen, so exact. Everything is float64: equal input gives equal bits.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from whacamole.labels.arrays import Bools, Float64s, Floats, Indices, Integers, ranges
from whacamole.labels.clipping import ScreenTriangles, screen_triangles

NEAR = 0.01
"""Planar depth in front of which nothing is drawn [m]."""

_FRAGMENTS_AT_ONCE = 2_000_000


@dataclass(frozen=True)
class RasterMesh:
    """A triangle mesh in the camera frame.

    Attributes:
        vertices: ``(V, 3)`` OpenCV axes, metres.
        faces: ``(F, 3)`` triangles, counter-clockwise seen from outside.
        cull_back: leave out triangles seen from inside (halves the work for a closed mesh seen from outside).
    """

    vertices: Floats
    faces: Integers
    cull_back: bool = False


@dataclass(frozen=True)
class Raster:
    """What every pixel sees.

    Attributes:
        depth: ``(H, W)`` float64 planar z of the nearest surface [m], ``inf`` where there is none.
        mesh: ``(H, W)`` int32 index of the mesh, -1 for none.
        triangle: ``(H, W)`` int32 row of that mesh's faces, -1 for none.
    """

    depth: Float64s
    mesh: NDArray[np.int32]
    triangle: NDArray[np.int32]


def rasterize(
    meshes: Sequence[RasterMesh], K: Float64s, width: int, height: int, *, near: float = NEAR
) -> Raster:
    """Draw meshes into one z-buffer.

    Args:
        meshes: what to draw; where two surfaces are equally near, the earlier mesh and lower triangle wins.
        K: ``(3, 3)`` pinhole intrinsics in pixels.
        width: image width in pixels.
        height: image height in pixels.
        near: planar depth in front of which nothing is drawn [m].
    """
    inverse_depth = np.zeros(height * width)
    mesh_of = np.full(height * width, -1, dtype=np.int32)
    triangle_of = np.full(height * width, -1, dtype=np.int32)
    for number, mesh in enumerate(meshes):
        triangles = screen_triangles(
            mesh.vertices, mesh.faces, K, (width, height), near=near, cull_back=mesh.cull_back
        )
        for pixel, row, inverse_z in _fragments(triangles, width, height):
            before = inverse_depth[pixel]
            np.maximum.at(inverse_depth, pixel, inverse_z)
            won = (inverse_z == inverse_depth[pixel]) & (inverse_z > before)
            # The last of repeated indices stays, so write backwards: the lowest triangle wins a tie.
            mesh_of[pixel[won]] = number
            triangle_of[pixel[won][::-1]] = triangles.index[row[won][::-1]]
    with np.errstate(divide="ignore"):
        depth = 1.0 / inverse_depth
    shape = (height, width)
    return Raster(depth.reshape(shape), mesh_of.reshape(shape), triangle_of.reshape(shape))


def silhouette(
    meshes: Sequence[RasterMesh], K: Float64s, width: int, height: int, *, near: float = NEAR
) -> Bools:
    """``(H, W)`` pixels covered by any of the meshes: :func:`rasterize` without depth, in less time."""
    # Spans are marked by +1 at the first pixel and -1 after the last; a running sum fills them.
    edges = np.zeros(height * (width + 1), dtype=np.int64)
    for mesh in meshes:
        triangles = screen_triangles(
            mesh.vertices, mesh.faces, K, (width, height), near=near, cull_back=mesh.cull_back
        )
        _, line, first, end = _spans(triangles, width, height)
        start = line * (width + 1)
        edges += np.bincount(start + first, minlength=len(edges))
        edges -= np.bincount(start + end, minlength=len(edges))
    covered: Bools = np.cumsum(edges.reshape(height, width + 1), axis=1)[:, :width] > 0
    return covered


def _spans(triangles: ScreenTriangles, width: int, height: int) -> tuple[Indices, Indices, Indices, Indices]:
    """Rows of pixel centres inside triangles: triangle, image row, first column, column after the last."""
    y = triangles.xy[..., 1]
    top = np.clip(np.ceil(y.min(axis=1) - 0.5), 0, height).astype(np.intp)
    bottom = np.clip(np.ceil(y.max(axis=1) - 0.5), 0, height).astype(np.intp)
    owner, offset = ranges(bottom - top)
    line = top[owner] + offset
    left, right = _crossings(triangles.xy, owner, line + 0.5)
    first = np.clip(np.ceil(left - 0.5), 0, width).astype(np.intp)
    end = np.clip(np.ceil(right - 0.5), 0, width).astype(np.intp)
    filled = end > first
    return owner[filled], line[filled], first[filled], end[filled]


def _crossings(xy: Float64s, owner: Indices, y: Float64s) -> tuple[Float64s, Float64s]:
    """Where the horizontal line ``y`` enters and leaves triangle ``owner``: x on the edges it crosses."""
    left = np.full(len(owner), np.inf)
    right = np.full(len(owner), -np.inf)
    for k in range(3):
        a, b = xy[:, k], xy[:, (k + 1) % 3]
        # From the upper end to the lower, whichever triangle asks: a shared edge gives the same x to both.
        swap = (a[:, 1] > b[:, 1])[:, None]
        upper, lower = np.where(swap, b, a), np.where(swap, a, b)
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = (lower[:, 0] - upper[:, 0]) / (lower[:, 1] - upper[:, 1])
        crossed = np.flatnonzero((upper[owner, 1] <= y) & (y < lower[owner, 1]))
        edge = owner[crossed]
        x = upper[edge, 0] + (y[crossed] - upper[edge, 1]) * slope[edge]
        left[crossed] = np.minimum(left[crossed], x)
        right[crossed] = np.maximum(right[crossed], x)
    return left, right


def _fragments(
    triangles: ScreenTriangles, width: int, height: int
) -> Iterator[tuple[Indices, Indices, Float64s]]:
    """Covered pixels in bounded blocks: flat pixel index, row of ``triangles`` and 1 / z there."""
    owner, line, first, end = _spans(triangles, width, height)
    gradient = _inverse_depth_gradient(triangles)
    nearest, farthest = triangles.inverse_z.max(axis=1), triangles.inverse_z.min(axis=1)
    total = np.cumsum(end - first)
    limits = np.arange(_FRAGMENTS_AT_ONCE, total[-1] if len(total) else 0, _FRAGMENTS_AT_ONCE)
    blocks = np.searchsorted(total, limits)
    for span in np.split(np.arange(len(owner)), blocks):
        which, offset = ranges(end[span] - first[span])
        spans = span[which]
        row, column = owner[spans], first[spans] + offset
        origin = triangles.xy[row, 0]
        inverse_z = (
            triangles.inverse_z[row, 0]
            + gradient[row, 0] * (column + 0.5 - origin[:, 0])
            + gradient[row, 1] * (line[spans] + 0.5 - origin[:, 1])
        )
        # A sliver's gradient is ill-conditioned; its depth still lies between those of its corners.
        yield line[spans] * width + column, row, np.clip(inverse_z, farthest[row], nearest[row])


def _inverse_depth_gradient(triangles: ScreenTriangles) -> Float64s:
    """``(N, 2)`` change of 1 / z per pixel in x and y over each triangle."""
    edge = triangles.xy[:, 1:] - triangles.xy[:, :1]
    rise = triangles.inverse_z[:, 1:] - triangles.inverse_z[:, :1]
    area = edge[:, 0, 0] * edge[:, 1, 1] - edge[:, 0, 1] * edge[:, 1, 0]
    safe = np.where(area == 0, np.inf, area)
    along_x = (rise[:, 0] * edge[:, 1, 1] - rise[:, 1] * edge[:, 0, 1]) / safe
    along_y = (rise[:, 1] * edge[:, 0, 0] - rise[:, 0] * edge[:, 1, 0]) / safe
    return np.stack([along_x, along_y], axis=1)
