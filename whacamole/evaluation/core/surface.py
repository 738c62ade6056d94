"""Errors of surfaces: points (V, 3, F) float32 [m], frames last, as skinning makes them.

With the frames last each step works on neighbouring numbers, and a few vertices at a time stay in the
processor's cache. Sums over the vertices of a tile are float32, those over tiles float64.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from whacamole.evaluation.core.alignment import FloatArray, Similarity, similarity_of_moments
from whacamole.evaluation.core.pose import MILLIMETRES

Float32Array = npt.NDArray[np.float32]
IntArray = npt.NDArray[np.intp]

_TILE = 128


@dataclass(frozen=True, eq=False)
class Region:
    """Vertices whose mean error is wanted.

    Attributes:
        rows: ascending (n,), ``None`` for all.
        shift: (3, F) [m], added to the predicted ones.
    """

    rows: IntArray | None
    shift: FloatArray


def region_errors(
    prediction: Float32Array, truth: Float32Array, regions: Sequence[Region]
) -> list[FloatArray]:
    """Mean ‖prediction + shift − truth‖ over the vertices of each region → (F,) [mm] each."""
    frames = truth.shape[2]
    totals = np.zeros((len(regions), frames))
    shifts = [_frames_last(region.shift) for region in regions]
    for start, theirs, ours in _tiles(prediction, truth):
        apart = theirs - ours
        for region, shift, total in zip(regions, shifts, totals, strict=True):
            chosen = apart
            if region.rows is not None:
                first, last = np.searchsorted(region.rows, (start, start + len(ours)))
                if first == last:
                    continue
                chosen = apart[region.rows[first:last] - start]
            total += _sum_of_lengths(chosen + shift)
    counts = [len(truth) if region.rows is None else len(region.rows) for region in regions]
    return [total / max(count, 1) * MILLIMETRES for total, count in zip(totals, counts, strict=True)]


def surface_similarity(prediction: Float32Array, truth: Float32Array) -> Similarity:
    """The similarity of each frame that takes ``prediction`` nearest to ``truth``, leading axis F."""
    frames = truth.shape[2]
    sums, products, squares = np.zeros((2, 3, frames)), np.zeros((3, 3, frames)), np.zeros(frames)
    for _, theirs, ours in _tiles(prediction, truth):
        for total, points in zip(sums, (theirs, ours), strict=True):
            total += (np.ones(len(points), np.float32) @ points.reshape(len(points), -1)).reshape(3, frames)
        products += np.einsum("nif,njf->ijf", ours, theirs)
        squares += np.einsum("nif,nif->f", theirs, theirs)
    count = len(truth)
    source, target = sums.transpose(0, 2, 1) / count
    covariance = products.transpose(2, 0, 1) / count - target[:, :, None] * source[:, None, :]
    return similarity_of_moments(source, target, covariance, squares / count - np.sum(source**2, axis=-1))


def aligned_error(prediction: Float32Array, truth: Float32Array, found: Similarity) -> FloatArray:
    """Mean ‖s R prediction + t − truth‖ over all vertices, a similarity a frame → (F,) [mm]."""
    turn = _frames_last((found.scale[:, None, None] * found.rotation).transpose(1, 2, 0))
    shift = _frames_last(found.translation.T)
    total = np.zeros(truth.shape[2])
    for _, theirs, ours in _tiles(prediction, truth):
        apart = np.einsum("ikf,nkf->nif", turn, theirs)
        apart += shift
        apart -= ours
        total += _sum_of_lengths(apart)
    return total / len(truth) * MILLIMETRES


def _tiles(prediction: Float32Array, truth: Float32Array) -> Iterator[tuple[int, Float32Array, Float32Array]]:
    """The first vertex of each tile and both sides of it."""
    for start in range(0, len(truth), _TILE):
        yield start, prediction[start : start + _TILE], truth[start : start + _TILE]


def _sum_of_lengths(vectors: Float32Array) -> Float32Array:
    """Σ over n of the lengths of (n, 3, F) → (F,)."""
    lengths = np.einsum("nif,nif->nf", vectors, vectors)
    np.sqrt(lengths, out=lengths)
    total: Float32Array = np.ones(len(lengths), np.float32) @ lengths
    return total


def _frames_last(array: FloatArray) -> Float32Array:
    """Neighbouring frames are neighbours in memory, whatever the strides were."""
    return np.ascontiguousarray(array, dtype=np.float32)
