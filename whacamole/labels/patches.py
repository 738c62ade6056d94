"""A closed skin cut into patches, and these into cells, so that most of two bodies need never be compared."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Self

import numpy as np

from whacamole.labels.arrays import Float64s, Floats, Indices, dots, ranges, rows
from whacamole.labels.parts import BodyParts
from whacamole.labels.skin import OuterSkin

_PATCH, _PATCH_SIDE = 64, 0.15  # points a patch, and the longest side of its box at rest [m], at most
_CELL, _CELL_SIDE = 12, 0.06  # the same of a cell


@dataclass(frozen=True, eq=False)
class Lists:
    """A list of numbers for each of some things, one list after the other in ``values``.

    Attributes:
        values: all lists.
        start: where each begins, and the end.
    """

    values: Indices
    start: Indices

    @classmethod
    def build(cls, key: Indices, value: Indices, count: int) -> Self:
        """The distinct values that come with each key from 0 to ``count - 1``; arrays of any like shapes."""
        base = int(value.max(initial=0)) + 1
        pairs = np.unique(key * base + value)
        return cls(pairs % base, np.searchsorted(pairs // base, np.arange(count + 1)))

    def of(self, which: Indices) -> Indices:
        """The lists of some things, one after the other."""
        return self.values.take(members(self.start, which))

    def counts(self, which: Indices) -> Indices:
        """How long the lists of some things are."""
        length: Indices = self.start[which + 1] - self.start[which]
        return length


def members(start: Indices, which: Indices) -> Indices:
    """All members of some runs, ``start`` being where each run begins."""
    first = start[which]
    owner, offset = ranges(start[which + 1] - first)
    return first[owner] + offset


@dataclass(frozen=True, eq=False)
class Patches:
    """A partition of a skin's n points into m runs, each of one body part.

    Attributes:
        start: ``(m + 1,)`` where each patch's points begin, n at the end.
        patch: ``(n,)`` patch of each point.
        centre: ``(m,)`` the point nearest the middle of its patch at rest.
        part: ``(m,)`` body part, -1 for none.
        links: ``(2, L)`` pairs of patches with an edge between them, either way round.
    """

    start: Indices
    patch: Indices
    centre: Indices
    part: Indices
    links: Indices

    @classmethod
    def build(cls, sizes: Indices, points: Float64s, part: Indices, faces: Indices) -> Self:
        """From the sizes of the runs, points at rest ``(n, 3)``, their parts, and triangles ``(F, 3)``."""
        start = np.concatenate([[0], np.cumsum(sizes)])
        patch = np.repeat(np.arange(len(sizes)), sizes)
        sides = patch[faces[:, [[0, 1], [1, 2], [2, 0]]]].reshape(-1, 2)
        links = np.unique(sides[:, 0] * len(sizes) + sides[:, 1])
        return cls(
            start=start,
            patch=patch,
            centre=np.array([first + _most_central(points[first:end]) for first, end in pairwise(start)]),
            part=part[start[:-1]],
            links=np.stack([links // len(sizes), links % len(sizes)]),
        )

    @property
    def sizes(self) -> Indices:
        """``(m,)`` how many points each patch has."""
        sizes: Indices = np.diff(self.start)
        return sizes

    def points(self, which: Indices) -> Indices:
        """All points of some patches."""
        return members(self.start, which)


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
        owner: triangles around every point.
        patches: of at most 64 points and 15 cm.
        around: of every patch, all triangles with a corner in it.
        rim: of every patch, the corners of these.
        own: of every patch, triangles that are no other patch's.
        cells: of at most 12 points and 6 cm, the patches cut up.
        cell_patch: ``(k,)`` the patch of each cell.
        cell_start: ``(m + 1,)`` the first cell of each patch.
    """

    ids: Indices
    part: Indices
    faces: Indices
    corner: Indices
    edge: Indices
    owner: Lists
    patches: Patches
    around: Lists
    rim: Lists
    own: Lists
    cells: Patches
    cell_patch: Indices
    cell_start: Indices

    @classmethod
    def build(cls, skin: OuterSkin, parts: BodyParts, rest_vertices: Floats) -> Self:
        """From a body at rest ``(V, 3)``."""
        points = skin.close(rest_vertices)
        # A lid belongs to the commonest part of its rim.
        lids = [np.bincount(parts.vertex_part[rim] + 1).argmax() - 1 for rim in skin.rims]
        part = np.concatenate([parts.vertex_part, lids]).astype(np.intp)
        used = np.unique(skin.faces)
        large = [
            piece
            for name in np.unique(part[used])
            for piece in _bisect(used[part[used] == name], points, _PATCH, _PATCH_SIDE)
        ]
        small = [_bisect(piece, points, _CELL, _CELL_SIDE) for piece in large]
        ids = np.concatenate([piece for pieces in small for piece in pieces])
        renumber = np.full(len(points), -1, dtype=np.intp)
        renumber[ids] = np.arange(len(ids))
        faces, points, part = renumber[skin.faces], points[ids], part[ids]
        patches = Patches.build(np.array([len(piece) for piece in large]), points, part, faces)
        sizes = np.array([len(piece) for pieces in small for piece in pieces])
        cells = Patches.build(sizes, points, part, faces)
        patch, number = patches.patch[faces], np.arange(len(faces))
        return cls(
            ids=ids,
            part=part,
            faces=faces,
            corner=np.ascontiguousarray(faces.T),
            edge=_edges(faces, len(ids)),
            owner=Lists.build(faces, number[:, None], len(ids)),
            patches=patches,
            around=Lists.build(patch, number[:, None], len(large)),
            rim=Lists.build(patch[:, :, None], faces[:, None], len(large)),
            own=Lists.build(patch[:, 0], number, len(large)),
            cells=cells,
            cell_patch=patches.patch[cells.centre],
            cell_start=np.concatenate([[0], np.cumsum([len(pieces) for pieces in small])]),
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
        radius: ``(m,)`` their radii; the balls hold all triangles with a corner in the patch.
        low: ``(3,)`` corner of the box around all points.
        high: ``(3,)`` the opposite corner.
    """

    def __init__(self, skin_map: SkinMap, closed: Float64s) -> None:
        self.map = skin_map
        self.points = rows(closed, skin_map.ids)
        self.centre, self.radius = self._balls()
        # Reductions along the rows are many times faster in NumPy than down the columns.
        self._by_axis = np.ascontiguousarray(self.points.T)
        self.low, self.high = self._by_axis.min(axis=1), self._by_axis.max(axis=1)

    def _balls(self) -> tuple[Float64s, Float64s]:
        centre = rows(self.points, self.map.patches.centre)
        rim = self.map.rim
        step = rows(self.points, rim.values) - np.repeat(centre, np.diff(rim.start), axis=0)
        return centre, np.sqrt(np.maximum.reduceat(dots(step, step), rim.start[:-1]))

    def corner_reach(self, corners: Indices) -> Float64s:
        """How far points of triangles ``(3, F)`` are from all their corners, at most, squared [m²].

        In an acute triangle the radius of the circle round it, at the centre. In another at most half of the
        longest side, where the bisectors of the two others meet it.
        """
        sides = np.zeros(corners.shape)
        for axis in self._by_axis:
            at = axis.take(corners)
            for side, (start, end) in zip(sides, ((0, 1), (1, 2), (2, 0)), strict=True):
                step = at[end] - at[start]
                side += step * step
        longest, total = sides.max(axis=0), sides[0] + sides[1] + sides[2]
        acute = np.flatnonzero(2.0 * longest < total)
        reach: Float64s = 0.25 * longest
        a, b, c = sides.take(acute, axis=1)
        total = total[acute]
        area = total * total - 2.0 * (a * a + b * b + c * c)  # Heron's formula: four times the area, squared
        sound = area > 1e-8 * total * total  # not lost in rounding; a third of e² is never too little
        reach[acute] = np.where(sound, a * b * c / np.where(sound, area, 1.0), total / 3.0)
        return reach

    def edge_lengths(self, edges: Indices) -> Float64s:
        """Lengths of edges ``(N,)`` [m]."""
        start, end = self.map.edge.take(edges, axis=1)
        step = rows(self.points, start) - rows(self.points, end)
        lengths: Float64s = np.sqrt(dots(step, step))
        return lengths


def _bisect(ids: Indices, points: Float64s, most: int, side: float) -> list[Indices]:
    """Halve a set of points across its longest side until every piece is small."""
    sides = np.ptp(points[ids], axis=0)
    if len(ids) <= most and (sides.max() <= side or len(ids) == 1):
        return [ids]
    axis = sides.argmax()
    order = ids[np.argsort(points[ids, axis], kind="stable")]
    half = len(order) // 2
    return [*_bisect(order[:half], points, most, side), *_bisect(order[half:], points, most, side)]


def _most_central(points: Float64s) -> int:
    return int(((points - points.mean(axis=0)) ** 2).sum(axis=1).argmin())


def _edges(faces: Indices, count: int) -> Indices:
    """Edges ``(2, E)`` of a mesh of ``count`` points."""
    ends = np.sort(np.stack([faces, faces[:, [1, 2, 0]]], axis=-1), axis=-1)
    keys = np.unique(ends[..., 0] * count + ends[..., 1])
    return np.stack([keys // count, keys % count])
