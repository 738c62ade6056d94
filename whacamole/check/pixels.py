"""Whether the bodies of the labels are what the images show, frame by frame."""

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import maximum_filter
from scipy.spatial import cKDTree

from whacamole.check.limits import Limits
from whacamole.labels.arrays import AnyArray, Bools, Float64s, Floats, Integers
from whacamole.labels.clipping import project_points
from whacamole.labels.people import to_camera
from whacamole.labels.raster import Raster, RasterMesh, rasterize

_RESIDUAL = 0.04  # metres; how far depth may differ and still speak for this frame
_CLOTHES = 0.06  # metres that clothes and hair may lie before a body
_BARE = 0.003  # metres; in a quick turn, cloth a centimetre off the skin moves otherwise by half a pixel
_TOUCHING = 0.002  # metres by which clothes that lie on another's skin may seem to lie under it


@dataclass(frozen=True, eq=False)
class Shown:
    """The images of one frame.

    Attributes:
        mask: ``(H, W)`` track ids.
        depth: ``(H, W)`` planar z [m].
    """

    mask: Integers
    depth: Floats


@dataclass(frozen=True, eq=False)
class Drawn:
    """The labelled bodies of one frame, drawn by the audit itself.

    Attributes:
        vertices: ``(V, 3)`` of each person in the camera frame [m].
        raster: all of them in one z-buffer.
        track: ``(H, W)`` track id of the nearest body, 0 for none.
    """

    vertices: list[Float64s]
    raster: Raster
    track: Integers


def draw(
    bodies: list[Floats], faces: Integers, ids: Integers, K: Float64s, view: Float64s, size: tuple[int, int]
) -> Drawn:
    """Draw bodies given in the world through the camera of one frame."""
    vertices = [to_camera(body, view) for body in bodies]
    raster = rasterize([RasterMesh(body, faces) for body in vertices], K, *size)
    return Drawn(vertices, raster, np.append(ids, 0)[raster.mesh])


@dataclass(frozen=True, eq=False)
class Hands:
    """The hands of a body model: vertices ``(V,)`` and triangles ``(F,)``."""

    vertex: Bools
    triangle: Bools


@dataclass(frozen=True, eq=False)
class PersonPixels:
    """One person in one frame: how far the picture bears the labels out.

    Attributes:
        area: pixels in which the labelled body is the nearest one.
        stray: of those, how many show neither the person nor anything in front.
        own: of those, how many show the person.
        sunk: of those, how many show something deeper than the body, there and in the pixels around: the body
            is not where the label puts it. (At an edge of the body, the part behind may be seen.)
        hands: pixels of the hands among ``area``, without those that the person's own clothes hide.
        hands_off: of those, how many stray or show a depth that is not the hand's.
    """

    area: int
    stray: int
    own: int
    sunk: int
    hands: int
    hands_off: int


def person_pixels(
    drawn: Drawn, shown: Shown, number: int, ids: list[int], K: Float64s, hands: Hands, limits: Limits
) -> PersonPixels:
    """Hold one person's drawn pixels against the mask and the depth.

    Args:
        drawn: the labelled bodies.
        shown: the images.
        number: which of the people.
        ids: of all people, in the mask.
        K: intrinsics of the frame.
        hands: where the hands are on every body.
        limits: what counts as deeper.
    """
    body = drawn.raster.mesh == number
    deeper = shown.depth[body] - drawn.raster.depth[body]
    own = shown.mask[body] == ids[number]
    stray = ~own & (deeper > -limits.depth)
    stray[stray] = ~_others_cover(drawn, shown, number, ids, K, *(axis[stray] for axis in np.nonzero(body)))
    farthest = maximum_filter(drawn.raster.depth, 3)[body]
    sunk = own & (shown.depth[body] > farthest + limits.depth)
    hand = hands.triangle[drawn.raster.triangle[body]]
    # Nothing covers fingers, but a sleeve, or the clothes of the hip or chest that the hand is at, may hide a
    # part, and another limb before the hand makes it no evidence.
    off = (own & (np.abs(deeper) > 1.5 * limits.depth) & (deeper > -5 * limits.depth)) | stray
    hidden = hand & own & off & (deeper < 0)
    dressed = drawn.vertices[number][~hands.vertex]
    places = [axis[hidden] for axis in np.nonzero(body)]
    hand[hidden] = ~_is_near(_points(shown, K, *places), dressed)
    counts = (body, stray, own, sunk, hand, hand & off)
    return PersonPixels(*(int(np.count_nonzero(flags)) for flags in counts))


def _others_cover(
    drawn: Drawn, shown: Shown, number: int, ids: list[int], K: Float64s, row: Integers, column: Integers
) -> Bools:
    """Which pixels of a body show the clothes or hair of somebody who touches it: before it, however little.

    Their wearer's own body must be as near as clothes lie; the id in the mask alone is no proof.
    """
    covers = np.zeros(len(row), dtype=np.bool_)
    before = shown.depth[row, column] < drawn.raster.depth[row, column] + _TOUCHING
    points = _points(shown, K, row, column)
    for other, track in enumerate(ids):
        at = np.flatnonzero(before & (shown.mask[row, column] == track))
        if other != number and len(at):
            covers[at] = _is_near(points[at], drawn.vertices[other])
    return covers


def _points(shown: Shown, K: Float64s, row: Integers, column: Integers) -> Float64s:
    """The points ``(n, 3)`` that pixels show, in the camera frame [m]."""
    rays = np.stack([column + 0.5, row + 0.5, np.ones(len(row))], axis=-1) @ np.linalg.inv(K).T
    points: Float64s = rays * shown.depth[row, column, None].astype(np.float64)
    return points


def _is_near(points: Float64s, body: Float64s) -> Bools:
    """Which points may be of the clothes or hair over the vertices of a body."""
    if not len(points):
        return np.zeros(0, dtype=np.bool_)
    distance, _ = cKDTree(body).query(points)
    return np.asarray(distance < _CLOTHES, dtype=np.bool_)


def flow_error(
    drawn: Drawn,
    after: Drawn,
    shown: Shown,
    flow: Floats,
    number: int,
    track: int,
    K: tuple[Float64s, Float64s],
) -> tuple[float, float]:
    """Median difference of the flow and the motion of one person's bare, visible vertices, in x and y [px].

    Zero where hardly any vertex is bare and in view.

    Args:
        drawn: the labelled bodies of this frame.
        after: of the next.
        shown: the images of this frame.
        flow: ``(H, W, 2)`` of this frame.
        number: which of the people.
        track: the id in the mask.
        K: intrinsics of this frame and the next.
    """
    here, there = drawn.vertices[number], after.vertices[number]
    ahead = np.flatnonzero((here[:, 2] > 0.1) & (there[:, 2] > 0.1))
    pixel = project_points(here[ahead], K[0])
    height, width = shown.mask.shape
    inside = ((pixel >= 0) & (pixel < [width, height])).all(axis=1)
    ahead, pixel = ahead[inside], pixel[inside]
    column, row = pixel.astype(np.intp).T
    depth = here[ahead, 2]
    skin = drawn.raster.depth[row, column]
    bare = (shown.mask[row, column] == track) & (np.abs(skin - depth) < 0.01)
    bare[bare] = np.abs(shown.depth[row[bare], column[bare]] - skin[bare]) < _BARE
    if np.count_nonzero(bare) < 30:
        return 0.0, 0.0
    moved = project_points(there[ahead[bare]], K[1]) - pixel[bare]
    x, y = np.median(np.abs(flow[row[bare], column[bare]] - moved), axis=0)
    return float(x), float(y)


def likeness(drawn: Drawn, shown: Shown) -> float:
    """How well labels and images are of one moment, 0 to 1: agreement of ids and depths of all people."""
    body = drawn.raster.mesh >= 0
    either = np.count_nonzero(body | (shown.mask > 0))
    if not either:
        return float("nan")
    same = body & (drawn.track == shown.mask)
    gap = shown.depth[same] - drawn.raster.depth[same]
    # Under clothes the body is deeper. Were that held against a frame, one from which the camera is a little
    # farther would seem to fit better.
    gap = np.where(gap > 0, gap, np.maximum(-gap - _CLOTHES, 0.0))
    return float(np.exp(-gap / _RESIDUAL).sum() / either)


def whole_box(drawn: Drawn, number: int, K: Float64s) -> Float64s | None:
    """Box ``(4,)`` around the projected body, None if any of it is behind the camera."""
    points = drawn.vertices[number]
    if points[:, 2].min() < 0.05:
        return None
    x, y = project_points(points, K).T
    return np.array([x.min(), y.min(), x.max(), y.max()])


def mask_box(mask: Integers, track: int) -> AnyArray:
    """Box ``(4,)`` of the outer edges of a track's pixels; zeros if it has none."""
    rows, columns = np.nonzero(mask == track)
    if not len(rows):
        return np.zeros(4)
    return np.array([columns.min(), rows.min(), columns.max() + 1, rows.max() + 1], dtype=np.float64)
