"""Array types of the labels, and what is done with them everywhere."""

from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

_T = TypeVar("_T", bound=np.generic)

AnyArray = NDArray[Any]
Bools = NDArray[np.bool_]
Floats = NDArray[np.floating[Any]]
"""float32 or float64."""
Float64s = NDArray[np.float64]
Indices = NDArray[np.intp]
Integers = NDArray[np.integer[Any]]
"""Any integer type."""


def transformed(points: Floats, matrix: Floats) -> Float64s:
    """``matrix`` (k, 3) times every point ``(…, 3)``, in float64.

    Term by term, not by BLAS: the same bits whatever the number of points and threads, and no threads started
    for what takes a tenth of a millisecond.
    """
    x, y, z = (np.asarray(points[..., k, None], dtype=np.float64) for k in range(3))
    return np.asarray(x * matrix[:, 0] + y * matrix[:, 1] + z * matrix[:, 2], dtype=np.float64)


def ranges(counts: Indices) -> tuple[Indices, Indices]:
    """For counts ``[2, 0, 3]``: owners ``[0, 0, 2, 2, 2]`` and offsets ``[0, 1, 0, 1, 2]``."""
    owner = np.repeat(np.arange(len(counts)), counts)
    start = np.cumsum(counts) - counts
    return owner, np.arange(len(owner)) - start[owner]


def rows(values: NDArray[_T], ids: Indices) -> NDArray[_T]:
    """``values[ids]``; four times as fast where ``values`` has few columns."""
    return values.take(ids, axis=0)


def dots(a: Float64s, b: Float64s) -> Float64s:
    """Dot product of each of the vectors ``(N, 3)`` with its partner: ``(N,)``."""
    return np.asarray(a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2], dtype=np.float64)


def lengths(vectors: Float64s) -> Float64s:
    """Of vectors ``(N, 3)``: ``(N,)``."""
    return np.asarray(np.sqrt(dots(vectors, vectors)), dtype=np.float64)


def cross(a: Float64s, b: Float64s) -> Float64s:
    """Cross product of each of the vectors ``(N, 3)`` with its partner: ``(N, 3)``."""
    (ax, ay, az), (bx, by, bz) = a.T, b.T
    return np.column_stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx])
