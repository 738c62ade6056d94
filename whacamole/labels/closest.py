"""Closest points on triangles, and on which side of a closed skin a point lies."""

from dataclasses import dataclass, fields, replace

import numpy as np
from scipy.spatial import cKDTree

from whacamole.labels.arrays import Float64s, Indices, ranges
from whacamole.labels.mesh import face_normals
from whacamole.labels.patches import PosedSkin

_TIE = 1e-9  # metres within which triangles count as equally near: they share the closest edge or corner
_FIRST_SAMPLES = 4
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


@dataclass(frozen=True, eq=False)
class _Pairs:
    """M queries against triangles: squared distance [m²], and barycentric weights ``(M, 3)`` of the foot."""

    query: Indices
    triangle: Indices
    square: Float64s
    weight: Float64s


class SkinSearch:
    """Exact signed distance to part of a skin.

    The search goes by samples, the corners and the middles of the edges. Cut every triangle at the middles of
    its sides into four, with edges of at most e; let q be the point of the skin closest to p, and x the
    corner nearest to q of the small triangle that holds q. Then |q - x|² <= e²/3, and |p - x|² <= |p - q|² +
    e²/3: inside the triangle p - q stands at right angles to it, on an edge at right angles to the edge, and
    at a corner x is q. So the smallest |p - x|² - e²/3 over all samples bounds |p - q|² from below, and the
    closest triangle is around one of the samples where it is at most |p - q|². With a fourth coordinate
    sqrt(R² - e²/3), R² the largest e²/3, this is a plain nearest-neighbour query for a k-d tree.

    Args:
        skin: a closed skin.
        among: some of its points; the triangles with a corner among them are searched.
    """

    def __init__(self, skin: PosedSkin, among: Indices) -> None:
        self._points, self._map = skin.points, skin.map
        count = len(skin.points)
        flag = np.zeros(count, dtype=np.bool_)
        flag[among] = True
        a, b, c = skin.map.corner
        triangles = np.flatnonzero(flag[a] | flag[b] | flag[c])
        corners = skin.map.corner.take(triangles, axis=1)
        sides = skin.map.triangle_edge.take(triangles, axis=1)
        longest = np.maximum.reduce(skin.edge_lengths(sides))
        slack = np.full(count + skin.map.edge.shape[1], -1.0)
        for column in (*corners, *(count + sides)):
            np.maximum.at(slack, column, longest * longest / 12)
        self._sample = np.flatnonzero(slack >= 0)
        slack = slack[self._sample]
        whole, halved = np.split(self._sample, [np.searchsorted(self._sample, count)])
        start, end = skin.map.edge[:, halved - count]
        self._places = np.concatenate([self._points[whole], (self._points[start] + self._points[end]) / 2])
        self._largest = float(slack.max())
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
        step = queries[found] - self._places[sample[found, 0]]
        high[found] = np.sqrt(_dot(step, step))
        return low, high

    def closest(self, queries: Float64s, within: float = np.inf) -> Closest:
        """Signed distances to the triangles searched, and the corners they were found at.

        ``within`` is a bound of the unsigned distances, if one is known; it saves time.
        """
        limit = float(np.sqrt(within * within + self._largest)) + _TIE
        pairs = self._candidates(queries, limit, _FIRST_SAMPLES)
        best = np.full(len(queries), np.inf)
        np.minimum.at(best, pairs.query, pairs.square)
        tied = np.flatnonzero(np.sqrt(pairs.square) <= np.sqrt(best)[pairs.query] + _TIE)
        # A triangle met at two of its samples must count once.
        key = pairs.query[tied] * len(self._map.faces) + pairs.triangle[tied]
        tied = tied[np.unique(key, return_index=True)[1]]
        row, triangle, weight = pairs.query[tied], pairs.triangle[tied], pairs.weight[tied]
        corners = self._points[self._map.faces[triangle]]
        offset = queries[row] - (weight[..., None] * corners).sum(axis=1)
        begin = np.flatnonzero(np.diff(row, prepend=-1))
        turn = _feature_angle(corners, weight) * _dot(_unit_normals(corners), offset)
        side = np.add.reduceat(turn, begin)
        distance = np.linalg.norm(offset[begin], axis=1)
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
        found = [self._pairs(queries, np.arange(len(queries)), sample[:, 0])]
        best = np.minimum.reduceat(found[0].square, np.flatnonzero(np.diff(found[0].query, prepend=-1)))
        reach = (np.sqrt(best) + _TIE) ** 2
        query, slot = np.nonzero(power[:, 1:] <= reach[:, None])
        found.append(self._pairs(queries, query, sample[query, slot + 1]))
        unsure = np.flatnonzero(power[:, -1] <= reach)
        if len(unsure) and count < len(self._sample):
            more = self._candidates(queries[unsure], limit, 4 * count)
            found.append(replace(more, query=unsure[more.query]))
        return _Pairs(*(np.concatenate([getattr(part, f.name) for part in found]) for f in fields(_Pairs)))

    def _pairs(self, queries: Float64s, query: Indices, sample: Indices) -> _Pairs:
        """Queries against the triangles around samples, one sample a row."""
        start = self._map.owner_start[self._sample[sample]]
        which, offset = ranges(self._map.owner_start[self._sample[sample] + 1] - start)
        triangle = self._map.owner[start[which] + offset]
        corners = self._points[self._map.faces[triangle]]
        return _Pairs(query[which], triangle, *_square_distance(queries[query[which]], corners))


def _square_distance(points: Float64s, corners: Float64s) -> tuple[Float64s, Float64s]:
    """Squared distance of points ``(M, 3)`` to triangles ``(M, 3, 3)``, and weights ``(M, 3)`` of the foot.

    The foot of the perpendicular if it falls inside, else the nearest of the closest points on the three
    sides, all from the six dot products of the triangle's frame.
    """
    ab, ac = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    ap = points - corners[:, 0]
    bb, bc, cc = _dot(ab, ab), _dot(ab, ac), _dot(ac, ac)
    pb, pc, pp = _dot(ap, ab), _dot(ap, ac), _dot(ap, ap)
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
        angle[at_corner] = np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), _dot(a, b))
    return angle


def _unit_normals(corners: Float64s) -> Float64s:
    normals = face_normals(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.divide(normals, length, out=np.zeros_like(normals), where=length > 0)


def _dot(a: Float64s, b: Float64s) -> Float64s:
    product: Float64s = np.einsum("ij,ij->i", a, b)
    return product
