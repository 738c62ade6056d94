"""Cutting a surface along a line: the part of a mesh where a field over its vertices is positive."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy.sparse

Float32Array = npt.NDArray[np.float32]
FloatArray = npt.NDArray[np.float64]
Int32Array = npt.NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class Part:
    """A part of a surface.

    Attributes:
        mix: sparse (n, V) float32: the part's vertices as mixes of the surface's, one or two each.
        faces: (F, 3) in the part's vertices.
    """

    mix: scipy.sparse.csr_array
    faces: Int32Array

    def apply(self, values: Float32Array) -> Float32Array:
        """Values (T, V, k) on the surface, carried to the part (T, n, k)."""
        frames, count, width = values.shape
        flat = np.ascontiguousarray(values.transpose(1, 0, 2)).reshape(count, -1)
        carried = (self.mix @ flat).reshape(-1, frames, width)
        return np.ascontiguousarray(carried.transpose(1, 0, 2))

    def smoothed(self, rounds: int) -> "Part":
        """The part with its vertices drawn towards their neighbours ``rounds`` times; its edge stays."""
        edges = np.concatenate([self.faces[:, [k, (k + 1) % 3]] for k in range(3)])
        count = self.mix.shape[0]
        ones = np.ones(len(edges), dtype=np.float32)
        along = scipy.sparse.csr_array((ones, (edges[:, 0], edges[:, 1])), shape=(count, count))
        rim = np.unique((along - along.T).nonzero()[0])
        neighbours = ((along + along.T) > 0).astype(np.float32)
        inner = np.ones(count, dtype=np.float32)
        inner[rim] = 0
        degree = np.maximum(neighbours.sum(axis=1), 1)
        step = scipy.sparse.diags_array(0.5 * inner / degree) @ neighbours
        step = scipy.sparse.csr_array(step + scipy.sparse.diags_array(1 - 0.5 * inner))
        mix = self.mix
        for _ in range(rounds):
            mix = step @ mix
        return Part(scipy.sparse.csr_array(mix.astype(np.float32)), self.faces)


def clip_surface(faces: Int32Array, field: FloatArray) -> Part:
    """The part of a triangle mesh where a field, linear on each triangle, is not negative.

    A triangle that the line crosses is cut; neighbours share the new vertices, so that the part's edge is
    even.

    Args:
        faces: (F, 3).
        field: (V,).
    """
    inside = field >= 0
    count = inside[faces].sum(axis=1)
    corners: dict[tuple[int, int], int] = {}
    out: list[list[int]] = [[_corner(corners, int(v), int(v)) for v in face] for face in faces[count == 3]]
    for face in faces[(count == 1) | (count == 2)]:
        polygon = []
        for a, b in zip(face, np.roll(face, -1), strict=True):
            if inside[a]:
                polygon.append(_corner(corners, int(a), int(a)))
            if inside[a] != inside[b]:
                polygon.append(_corner(corners, min(int(a), int(b)), max(int(a), int(b))))
        out += [[polygon[0], polygon[k], polygon[k + 1]] for k in range(1, len(polygon) - 1)]
    return Part(
        _mix(np.array(list(corners), dtype=np.int64).reshape(-1, 2), field),
        np.array(out, np.int32).reshape(-1, 3),
    )


def _corner(corners: dict[tuple[int, int], int], a: int, b: int) -> int:
    """The number of the vertex on edge ``a``–``b``; of vertex ``a`` where both are one."""
    return corners.setdefault((a, b), len(corners))


def _mix(edges: npt.NDArray[np.int64], field: FloatArray) -> scipy.sparse.csr_array:
    a, b = field[edges[:, 0]], field[edges[:, 1]]
    whole = edges[:, 0] == edges[:, 1]
    share = np.where(whole, 0.5, np.divide(a, a - b, out=np.full(len(a), 0.5), where=~whole))
    rows = np.repeat(np.arange(len(edges)), 2)
    values = np.stack([1 - share, share], axis=1).ravel().astype(np.float32)
    return scipy.sparse.csr_array((values, (rows, edges.ravel())), shape=(len(edges), len(field)))
