"""Which skin an item covers.

MakeHuman lists the vertices a suit hides, for its own pose. That leaves a rim of skin which may come through
once the body moves, so everything well under the cloth is hidden as well, and what must stay near an edge is
marked so that it can be drawn in. At collars the list takes too much: one would look into an empty neck.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from open_people.base_mesh import BODY_VERTICES, BaseMesh

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

NEAR: Final = 0.045
"""Cloth farther from the skin than this (metres) hangs over it and need not cover it."""

INSIDE_EDGE: Final = 0.02
"""Skin is kept this far (metres) behind the edge of the cloth: one can look in at a sleeve …"""

INSIDE_COLLAR: Final = 0.055
"""… and this far behind a collar, which stands off the neck: one looks deep into it from above."""

COLLAR_REACH: Final = 0.14
"""Edges within this distance of the neck joint (metres) belong to a collar."""

RIM: Final = 0.006
"""Skin nearer to the edge than this is not under the cloth."""

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


@dataclass(frozen=True, eq=False)
class Cover:
    """Skin vertices under a piece of cloth.

    Attributes:
        hidden: cannot be seen and are left out.
        under: all that lie under the cloth; those that are not hidden are drawn in a little.
    """

    hidden: Indices
    under: Indices


def cover(mesh: BaseMesh, body: Array, neck: Array, faces: Indices, cloth: Array, listed: Indices) -> Cover:
    """What the cloth covers in the T-pose.

    Args:
        mesh: the base mesh.
        body: ``(N, 3)`` its vertices in the T-pose.
        neck: ``(3,)`` the neck joint.
        faces, cloth: the item.
        listed: skin vertices that MakeHuman hides under the item.
    """
    skin = body[:BODY_VERTICES]
    points = surface_points(faces, cloth)
    distance, nearest = cKDTree(points).query(skin, distance_upper_bound=NEAR)
    found = np.flatnonzero(np.isfinite(distance))
    point = points[nearest[found]]
    towards = (point - skin[found]) / np.maximum(distance[found], 1e-6)[:, None]
    outside = np.einsum("nk,nk->n", towards, skin_normals(mesh, body)[found]) > FACING
    edges = edge_points(faces, cloth)
    collar = edges[np.linalg.norm(edges - neck, axis=1) < COLLAR_REACH]
    from_edge, from_collar = _distance(point, edges), _distance(point, collar)
    well = found[outside & (from_edge > INSIDE_EDGE) & (from_collar > INSIDE_COLLAR)]
    listed = listed[_distance(body[listed], collar) > INSIDE_COLLAR]
    hidden = np.union1d(listed, well)
    return Cover(hidden, np.union1d(hidden, found[outside & (from_edge > RIM)]))


def _distance(points: Array, to: Array) -> Array:
    """``(n,)`` distance to the nearest of ``to``; infinite where there is none."""
    return cKDTree(to).query(points)[0] if len(to) else np.full(len(points), np.inf)
