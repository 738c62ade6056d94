"""The outer skin of a body: one closed surface, without eyeballs, teeth and tongue."""

from dataclasses import dataclass
from typing import Self

import numpy as np
import scipy.sparse
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from whacamole.labels.arrays import Float64s, Floats, Indices, Integers
from whacamole.labels.mesh import vertex_areas


@dataclass(frozen=True, eq=False)
class OuterSkin:
    """The connected surface of largest area, with its holes (eye sockets and the like) covered.

    "Inside" means nothing on a surface with holes, so every rim gets a fan of triangles to its mean point.

    Attributes:
        vertices: ``(n,)`` numbers of the body's vertices on the skin, ascending.
        faces: ``(F, 3)`` triangles of the closed skin, outward, into the array that :meth:`close` returns.
        rims: vertices of each hole; one point a rim is appended by :meth:`close`.
    """

    vertices: Indices
    faces: Indices
    rims: tuple[Indices, ...]

    @classmethod
    def build(cls, rest_vertices: Floats, faces: Integers) -> Self:
        """From a body at rest ``(V, 3)`` and its triangles ``(F, 3)``."""
        faces = np.asarray(faces, dtype=np.intp)
        count = len(rest_vertices)
        _, label = _components(count, faces[:, [0, 1, 2]].ravel(), faces[:, [1, 2, 0]].ravel())
        area = vertex_areas(np.asarray(rest_vertices, dtype=np.float64), faces)
        largest = np.bincount(label, weights=area).argmax()
        own = faces[label[faces[:, 0]] == largest]
        rims, lids = _lids(own, count)
        return cls(np.unique(own), np.concatenate([own, lids]), rims)

    def close(self, vertices: Floats) -> Float64s:
        """Body vertices ``(V, 3)`` in float64, the mean point of each rim appended: ``(V + holes, 3)``."""
        points = np.asarray(vertices, dtype=np.float64)
        if not self.rims:
            return points
        return np.concatenate([points, [points[rim].mean(axis=0) for rim in self.rims]])


def _components(count: int, a: Integers, b: Integers) -> tuple[int, NDArray[np.int32]]:
    """Connected components of vertices joined by edges ``a``-``b``: their number, and one label a vertex."""
    graph = scipy.sparse.coo_array((np.ones(len(a), dtype=np.int8), (a, b)), shape=(count, count))
    number, label = connected_components(graph, directed=False)
    return number, label


def _lids(faces: Indices, count: int) -> tuple[tuple[Indices, ...], Indices]:
    """Rims of the holes and the triangles that cover them; new points are numbered from ``count`` on."""
    a, b = faces.ravel(), faces[:, [1, 2, 0]].ravel()
    open_edge = ~np.isin(a * count + b, b * count + a)
    a, b = a[open_edge], b[open_edge]
    _, label = _components(count, a, b)
    holes = np.unique(label[a])
    rims = tuple(np.unique(a[label[a] == hole]) for hole in holes)
    # The lid runs along each open edge the other way, so that every edge is used once in each direction.
    middle = count + np.searchsorted(holes, label[a])
    return rims, np.stack([b, a, middle], axis=1)
