"""Which skin an item covers.

MakeHuman lists the vertices a suit hides, for its own pose. That leaves a rim of skin which may come through
once the body moves, so everything well under the cloth is hidden as well.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from open_people.base_mesh import BODY_VERTICES, BaseMesh

Array = NDArray[np.float64]

NEAR: Final = 0.045
"""Cloth farther from the skin than this (metres) hangs over it and need not cover it."""

INSIDE_EDGE: Final = 0.02
"""Skin is kept this far (metres) behind the edge of the cloth: one can look in at a neck or a sleeve."""

FACING: Final = 0.5
"""Least cosine between the skin's normal and the way to the cloth."""

SPLITS: Final = 4
"""Points along each side of a cloth face at which its surface is sampled."""


def skin_normals(mesh: BaseMesh, vertices: Array) -> Array:
    """``(BODY_VERTICES, 3)`` unit normals."""
    quads = mesh.quads[mesh.faces_of("body")]
    p = vertices[quads]
    of_face = np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1])
    out = np.stack([np.bincount(quads.ravel(), np.repeat(of_face[:, k], 4)) for k in range(3)], axis=1)
    return out / np.linalg.norm(out, axis=1, keepdims=True)


def edge_points(faces: NDArray[np.int64], cloth: Array) -> Array:
    """Points along the open edges of the cloth (edges of one face only)."""
    corners = np.where(faces < 0, faces[:, :1], faces)
    edges = np.sort(np.concatenate([corners[:, [k, (k + 1) % 4]] for k in range(4)]), axis=1)
    edges, count = np.unique(edges[edges[:, 0] != edges[:, 1]], axis=0, return_counts=True)
    open_edges = cloth[edges[count == 1]]
    t = np.linspace(0, 1, SPLITS)[:, None, None]
    return ((1 - t) * open_edges[:, 0] + t * open_edges[:, 1]).reshape(-1, 3)


def surface_points(faces: NDArray[np.int64], cloth: Array) -> Array:
    """Points spread over the cloth."""
    p = cloth[np.where(faces < 0, faces[:, 2:3], faces)]
    t = (np.arange(SPLITS) + 0.5) / SPLITS
    u, v = (grid.reshape(-1, 1, 1) for grid in np.meshgrid(t, t))
    across = (1 - u) * ((1 - v) * p[:, 0] + v * p[:, 3]) + u * ((1 - v) * p[:, 1] + v * p[:, 2])
    return across.reshape(-1, 3)


def well_covered(mesh: BaseMesh, body: Array, faces: NDArray[np.int64], cloth: Array) -> NDArray[np.int64]:
    """Skin vertices that lie close under the cloth and away from its edges, in the T-pose."""
    skin = body[:BODY_VERTICES]
    points = surface_points(faces, cloth)
    distance, nearest = cKDTree(points).query(skin, distance_upper_bound=NEAR)
    found = np.flatnonzero(np.isfinite(distance))
    point = points[nearest[found]]
    towards = (point - skin[found]) / np.maximum(distance[found], 1e-6)[:, None]
    outside = np.einsum("nk,nk->n", towards, skin_normals(mesh, body)[found]) > FACING
    edges = edge_points(faces, cloth)
    inside = cKDTree(edges).query(point)[0] > INSIDE_EDGE if len(edges) else np.ones(len(point), bool)
    return found[outside & inside]
