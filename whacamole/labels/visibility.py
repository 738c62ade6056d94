"""What of a person the camera sees: joints, boxes, fraction. docs/contact.md defines them in words."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from whacamole.labels.arrays import Bools, Float64s, Floats, dots
from whacamole.labels.clipping import project_points
from whacamole.labels.raster import NEAR

OUTSIDE, OCCLUDED, VISIBLE = 0, 1, 2
"""Values of ``joint_visibility``."""

_THICKNESS_FACTOR = 1.5
_CLOTHING = 0.03  # metres of cloth or hair over the skin that do not hide a joint
_DIRECTIONS = 64


def flesh_thickness(rest_vertices: Floats, rest_joints: Floats) -> Float64s:
    """How much of its own flesh may lie between a joint and the eye: ``(J,)`` metres.

    Around each joint at rest the vertices are sorted into 64 evenly spread directions; the median over the
    directions of the distance to the nearest is half the local thickness of the limb (an arm is long in few
    directions). One and a half times that allows for slanting views, and 3 cm for what the person wears.

    Args:
        rest_vertices: ``(V, 3)``.
        rest_joints: ``(J, 3)``.
    """
    directions = cKDTree(_spread_directions(_DIRECTIONS))
    thickness = np.empty(len(rest_joints))
    for number, joint in enumerate(np.asarray(rest_joints, dtype=np.float64)):
        offset = rest_vertices - joint
        length = np.sqrt(dots(offset, offset))
        nearest = np.full(_DIRECTIONS, np.inf)
        np.minimum.at(nearest, directions.query(offset / np.maximum(length, 1e-9)[:, None])[1], length)
        thickness[number] = np.median(nearest[np.isfinite(nearest)])
    return _THICKNESS_FACTOR * thickness + _CLOTHING


def joint_visibility(
    joints_camera: Float64s,
    joints_image: Float64s,
    thickness: Float64s,
    own: Bools,
    depth: Floats,
) -> NDArray[np.uint8]:
    """Whether each joint of one person is seen in one frame.

    A joint is inside the flesh, so it is never on the surface. It counts as visible if, in one of the four
    pixels whose centres surround its projection, the image shows this person, and what it shows there lies at
    most ``thickness`` in front of the joint: nearer things are another limb of the same person.

    Args:
        joints_camera: ``(J, 3)`` metres.
        joints_image: ``(J, 2)`` pixels.
        thickness: ``(J,)`` from :func:`flesh_thickness`.
        own: ``(H, W)`` the person's pixels in the rendered mask.
        depth: ``(H, W)`` planar z of the image, or of the person alone; metres.

    Returns:
        ``(J,)`` 0 outside the image or behind the camera, 1 inside but occluded, 2 visible.
    """
    height, width = own.shape
    x, y = joints_image.T
    inside = (joints_camera[:, 2] > NEAR) & (x >= 0) & (x < width) & (y >= 0) & (y < height)
    state = np.where(inside, OCCLUDED, OUTSIDE).astype(np.uint8)
    rows = np.flatnonzero(inside)
    corner = np.floor(joints_image[rows] - 0.5).astype(np.intp)
    steps = np.array([[0, 0], [1, 0], [0, 1], [1, 1]])
    column, row = np.moveaxis(corner[:, None] + steps, -1, 0)
    column, row = np.clip(column, 0, width - 1), np.clip(row, 0, height - 1)
    in_front = joints_camera[rows, 2, None] - depth[row, column]
    seen = own[row, column] & (in_front <= thickness[rows, None])
    state[rows[seen.any(axis=1)]] = VISIBLE
    return state


def whole_box(surfaces_camera: Sequence[Floats], K: Float64s) -> Float64s:
    """``(4,)`` box x0, y0, x1, y1 in pixels around all vertices before the camera, not clipped to the image.

    All zero if the person is wholly behind the camera.
    """
    points = np.concatenate([np.asarray(s, dtype=np.float64) for s in surfaces_camera])
    points = points[points[:, 2] > NEAR]
    if not len(points):
        return np.zeros(4)
    x, y = project_points(points, K).T
    return np.array([x.min(), y.min(), x.max(), y.max()])


def seen_box(own: Bools) -> Float64s:
    """``(4,)`` box x0, y0, x1, y1 of the outer edges of the true pixels; all zero if there is none."""
    rows, columns = np.flatnonzero(own.any(axis=1)), np.flatnonzero(own.any(axis=0))
    if not len(rows):
        return np.zeros(4)
    return np.array([columns[0], rows[0], columns[-1] + 1, rows[-1] + 1], dtype=np.float64)


def truncation(
    vertices_camera: Floats,
    areas: Float64s,
    K: Float64s,
    size: tuple[int, int],
) -> float:
    """The share of the body's surface that lies outside the image or behind the camera, 0 to 1.

    Args:
        vertices_camera: ``(V, 3)``.
        areas: ``(V,)`` surface around each vertex.
        K: ``(3, 3)``.
        size: image ``(width, height)``.
    """
    points = np.asarray(vertices_camera, dtype=np.float64)
    inside = points[:, 2] > NEAR
    pixels = project_points(points[inside], K)
    x, y = pixels.T
    inside[inside] = (x >= 0) & (x < size[0]) & (y >= 0) & (y < size[1])
    return float(areas[~inside].sum() / areas.sum())


def _spread_directions(count: int) -> Float64s:
    """``(count, 3)`` unit vectors spread evenly over the sphere, on a golden-angle spiral."""
    steps = np.arange(count) + 0.5
    z = 1 - 2 * steps / count
    turn = np.pi * (3 - np.sqrt(5)) * steps
    ring = np.sqrt(1 - z * z)
    return np.stack([ring * np.cos(turn), ring * np.sin(turn), z], axis=1)
