"""A closed skin cut into patches, so that most of two bodies need never be compared."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Self

import numpy as np

from whacamole.labels.arrays import Float64s, Floats, Indices, dots, ranges, rows
from whacamole.labels.parts import BodyParts
from whacamole.labels.skin import OuterSkin

_PATCH, _PATCH_SIDE = 64, 0.15  # points a patch, and the longest side of its box at rest [m], at most


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
        faces: ``(F,)`` every triangle once, patch by patch.
        face_start: ``(m + 1,)`` where each patch's begin in ``faces``.
    """

    start: Indices
    patch: Indices
    centre: Indices
    part: Indices
    cover: Indices
    cover_start: Indices
    links: Indices
    faces: Indices
    face_start: Indices

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
            faces=np.argsort(patch[faces[:, 0]], kind="stable"),
            face_start=np.searchsorted(np.sort(patch[faces[:, 0]]), np.arange(len(sizes) + 1)),
        )

    def balls(self, points: Float64s) -> tuple[Float64s, Float64s]:
        """Centres ``(m, 3)`` and radii ``(m,)`` of balls round all triangles with a corner in a patch."""
        centre = rows(points, self.centre)
        step = rows(points, self.cover) - np.repeat(centre, np.diff(self.cover_start), axis=0)
        return centre, np.sqrt(np.maximum.reduceat(dots(step, step), self.cover_start[:-1]))

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
        patches: of at most 64 points and 15 cm.
    """

    ids: Indices
    part: Indices
    faces: Indices
    corner: Indices
    edge: Indices
    triangle_edge: Indices
    owner: Indices
    owner_start: Indices
    patches: Patches

    @classmethod
    def build(cls, skin: OuterSkin, parts: BodyParts, rest_vertices: Floats) -> Self:
        """From a body at rest ``(V, 3)``."""
        points = skin.close(rest_vertices)
        # A lid belongs to the commonest part of its rim.
        lids = [np.bincount(parts.vertex_part[rim] + 1).argmax() - 1 for rim in skin.rims]
        part = np.concatenate([parts.vertex_part, lids]).astype(np.intp)
        used = np.unique(skin.faces)
        pieces = [
            piece for name in np.unique(part[used]) for piece in _bisect(used[part[used] == name], points)
        ]
        ids = np.concatenate(pieces)
        renumber = np.full(len(points), -1, dtype=np.intp)
        renumber[ids] = np.arange(len(ids))
        faces, points, part = renumber[skin.faces], points[ids], part[ids]
        edge, triangle_edge = _edges(faces, len(ids))
        owner, owner_start = _owners(faces, triangle_edge.T, len(ids), edge.shape[1])
        return cls(
            ids=ids,
            part=part,
            faces=faces,
            corner=np.ascontiguousarray(faces.T),
            edge=edge,
            triangle_edge=triangle_edge,
            owner=owner,
            owner_start=owner_start,
            patches=Patches.build(np.array([len(piece) for piece in pieces]), points, part, faces),
        )


class PosedSkin:
    """One person's skin in one frame.

    Args:
        skin_map: of the body model.
        closed: the points of :meth:`OuterSkin.close` [m].

    Attributes:
        map: ``skin_map``.
        points: ``(n, 3)`` in the order of the map [m].
        centre: ``(m, 3)`` centres of the balls round the patches, themselves points of the skin.
        radius: ``(m,)`` their radii; see :meth:`Patches.balls`.
        low: ``(3,)`` corner of the box around all points.
        high: ``(3,)`` the opposite corner.
    """

    def __init__(self, skin_map: SkinMap, closed: Float64s) -> None:
        self.map = skin_map
        self.points = rows(closed, skin_map.ids)
        self.centre, self.radius = skin_map.patches.balls(self.points)
        # Reductions along the rows are many times faster in NumPy than down the columns.
        self._by_axis = np.ascontiguousarray(self.points.T)
        self.low, self.high = self._by_axis.min(axis=1), self._by_axis.max(axis=1)

    def longest_side(self, corners: Indices) -> Float64s:
        """The longest side of each triangle ``(3, F)``, squared [m²]."""
        sides = np.zeros((3, corners.shape[1]))
        for axis in self._by_axis:
            at = axis.take(corners)
            for side, (start, end) in zip(sides, ((0, 1), (1, 2), (2, 0)), strict=True):
                step = at[end] - at[start]
                side += step * step
        longest: Float64s = sides.max(axis=0)
        return longest

    def edge_lengths(self, edges: Indices) -> Float64s:
        """Lengths of edges ``(N,)`` [m]."""
        start, end = self.map.edge.take(edges, axis=1)
        step = rows(self.points, start) - rows(self.points, end)
        lengths: Float64s = np.sqrt(dots(step, step))
        return lengths


def _bisect(ids: Indices, points: Float64s) -> list[Indices]:
    """Halve a set of points across its longest side until every piece is small."""
    sides = np.ptp(points[ids], axis=0)
    if len(ids) <= _PATCH and (sides.max() <= _PATCH_SIDE or len(ids) == 1):
        return [ids]
    axis = sides.argmax()
    order = ids[np.argsort(points[ids, axis], kind="stable")]
    half = len(order) // 2
    return [*_bisect(order[:half], points), *_bisect(order[half:], points)]


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
