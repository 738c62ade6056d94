"""A closed skin cut into patches, coarse and fine, so that most of two bodies need never be compared."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Self

import numpy as np

from whacamole.labels.arrays import Float64s, Floats, Indices, ranges
from whacamole.labels.parts import BodyParts
from whacamole.labels.skin import OuterSkin

_COARSE, _FINE = 64, 12  # points a patch, at most


@dataclass(frozen=True, eq=False)
class Patches:
    """A partition of a skin's n points into m runs, each of one body part.

    Attributes:
        start: ``(m + 1,)`` where each patch's points begin, n at the end.
        patch: ``(n,)`` patch of each point.
        centre: ``(m,)`` the point nearest the middle of its patch at rest.
        part: ``(m,)`` body part, -1 for none.
        cover: points of all triangles with a corner in a patch, patch by patch.
        cover_start: ``(m + 1,)`` where each patch's begin in ``cover``.
        links: ``(2, L)`` pairs of patches with an edge between them.
    """

    start: Indices
    patch: Indices
    centre: Indices
    part: Indices
    cover: Indices
    cover_start: Indices
    links: Indices

    @classmethod
    def build(cls, sizes: Indices, points: Float64s, part: Indices, faces: Indices) -> Self:
        """From the sizes of the runs, points at rest ``(n, 3)``, their parts, and triangles ``(F, 3)``."""
        start = np.concatenate([[0], np.cumsum(sizes)])
        patch = np.repeat(np.arange(len(sizes)), sizes)
        pairs = np.unique(patch[faces][:, :, None] * len(points) + faces[:, None, :])
        owner, cover = pairs // len(points), pairs % len(points)
        neighbours = np.unique(owner * len(sizes) + patch[cover])
        centre = [first + _most_central(points[first:end]) for first, end in pairwise(start)]
        return cls(
            start=start,
            patch=patch,
            centre=np.array(centre),
            part=part[start[:-1]],
            cover=cover,
            cover_start=np.searchsorted(owner, np.arange(len(sizes) + 1)),
            links=np.stack([neighbours // len(sizes), neighbours % len(sizes)]),
        )

    def balls(self, points: Float64s, which: Indices) -> tuple[Float64s, Float64s]:
        """Centres ``(k, 3)`` and radii ``(k,)`` of balls round all triangles with a corner in a patch."""
        count = self.cover_start[which + 1] - self.cover_start[which]
        owner, offset = ranges(count)
        centre = points[self.centre[which]]
        step = points[self.cover[self.cover_start[which][owner] + offset]] - centre[owner]
        square = np.einsum("ij,ij->i", step, step)
        return centre, np.sqrt(np.maximum.reduceat(square, np.cumsum(count) - count))

    def points(self, which: Indices) -> Indices:
        """All points of some patches."""
        owner, offset = ranges(self.start[which + 1] - self.start[which])
        return self.start[which][owner] + offset


@dataclass(frozen=True, eq=False)
class SkinMap:
    """The closed skin of a body model, renumbered so that patches are runs. Holds for every pose and shape.

    n points, F triangles, E edges.

    Attributes:
        ids: ``(n,)`` number of each point in the array of :meth:`OuterSkin.close`.
        part: ``(n,)`` body part of each point, -1 for none.
        faces: ``(F, 3)`` triangles, outward.
        corner: ``(3, F)`` the same, first corners first.
        edge: ``(2, E)`` points of every edge.
        triangle_edge: ``(3, F)`` edges of every triangle.
        owner: triangles around every sample, one sample after the other; the n + E samples are the points,
            then the middles of the edges.
        owner_start: ``(n + E + 1,)`` where each sample's triangles begin in ``owner``.
        coarse: patches of at most 64 points.
        fine: those cut into patches of at most 12.
        coarse_of: ``(m,)`` the coarse patch that holds each fine one.
    """

    ids: Indices
    part: Indices
    faces: Indices
    corner: Indices
    edge: Indices
    triangle_edge: Indices
    owner: Indices
    owner_start: Indices
    coarse: Patches
    fine: Patches
    coarse_of: Indices

    @classmethod
    def build(cls, skin: OuterSkin, parts: BodyParts, rest_vertices: Floats) -> Self:
        """From a body at rest ``(V, 3)``."""
        points = skin.close(rest_vertices)
        # A lid belongs to the commonest part of its rim.
        lids = [np.bincount(parts.vertex_part[rim] + 1).argmax() - 1 for rim in skin.rims]
        part = np.concatenate([parts.vertex_part, lids]).astype(np.intp)
        used = np.unique(skin.faces)
        coarse = [
            piece
            for name in np.unique(part[used])
            for piece in _bisect(used[part[used] == name], points, _COARSE)
        ]
        fine = [_bisect(piece, points, _FINE) for piece in coarse]
        ids = np.concatenate([piece for pieces in fine for piece in pieces])
        renumber = np.full(len(points), -1, dtype=np.intp)
        renumber[ids] = np.arange(len(ids))
        faces, points, part = renumber[skin.faces], points[ids], part[ids]
        edge, triangle_edge = _edges(faces, len(ids))
        owner, owner_start = _owners(faces, triangle_edge.T, len(ids), edge.shape[1])
        fine_sizes = np.array([len(piece) for pieces in fine for piece in pieces])
        return cls(
            ids=ids,
            part=part,
            faces=faces,
            corner=np.ascontiguousarray(faces.T),
            edge=edge,
            triangle_edge=triangle_edge,
            owner=owner,
            owner_start=owner_start,
            coarse=Patches.build(np.array([len(piece) for piece in coarse]), points, part, faces),
            fine=Patches.build(fine_sizes, points, part, faces),
            coarse_of=np.repeat(np.arange(len(fine)), [len(pieces) for pieces in fine]),
        )


class PosedSkin:
    """One person's skin in one frame.

    Args:
        skin_map: of the body model.
        closed: the points of :meth:`OuterSkin.close` [m].

    Attributes:
        map: ``skin_map``.
        points: ``(n, 3)`` in the order of the map [m].
        centre: ``(m, 3)`` centres of the balls round the coarse patches, themselves points of the skin.
        radius: ``(m,)`` their radii; see :meth:`Patches.balls`.
        low: ``(3,)`` corner of the box around all points.
        high: ``(3,)`` the opposite corner.
    """

    def __init__(self, skin_map: SkinMap, closed: Float64s) -> None:
        self.map = skin_map
        self.points = closed[skin_map.ids]
        coarse = skin_map.coarse
        self.centre, self.radius = coarse.balls(self.points, np.arange(len(coarse.centre)))
        # Reductions along the rows are many times faster in NumPy than down the columns.
        by_axis = np.ascontiguousarray(self.points.T)
        self.low, self.high = by_axis.min(axis=1), by_axis.max(axis=1)

    def edge_lengths(self, edges: Indices) -> Float64s:
        """Lengths of some edges [m], any shape of index."""
        start, end = self.map.edge
        step = self.points[start[edges]] - self.points[end[edges]]
        lengths: Float64s = np.sqrt(np.einsum("...j,...j->...", step, step))
        return lengths


def _bisect(ids: Indices, points: Float64s, limit: int) -> list[Indices]:
    """Halve a set of points across its longest side until no piece holds more than ``limit``."""
    if len(ids) <= limit:
        return [ids]
    axis = np.ptp(points[ids], axis=0).argmax()
    order = ids[np.argsort(points[ids, axis], kind="stable")]
    half = len(order) // 2
    return [*_bisect(order[:half], points, limit), *_bisect(order[half:], points, limit)]


def _most_central(points: Float64s) -> int:
    return int(((points - points.mean(axis=0)) ** 2).sum(axis=1).argmin())


def _edges(faces: Indices, count: int) -> tuple[Indices, Indices]:
    """Edges ``(2, E)`` of a mesh of ``count`` points, and those of each triangle ``(3, F)``."""
    ends = np.sort(np.stack([faces, faces[:, [1, 2, 0]]], axis=-1), axis=-1)
    keys, side = np.unique(ends[..., 0] * count + ends[..., 1], return_inverse=True)
    return np.stack([keys // count, keys % count]), np.ascontiguousarray(side.reshape(-1, 3).T)


def _owners(faces: Indices, triangle_edge: Indices, points: int, edges: int) -> tuple[Indices, Indices]:
    """Triangles around each point and each edge, one list after the other, and where each list begins."""
    sample = np.concatenate([faces, points + triangle_edge], axis=1).ravel()
    order = np.argsort(sample, kind="stable")
    return order // 6, np.searchsorted(sample[order], np.arange(points + edges + 1))
