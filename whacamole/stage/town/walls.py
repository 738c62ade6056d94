"""Walls with openings: rectangles [m] on the plane of a front, (N, 4) as left, bottom, right, top."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from whacamole.stage.pile import Pile
from whacamole.stage.shapes import Solid

__all__ = ["THICK", "Rectangles", "bars", "panes", "pierced", "rectangles"]

Rectangles = NDArray[np.float64]

THICK = 0.24
"""Of the wall before what stands behind a front [m]."""


def rectangles(
    middle: NDArray[np.float64], bottom: NDArray[np.float64], size: tuple[float, float]
) -> Rectangles:
    """Return rectangles of one size in rows: every ``middle`` (M,) at every ``bottom`` (K,)."""
    x, z = (grid.ravel() for grid in np.meshgrid(middle, bottom))
    return np.stack([x - size[0] / 2, z, x + size[0] / 2, z + size[1]], axis=1)


def pierced(pile: Pile, finish: str, wall: Sequence[float], holes: Rectangles) -> None:
    """Lay a wall (left, bottom, right, top) with ``holes`` side by side on the pile; its face is on y = 0."""
    left, bottom, right, top = wall
    holes = holes[np.argsort(holes[:, 0])]
    edges = np.concatenate([[left], holes[:, [0, 2]].ravel(), [right]]).reshape(-1, 2)
    count = len(edges)
    piers = np.column_stack([edges[:, 0], np.full(count, bottom), edges[:, 1], np.full(count, top)])
    below = np.column_stack([holes[:, 0], np.full(len(holes), bottom), holes[:, 2], holes[:, 1]])
    above = np.column_stack([holes[:, 0], holes[:, 3], holes[:, 2], np.full(len(holes), top)])
    bars(pile, finish, np.concatenate([piers, below, above]), (0.0, THICK))


def bars(pile: Pile, finish: str, where: Rectangles, y: tuple[float, float]) -> None:
    """Lay boxes over rectangles on the pile, from ``y[0]`` back to ``y[1]``; none where one has no width."""
    kept = where[(where[:, 2] - where[:, 0] > 1e-6) & (where[:, 3] - where[:, 1] > 1e-6)]
    if len(kept):
        low = np.column_stack([kept[:, 0], np.full(len(kept), y[0]), kept[:, 1]])
        high = np.column_stack([kept[:, 2], np.full(len(kept), y[1]), kept[:, 3]])
        pile.add_boxes(finish, low, high)


def panes(where: Rectangles, y: float, pictures: NDArray[np.int64], sheet: tuple[int, int]) -> Solid:
    """Return flat panes (N) that show each its picture of a sheet of (rows, columns) of them."""
    rows, columns = sheet
    corner = np.array([[0, 1], [2, 1], [2, 3], [0, 3]])
    flat = where[:, corner]
    vertices = np.stack([flat[..., 0], np.full(flat.shape[:2], y), flat[..., 1]], axis=-1)
    cell = np.stack([pictures % columns, rows - 1 - pictures // columns], axis=1)
    uv = (cell[:, None] + np.array([[0, 0], [1, 0], [1, 1], [0, 1]])) / [columns, rows]
    return Solid(
        vertices.reshape(-1, 3).astype(np.float32),
        np.arange(4 * len(where), dtype=np.int32).reshape(-1, 4),
        uv.astype(np.float32),
    )
