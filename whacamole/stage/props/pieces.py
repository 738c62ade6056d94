"""Pieces that furniture is put together from: rods, cushions, balls, fields of colour."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from whacamole.stage.props.prop import Part
from whacamole.stage.shapes import Solid, Vector, boxes, moved, tilted
from whacamole.stage.textures.interiors import CELLS

__all__ = ["box_part", "cushion", "in_cells", "legs", "rod"]

Floats = NDArray[np.float64]


def box_part(finish: str, *corners: Sequence[float]) -> Part:
    """Return boxes as one part; each is its low and its high corner, six numbers [m]."""
    both = np.asarray(corners)
    return Part(boxes(both[:, :3], both[:, 3:]), finish)


def rod(start: Vector, end: Vector, radius: float, sides: int = 8) -> Solid:
    """Return a closed round rod between two points [m]."""
    a, b = np.asarray(start, float), np.asarray(end, float)
    length = float(np.linalg.norm(b - a))
    axis = (b - a) / length
    aside = np.cross(axis, [1.0, 0.0, 0.0] if abs(axis[0]) < 0.7 else [0.0, 1.0, 0.0])
    aside /= np.linalg.norm(aside)
    other = np.cross(axis, aside)
    angle = np.arange(sides) * (2.0 * np.pi / sides)
    ring = radius * (np.cos(angle)[:, None] * aside + np.sin(angle)[:, None] * other)
    here = np.arange(sides)
    there = (here + 1) % sides
    lower, upper = np.full(sides, 2 * sides), np.full(sides, 2 * sides + 1)
    faces = [(here, there, there + sides), (here, there + sides, here + sides),
             (there, here, lower), (here + sides, there + sides, upper)]  # fmt: skip
    left, right = radius * angle, radius * (angle + 2.0 * np.pi / sides)
    zero, far = np.zeros(sides), np.full(sides, length)
    ends = ((left, zero), (right, zero), ((left + right) / 2, zero + radius))
    corners = [
        ((left, zero), (right, zero), (right, far)),
        ((left, zero), (right, far), (left, far)),
        ends,
        ends,
    ]
    uv = [np.stack([np.stack(corner, axis=1) for corner in one], axis=1) for one in corners]
    return Solid(
        np.concatenate([a + ring, b + ring, [a, b]]).astype(np.float32),
        np.concatenate([np.stack(face, axis=1) for face in faces]).astype(np.int32),
        np.concatenate(uv).astype(np.float32),
    )


_SIDES = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


def cushion(base: Vector, size: Vector, radius: float, puff: float = 0.0, lean: float = 0.0) -> Solid:
    """Return a box with round edges, to be shaded smoothly.

    Args:
        base: middle of its underside [m].
        size: before it is tilted [m].
        radius: of the edges [m].
        puff: share by which its thinnest side swells in the middle: a pillow, not a slab.
        lean: tilt backwards, towards +y [rad].
    """
    half = np.asarray(size, float) / 2.0
    radius = min(radius, 0.98 * float(half.min()))  # something is left between the edges
    quarter = np.tan(np.radians([0.0, 25.0, 45.0]))
    line, sign = np.concatenate([-quarter[::-1], quarter]), np.repeat([-1.0, 1.0], 3)
    u, v = (grid.ravel() for grid in np.meshgrid(line, line, indexing="ij"))
    su, sv = (grid.ravel() for grid in np.meshgrid(sign, sign, indexing="ij"))
    first = (np.arange(5)[:, None] * 6 + np.arange(5)).ravel()
    quads = np.stack([first, first + 6, first + 7, first + 1], axis=1)
    points: list[Floats] = []
    faces, uv = [], []
    for k, i, j in _SIDES:
        for end in (1.0, -1.0):
            direction, core = np.empty((36, 3)), np.empty((36, 3))
            direction[:, k], direction[:, i], direction[:, j] = end, u, v
            core[:, k], core[:, i], core[:, j] = end, su, sv
            unit = direction / np.linalg.norm(direction, axis=1, keepdims=True)
            place = core * (half - radius) + radius * unit
            faces.append((quads if end > 0 else quads[:, ::-1]) + 36 * len(points))
            uv.append(place[:, [i, j]][quads if end > 0 else quads[:, ::-1]])
            points.append(place)
    merged, index = np.unique(np.concatenate(points).round(6) + 0.0, axis=0, return_inverse=True)
    if puff:
        thin = int(np.argmin(half))
        others = [axis for axis in range(3) if axis != thin]
        edge = np.abs(merged[:, others] / half[others]).max(axis=1)
        merged[:, thin] *= 1.0 - puff * edge**3
    merged[:, 2] += half[2]
    solid = Solid(
        merged.astype(np.float32),
        index.ravel()[np.concatenate(faces)].astype(np.int32),
        np.concatenate(uv).astype(np.float32),
    )
    return moved(tilted(solid, (-lean, 0.0, 0.0)) if lean else solid, base)


def legs(width: float, depth: float, height: float, radius: float, splay: float = 0.0) -> list[Solid]:
    """Return four legs under a rectangle, their feet ``splay`` [m] farther out than their tops."""
    x, y = width / 2.0 - radius - splay, depth / 2.0 - radius - splay
    return [
        rod((sx * (x + splay), sy * (y + splay), 0.0), (sx * x, sy * y, height), radius)
        for sx in (-1.0, 1.0)
        for sy in (-1.0, 1.0)
    ]


def in_cells(solid: Solid, cells: NDArray[np.int64], faces_each: int) -> Solid:
    """Return a solid whose pieces of ``faces_each`` faces show one field each of a ``palette`` or ``art``.

    Args:
        cells: (N,) field of each piece, 0 … ``CELLS²`` − 1.
    """
    uv = solid.uv.reshape(len(cells), faces_each, *solid.uv.shape[1:])
    low, high = uv.min(axis=2, keepdims=True), uv.max(axis=2, keepdims=True)
    inside = 0.06 + 0.88 * (uv - low) / np.maximum(high - low, 1e-9)
    corner = np.stack([cells % CELLS, cells // CELLS], axis=1)[:, None, None]
    return Solid(
        solid.vertices, solid.faces, ((corner + inside) / CELLS).reshape(solid.uv.shape).astype(np.float32)
    )
