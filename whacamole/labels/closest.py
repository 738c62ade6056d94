"""Closest points on triangles, and on which side of a closed skin a point lies."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.distance import cdist

from whacamole.labels.arrays import Float64s, Indices, cross, dots, lengths, rows
from whacamole.labels.patches import PosedSkin

_TIE = 1e-9  # metres within which triangles count as equally near: they share the closest edge or corner
_FIRST_SAMPLES = 8
_ROUNDED = 1 + 1e-6  # covers the rounding of a formula that subtracts what is nearly equal
_AT = 1e-9  # barycentric weight below which the closest point counts as on an edge


@dataclass(frozen=True, eq=False)
class Closest:
    """Of N points, the distance to a skin.

    Inside is where the angle-weighted normal at the closest point looks away from the query (Bærentzen and
    Aanæs 2005, exact for a closed surface that does not cross itself).

    Attributes:
        distance: ``(N,)`` signed, negative inside [m].
        corner: ``(N,)`` the skin point nearest to the closest point.
    """

    distance: Float64s
    corner: Indices


_Pairs = tuple[Indices, Indices, Float64s, Float64s]
"""M queries, M triangles, their squared distances [m²], barycentric weights ``(M, 3)`` of the foot."""


class SkinSearch:
    """Exact signed distance to part of a skin.

    The search goes by corners. Let q be the point of the skin closest to p, on some triangle, and x the
    corner of it nearest to q. Then |p - x|² <= |p - q|² + |q - x|²: inside the triangle p - q is at right
    angles to it, on an edge at right angles to the edge, and at a corner x is q. And |q - x| <= s; s² is what
    :meth:`PosedSkin.corner_reach` gives. So the least |p - x|² - s² over all corners, s the largest of the
    triangles around each, bounds |p - q|² from below, and the closest triangle is around one of the corners
    where it is at most |p - q|². With a fourth coordinate sqrt(S² - s²), S the largest s, this is a plain
    query for the nearest neighbour in a k-d tree.

    Args:
        skin: a closed skin.
        among: some of its patches; the triangles with a corner in them are searched.
    """

    def __init__(self, skin: PosedSkin, among: Indices) -> None:
        self._points, self._map = skin.points, skin.map
        self._centres = skin.centre[among]
        around = np.zeros(len(skin.map.faces), dtype=np.bool_)
        around[skin.map.around.of(among)] = True
        corners = skin.map.corner.take(np.flatnonzero(around), axis=1)
        slack = np.full(len(skin.points), -1.0)
        bound = _ROUNDED * skin.corner_reach(corners)
        for column in corners:
            np.maximum.at(slack, column, bound)
        self._sample = np.flatnonzero(slack >= 0)
        slack = slack.take(self._sample)
        self._largest = float(slack.max())
        self._places = rows(skin.points, self._sample)
        lifted = np.column_stack([self._places, np.sqrt(self._largest - slack)])
        self._tree = cKDTree(lifted, leafsize=32, balanced_tree=False, compact_nodes=False)

    def bounds(self, queries: Float64s, within: float) -> tuple[Float64s, Float64s]:
        """Lower and upper bounds ``(N,)`` of the unsigned distance [m].

        Where the lower bound passes ``within`` the answer is ``within`` and ``inf``.
        """
        power, sample = self._nearest(queries, 1, float(np.sqrt(within * within + self._largest)))
        low = np.minimum(np.sqrt(np.maximum(power[:, 0], 0.0)), within)
        high = np.full(len(queries), np.inf)
        found = np.flatnonzero(np.isfinite(power[:, 0]))
        step = rows(queries, found) - rows(self._places, sample[found, 0])
        high[found] = lengths(step)
        return low, high

    def at_most(self, queries: Float64s) -> Float64s:
        """A wide upper bound ``(N,)`` of the unsigned distance [m]."""
        far: Float64s = cdist(queries, self._centres).min(axis=1)
        return far

    def closest(self, queries: Float64s, within: float = np.inf) -> Closest:
        """Signed distances to the triangles searched, and the corners they were found at.

        ``within`` is a bound of the unsigned distances, if one is known; it saves time.
        """
        limit = float(np.sqrt(within * within + self._largest)) + _TIE
        query, triangle, square, weight = self._candidates(queries, limit, _FIRST_SAMPLES)
        best = np.full(len(queries), np.inf)
        np.minimum.at(best, query, square)
        tied = np.flatnonzero(square <= ((np.sqrt(best) + _TIE) ** 2)[query])
        # A triangle met at two of its samples must count once.
        key = query[tied] * len(self._map.faces) + triangle[tied]
        tied = tied[np.unique(key, return_index=True)[1]]
        row, triangle, weight = query[tied], triangle[tied], weight[tied]
        corners = rows(self._points, rows(self._map.faces, triangle))
        offset = rows(queries, row) - np.einsum("ij,ijk->ik", weight, corners)
        begin = np.flatnonzero(np.diff(row, prepend=-1))
        turn = _feature_angle(corners, weight) * dots(_unit_normals(corners), offset)
        side = np.add.reduceat(turn, begin)
        distance = np.sqrt(dots(offset[begin], offset[begin]))
        corner = self._map.faces[triangle[begin], weight[begin].argmax(axis=1)]
        return Closest(np.where(side < 0, -distance, distance), corner)

    def _nearest(self, queries: Float64s, count: int, limit: float) -> tuple[Float64s, Indices]:
        """The least power distances ``(N, count)`` [m²], inf beyond ``limit``, and their samples."""
        lifted = np.column_stack([queries, np.zeros(len(queries))])
        slots = list(range(1, count + 1))
        distance, sample = self._tree.query(lifted, k=slots, distance_upper_bound=limit)
        distance, sample = np.asarray(distance), np.asarray(sample)
        return distance * distance - self._largest, sample

    def _candidates(self, queries: Float64s, limit: float, count: int) -> _Pairs:
        """Pairs in which each query meets its closest triangle, all of them if several tie."""
        count = min(count, len(self._sample))
        power, sample = self._nearest(queries, count, limit)
        first = self._pairs(queries, np.arange(len(queries)), sample[:, 0])
        best = np.minimum.reduceat(first[2], np.flatnonzero(np.diff(first[0], prepend=-1)))
        reach = (np.sqrt(best) + _TIE) ** 2
        query, slot = np.nonzero(power[:, 1:] <= reach[:, None])
        found = [first, self._pairs(queries, query, sample[query, slot + 1])]
        unsure = np.flatnonzero(power[:, -1] <= reach)
        if len(unsure) and count < len(self._sample):
            query, triangle, square, weight = self._candidates(queries[unsure], limit, 4 * count)
            found.append((unsure[query], triangle, square, weight))
        query, triangle, square, weight = (np.concatenate(column) for column in zip(*found, strict=True))
        return query, triangle, square, weight

    def _pairs(self, queries: Float64s, query: Indices, sample: Indices) -> _Pairs:
        """Queries against the triangles around samples, one sample a row."""
        sample = self._sample[sample]
        triangle = self._map.owner.of(sample)
        query = np.repeat(query, self._map.owner.counts(sample))
        corners = rows(self._points, rows(self._map.faces, triangle))
        return query, triangle, *_square_distance(rows(queries, query), corners)


def _square_distance(points: Float64s, corners: Float64s) -> tuple[Float64s, Float64s]:
    """Squared distance of points ``(M, 3)`` to triangles ``(M, 3, 3)``, and weights ``(M, 3)`` of the foot.

    The foot of the perpendicular if it falls inside, else the nearest of the closest points on the three
    sides, all from the six dot products of the triangle's frame.
    """
    ab, ac = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    ap = points - corners[:, 0]
    bb, bc, cc = dots(ab, ab), dots(ab, ac), dots(ac, ac)
    pb, pc, pp = dots(ap, ab), dots(ap, ac), dots(ap, ap)
    with np.errstate(divide="ignore", invalid="ignore"):
        scale = 1.0 / (bb * cc - bc * bc)
        v, w = (cc * pb - bc * pc) * scale, (bb * pc - bc * pb) * scale
        on_ab = np.clip(pb / bb, 0, 1)
        on_ac = np.clip(pc / cc, 0, 1)
        on_bc = np.clip((pc - pb - bc + bb) / (bb + cc - 2 * bc), 0, 1)
    inside = (v >= 0) & (w >= 0) & (v + w <= 1)
    best = np.full(len(points), np.inf)
    best_v, best_w = np.zeros(len(points)), np.zeros(len(points))
    zero = np.zeros(len(points))
    for v_k, w_k, usable in (
        (v, w, inside),
        (on_ab, zero, ~inside),
        (zero, on_ac, ~inside),
        (1 - on_bc, on_bc, ~inside),
    ):
        square = pp + v_k * (v_k * bb - 2 * pb) + w_k * (w_k * cc - 2 * pc) + 2 * v_k * w_k * bc
        better = usable & (square < best)
        best = np.where(better, square, best)
        best_v, best_w = np.where(better, v_k, best_v), np.where(better, w_k, best_w)
    return np.maximum(best, 0.0), np.stack([1 - best_v - best_w, best_v, best_w], axis=1)


def _feature_angle(corners: Float64s, weight: Float64s) -> Float64s:
    """How much of the surface around the foot a triangle holds: the weights of an angle-weighted normal."""
    on_edge = (weight <= _AT).sum(axis=1)
    angle = np.where(on_edge == 0, 2 * np.pi, np.pi)
    at_corner = np.flatnonzero(on_edge == 2)
    if len(at_corner):
        triangle, here = corners[at_corner], weight[at_corner].argmax(axis=1)
        row = np.arange(len(at_corner))
        a = triangle[row, (here + 1) % 3] - triangle[row, here]
        b = triangle[row, (here + 2) % 3] - triangle[row, here]
        angle[at_corner] = np.arctan2(lengths(cross(a, b)), dots(a, b))
    return angle


def _unit_normals(corners: Float64s) -> Float64s:
    normals = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = lengths(normals)
    unit: Float64s = normals / np.where(size > 0, size, 1.0)[:, None]
    return unit
