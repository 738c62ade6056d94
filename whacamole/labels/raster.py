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

from whacamole.labels.arrays import Float64s, Floats, Indices, Integers, ranges
from whacamole.labels.clipping import ScreenTriangles, screen_triangles
from whacamole.labels.cutout import Cutout, ProjectedCutout

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
        cutout: where the surface is there at all; None for all of it.
    """

    vertices: Floats
    faces: Integers
    cull_back: bool = False
    cutout: Cutout | None = None


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
        cut = None if mesh.cutout is None else ProjectedCutout(mesh.cutout, mesh.vertices, mesh.faces, K)
        for pixel, row, inverse_z in _fragments(triangles, width, height):
            if cut is not None:
                # What lies behind a surface drawn before needs no look at the texture.
                ahead = np.flatnonzero(inverse_z > inverse_depth[pixel])
                y, x = np.divmod(pixel[ahead], width)
                ahead = ahead[cut.opaque(triangles.index[row[ahead]], x + 0.5, y + 0.5)]
                pixel, row, inverse_z = pixel[ahead], row[ahead], inverse_z[ahead]
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


def outermost(mesh: RasterMesh) -> Floats:
    """``(N, 3)`` points of a mesh that no other point of it outreaches, in the camera frame [m].

    All its vertices, or where a texture cuts it the outermost points of what is left of every triangle.
    """
    if mesh.cutout is None:
        return mesh.vertices
    triangle, weights = mesh.cutout.outline
    corners = mesh.vertices[mesh.faces[triangle]]
    points: Float64s = (corners * weights[..., None]).sum(axis=1)
    return points


def _spans(triangles: ScreenTriangles, width: int, height: int) -> tuple[Indices, Indices, Indices, Indices]:
    """Rows of pixel centres inside triangles: triangle, image row, first column, column after the last."""
    top = np.clip(np.ceil(triangles.y.min(axis=0) - 0.5), 0, height).astype(np.intp)
    bottom = np.clip(np.ceil(triangles.y.max(axis=0) - 0.5), 0, height).astype(np.intp)
    owner, offset = ranges(bottom - top)
    line = top[owner] + offset
    left, right = _crossings(triangles, owner, line + 0.5)
    first = np.clip(np.ceil(left - 0.5), 0, width).astype(np.intp)
    end = np.clip(np.ceil(right - 0.5), 0, width).astype(np.intp)
    filled = end > first
    return owner[filled], line[filled], first[filled], end[filled]


def _crossings(triangles: ScreenTriangles, owner: Indices, y: Float64s) -> tuple[Float64s, Float64s]:
    """Where the horizontal line ``y`` enters and leaves triangle ``owner``: x on the edges it crosses."""
    left = np.full(len(owner), np.inf)
    right = np.full(len(owner), -np.inf)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        # From the upper end to the lower, whichever triangle asks: a shared edge gives the same x to both.
        swap = triangles.y[a] > triangles.y[b]
        x0, x1 = np.where(swap, triangles.x[[b, a]], triangles.x[[a, b]])
        y0, y1 = np.where(swap, triangles.y[[b, a]], triangles.y[[a, b]])
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = (x1 - x0) / (y1 - y0)
        crossed = np.flatnonzero((y0[owner] <= y) & (y < y1[owner]))
        edge = owner[crossed]
        x = x0[edge] + (y[crossed] - y0[edge]) * slope[edge]
        left[crossed] = np.minimum(left[crossed], x)
        right[crossed] = np.maximum(right[crossed], x)
    return left, right


def _fragments(
    triangles: ScreenTriangles, width: int, height: int
) -> Iterator[tuple[Indices, Indices, Float64s]]:
    """Covered pixels in bounded blocks: flat pixel index, row of ``triangles`` and 1 / z there."""
    owner, line, first, end = _spans(triangles, width, height)
    along_x, along_y = _inverse_depth_gradient(triangles)
    nearest, farthest = triangles.inverse_z.max(axis=0), triangles.inverse_z.min(axis=0)
    # 1 / z at the middle of the first pixel of each span.
    at_first = triangles.inverse_z[0, owner]
    at_first += along_x[owner] * (first + 0.5 - triangles.x[0, owner])
    at_first += along_y[owner] * (line + 0.5 - triangles.y[0, owner])
    total = np.cumsum(end - first)
    limits = np.arange(_FRAGMENTS_AT_ONCE, total[-1] if len(total) else 0, _FRAGMENTS_AT_ONCE)
    blocks = np.searchsorted(total, limits)
    for span in np.split(np.arange(len(owner)), blocks):
        which, offset = ranges(end[span] - first[span])
        spans = span[which]
        row = owner[spans]
        inverse_z = at_first[spans] + along_x[row] * offset
        # A sliver's gradient is ill-conditioned; its depth still lies between those of its corners.
        inverse_z = np.clip(inverse_z, farthest[row], nearest[row])
        yield line[spans] * width + first[spans] + offset, row, inverse_z


def _inverse_depth_gradient(triangles: ScreenTriangles) -> tuple[Float64s, Float64s]:
    """``(N,)`` change of 1 / z per pixel in x, and in y, over each triangle."""
    x, y, rise = (value[1:] - value[0] for value in (triangles.x, triangles.y, triangles.inverse_z))
    area = x[0] * y[1] - y[0] * x[1]
    safe = np.where(area == 0, np.inf, area)
    return (rise[0] * y[1] - rise[1] * y[0]) / safe, (rise[1] * x[0] - rise[0] * x[1]) / safe
