"""Triangles in the camera frame, made safe to project: culled, cut at the near plane, kept by index."""

from dataclasses import dataclass

import numpy as np

from whacamole.labels.arrays import Float64s, Floats, Indices, Integers


@dataclass(frozen=True)
class ScreenTriangles:
    """Projected triangles.

    Attributes:
        xy: ``(N, 3, 2)`` corners in pixels (pixel (0, 0) covers [0, 1) x [0, 1)).
        inverse_z: ``(N, 3)`` 1 / planar depth of the corners [1/m]; affine in screen space.
        index: ``(N,)`` the row of ``faces`` each triangle was cut from.
    """

    xy: Float64s
    inverse_z: Float64s
    index: Indices


def project_points(points_camera: Float64s, K: Float64s) -> Float64s:
    """Pinhole projection of ``(..., 3)`` camera-frame points (OpenCV axes, z > 0) to ``(..., 2)`` pixels."""
    homogeneous = points_camera @ K.T
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
    depth = points[:, 2]
    in_front = depth >= near
    corner_in_front = in_front[faces]
    whole = np.flatnonzero(corner_in_front.all(axis=1))
    xy = np.zeros((len(points), 2))
    inverse_z = np.zeros(len(points))
    xy[in_front] = project_points(points[in_front], K)
    inverse_z[in_front] = 1.0 / depth[in_front]
    corners = faces[whole]
    triangles = ScreenTriangles(xy[corners], inverse_z[corners], whole)
    cut = np.flatnonzero(corner_in_front.any(axis=1) & ~corner_in_front.all(axis=1))
    if len(cut):
        pieces, source = _cut_at_near(points[faces[cut]], near)
        triangles = ScreenTriangles(
            np.concatenate([triangles.xy, project_points(pieces, K)]),
            np.concatenate([triangles.inverse_z, 1.0 / pieces[..., 2]]),
            np.concatenate([triangles.index, cut[source]]),
        )
    return _drop_unseen(triangles, size, cull_back=cull_back)


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


def _drop_unseen(triangles: ScreenTriangles, size: tuple[int, int], *, cull_back: bool) -> ScreenTriangles:
    """Keep triangles whose box holds a pixel centre of the image and, if asked, that face the camera."""
    low = np.ceil(triangles.xy.min(axis=1) - 0.5)
    high = np.ceil(triangles.xy.max(axis=1) - 0.5)
    keep = (high > low).all(axis=1) & (high > 0).all(axis=1) & (low < np.asarray(size)).all(axis=1)
    if cull_back:
        # y points down, so a triangle that is counter-clockwise from outside turns the other way on screen.
        first = triangles.xy[:, 1] - triangles.xy[:, 0]
        second = triangles.xy[:, 2] - triangles.xy[:, 0]
        keep &= first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0] < 0
    return ScreenTriangles(triangles.xy[keep], triangles.inverse_z[keep], triangles.index[keep])
