"""Triangles in the camera frame, made safe to project: culled, cut at the near plane, kept by index."""

from dataclasses import dataclass, fields

import numpy as np

from whacamole.labels.arrays import Float64s, Floats, Indices, Integers, transformed


@dataclass(frozen=True)
class ScreenTriangles:
    """Projected triangles.

    Attributes:
        x: ``(3, N)`` corners in pixels (pixel (0, 0) covers [0, 1) x [0, 1)).
        y: ``(3, N)``.
        inverse_z: ``(3, N)`` 1 / planar depth of the corners [1/m]; affine in screen space.
        index: ``(N,)`` the row of ``faces`` each triangle was cut from.
    """

    x: Float64s
    y: Float64s
    inverse_z: Float64s
    index: Indices


def project_points(points_camera: Float64s, K: Float64s) -> Float64s:
    """Pinhole projection of ``(..., 3)`` camera-frame points (OpenCV axes, z > 0) to ``(..., 2)`` pixels."""
    homogeneous = transformed(points_camera, K)
    pixels: Float64s = homogeneous[..., :2] / homogeneous[..., 2:]
    return pixels


def screen_triangles(
    vertices: Floats,
    faces: Integers,
    K: Float64s,
    size: tuple[int, int],
    *,
    near: float,
    cull_back: bool,
) -> ScreenTriangles:
    """Triangles that may cover a pixel, projected.

    Args:
        vertices: ``(V, 3)`` in the camera frame, OpenCV axes, metres.
        faces: ``(F, 3)`` triangles, counter-clockwise seen from outside.
        K: ``(3, 3)`` intrinsics in pixels.
        size: image ``(width, height)``.
        near: planar depth in front of which nothing is drawn [m], > 0.
        cull_back: leave out triangles seen from inside; right for closed meshes with the camera outside.
    """
    points = np.asarray(vertices, dtype=np.float64)
    corner = np.ascontiguousarray(faces.T)
    depth = points[:, 2]
    in_front = depth >= near
    # Corners come first throughout: NumPy reduces three long rows much faster than many short ones.
    front = in_front[corner].sum(axis=0, dtype=np.int8)
    whole = np.flatnonzero(front == 3)
    x, y, inverse_z = np.zeros((3, len(points)))
    x[in_front], y[in_front] = project_points(points[in_front], K).T
    inverse_z[in_front] = 1.0 / depth[in_front]
    corner = corner.take(whole, axis=1)  # keeps the rows contiguous, unlike indexing
    uncut = ScreenTriangles(x[corner], y[corner], inverse_z[corner], whole)
    parts = [_keep_seen(uncut, size, cull_back=cull_back)]
    cut = np.flatnonzero((front > 0) & (front < 3))
    if len(cut):
        pieces, source = _cut_at_near(points[faces[cut]], near)
        x, y = np.moveaxis(project_points(pieces, K), (2, 1), (0, 1))
        clipped = ScreenTriangles(x, y, 1.0 / pieces[..., 2].T, cut[source])
        parts.append(_keep_seen(clipped, size, cull_back=cull_back))
    return ScreenTriangles(
        *(np.concatenate([getattr(part, f.name) for part in parts], axis=-1) for f in fields(ScreenTriangles))
    )


def _cut_at_near(triangles: Float64s, near: float) -> tuple[Float64s, Indices]:
    """The parts of ``(N, 3, 3)`` triangles beyond ``z = near``: ``(M, 3, 3)`` pieces and their source row.

    Each crossing edge is cut from its front end to its back end, so two triangles that share an edge share
    the cut point to the last bit and no crack opens between them.
    """
    in_front = triangles[..., 2] >= near
    lone = np.where(in_front.sum(axis=1) == 1, in_front.argmax(axis=1), (~in_front).argmax(axis=1))
    order = (lone[:, None] + np.arange(3)) % 3
    turned = np.take_along_axis(triangles, order[..., None], axis=1)
    one_in_front = in_front.sum(axis=1) == 1

    def cut(front: Float64s, back: Float64s) -> Float64s:
        weight = (front[:, 2:] - near) / (front[:, 2:] - back[:, 2:])
        point = front + weight * (back - front)
        point[:, 2] = near
        return point

    a, b, c = (turned[one_in_front, k] for k in range(3))
    tips = np.stack([a, cut(a, b), cut(a, c)], axis=1)
    a, b, c = (turned[~one_in_front, k] for k in range(3))
    ab, ac = cut(b, a), cut(c, a)
    quads = [np.stack([ab, b, c], axis=1), np.stack([ab, c, ac], axis=1)]
    rows = np.flatnonzero(~one_in_front)
    return np.concatenate([tips, *quads]), np.concatenate([np.flatnonzero(one_in_front), rows, rows])


def _keep_seen(triangles: ScreenTriangles, size: tuple[int, int], *, cull_back: bool) -> ScreenTriangles:
    """Keep triangles whose box holds a pixel centre of the image and, if asked, that face the camera."""
    keep = np.ones(len(triangles.index), dtype=np.bool_)
    for along, length in ((triangles.x, size[0]), (triangles.y, size[1])):
        low, high = np.ceil(along.min(axis=0) - 0.5), np.ceil(along.max(axis=0) - 0.5)
        keep &= (high > low) & (high > 0) & (low < length)
    if cull_back:
        # y points down, so a triangle that is counter-clockwise from outside turns the other way on screen.
        (x0, x1, x2), (y0, y1, y2) = triangles.x, triangles.y
        keep &= (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0) < 0
    seen = np.flatnonzero(keep)
    return ScreenTriangles(*(getattr(triangles, f.name).take(seen, axis=-1) for f in fields(ScreenTriangles)))
