"""Catmull-Clark subdivision as a matrix: built once for a mesh, applied to the vertices of every frame.

Rules of Catmull and Clark (1978), at boundaries those of cubic B-spline curves; an edge of more than two
faces counts as boundary. Blender's modifier gives the same points (without its limit surface).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

Ints = NDArray[np.int32]
Floats = NDArray[np.float32]
Matrix = sparse.csr_array


@dataclass(frozen=True)
class Refined:
    """A finer mesh.

    Attributes:
        operator: ``(V', V)``, takes the vertices of the coarse mesh to those of this one.
        faces: ``(F', 4)`` quads.
        uv: ``(F', 4, 2)``, interpolated linearly within each face, or None.
    """

    operator: Matrix
    faces: Ints
    uv: Floats | None


@dataclass(frozen=True)
class _Corners:
    """Every corner of every face: face, vertex, index in the faces array, and the corners beside it."""

    face: Ints
    vertex: Ints
    place: Ints
    following: Ints
    preceding: Ints


def subdivide(faces: Ints, uv: Floats | None, num_vertices: int, levels: int) -> Refined:
    """Subdivide a mesh.

    Args:
        faces: ``(F, 3)`` or ``(F, 4)``, where −1 in the fourth column marks a triangle.
        uv: ``(F, k, 2)`` one coordinate a face corner, or None.
        num_vertices: V.
        levels: how often, at least once.
    """
    refined = _once(faces, uv, num_vertices)
    for _ in range(levels - 1):
        finer = _once(refined.faces, refined.uv, refined.operator.shape[0])
        refined = Refined(finer.operator @ refined.operator, finer.faces, finer.uv)
    return refined


def _once(faces: Ints, uv: Floats | None, num_vertices: int) -> Refined:
    corners = _corners(faces)
    ends = np.sort(np.stack([corners.vertex, corners.vertex[corners.following]], axis=1), axis=1)
    edges, edge_of = np.unique(ends, axis=0, return_inverse=True)
    edge_of = edge_of.ravel()
    V, E, F = num_vertices, len(edges), len(faces)
    centre = _rows(_ones(corners.face, corners.vertex, (F, V)))
    middle = _rows(_ones(np.repeat(np.arange(E), 2), edges.ravel(), (E, V)))
    around = _ones(edge_of, corners.face, (E, F))
    inner = np.bincount(edge_of, minlength=E) == 2
    of_ends = _scaled(np.where(inner, 0.5, 1.0), middle)
    of_faces = _scaled(np.where(inner, 0.25, 0.0), around @ centre)
    vertex_points = _vertex_points(corners, edges, inner, centre, middle, V)
    first_edge, first_face = V, V + E
    onwards, back = first_edge + edge_of, first_edge + edge_of[corners.preceding]
    quads = np.stack([corners.vertex, onwards, first_face + corners.face, back], axis=1)
    operator = sparse.vstack([vertex_points, of_ends + of_faces, centre], format="csr")
    return Refined(Matrix(operator), quads.astype(np.int32), None if uv is None else _finer_uv(corners, uv))


def _vertex_points(
    corners: _Corners, edges: Ints, inner: NDArray[np.bool_], centre: Matrix, middle: Matrix, V: int
) -> Matrix:
    """Where the vertices of the coarse mesh go."""
    E = len(edges)
    touches = _ones(edges.ravel(), np.repeat(np.arange(E), 2), (V, E))
    valence = np.bincount(edges.ravel(), minlength=V).astype(float)
    rim = _ones(edges[~inner].ravel(), np.repeat(np.flatnonzero(~inner), 2), (V, E))
    rims = np.bincount(edges[~inner].ravel(), minlength=V)
    inside, on_rim = (rims == 0) & (valence > 0), rims == 2
    share: NDArray[np.float64] = np.divide(1.0, valence, out=np.zeros(V), where=inside)
    in_faces = _ones(corners.vertex, corners.face, (V, centre.shape[0]))
    kept = np.where(inside, (valence - 3.0) * share, np.where(on_rim, 0.5, 1.0))
    points = (
        _scaled(share**2, in_faces @ centre)
        + _scaled(2.0 * share**2, touches @ middle)
        + _scaled(np.where(on_rim, 0.25, 0.0), rim @ middle)
        + sparse.diags_array(kept)
    )
    return Matrix(points)


def _corners(faces: Ints) -> _Corners:
    width = faces.shape[1]
    sizes = (faces >= 0).sum(axis=1)
    face, column = np.nonzero(faces >= 0)
    index = np.arange(len(face), dtype=np.int32)
    last, first = column == sizes[face] - 1, column == 0
    return _Corners(
        face=face.astype(np.int32),
        vertex=faces[face, column],
        place=(face * width + column).astype(np.int32),
        following=np.where(last, index - column, index + 1).astype(np.int32),
        preceding=np.where(first, index + sizes[face] - 1, index - 1).astype(np.int32),
    )


def _finer_uv(corners: _Corners, uv: Floats) -> Floats:
    at = uv.reshape(-1, 2)[corners.place]
    count = np.bincount(corners.face)
    total = np.stack([np.bincount(corners.face, at[:, axis]) for axis in range(2)], axis=1)
    centre = (total / count[:, None])[corners.face]
    finer: Floats = np.stack(
        [at, (at + at[corners.following]) / 2, centre, (at + at[corners.preceding]) / 2], axis=1
    ).astype(np.float32)
    return finer


def _ones(rows: NDArray[Any], columns: NDArray[Any], shape: tuple[int, int]) -> Matrix:
    return Matrix((np.ones(len(rows)), (rows, columns)), shape=shape)


def _rows(matrix: Matrix) -> Matrix:
    """Each row divided by its sum."""
    return _scaled(1.0 / np.maximum(matrix.sum(axis=1), 1.0), matrix)


def _scaled(factors: NDArray[np.float64], matrix: Matrix) -> Matrix:
    return Matrix(sparse.diags_array(factors) @ matrix)
