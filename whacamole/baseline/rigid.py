"""Rigid transforms as 4×4 matrices, for any leading axes."""

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]


def rigid(R: FloatArray, t: FloatArray) -> FloatArray:
    """Transforms (…, 4, 4) from rotations (…, 3, 3) and translations (…, 3)."""
    T = np.zeros((*np.broadcast_shapes(R.shape[:-2], t.shape[:-1]), 4, 4))
    T[..., :3, :3] = R
    T[..., :3, 3] = t
    T[..., 3, 3] = 1.0
    return T


def inverse(T: FloatArray) -> FloatArray:
    """The inverse of rigid transforms (…, 4, 4)."""
    turned = np.swapaxes(T[..., :3, :3], -1, -2)
    return rigid(turned, -rotate(turned, T[..., :3, 3]))


def rotate(R: FloatArray, points: FloatArray) -> FloatArray:
    """Rotations (…, 3, 3) of one point each (…, 3)."""
    turned: FloatArray = np.einsum("...ij,...j->...i", R, points)
    return turned


def runs_of(valid: BoolArray, shortest: int = 1) -> list[slice]:
    """The runs of frames without a gap, as slices, those shorter than ``shortest`` left out."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], valid, [False]]).astype(np.int8)))
    pairs = zip(edges[::2], edges[1::2], strict=True)
    return [slice(int(a), int(b)) for a, b in pairs if b - a >= shortest]
