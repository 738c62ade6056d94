"""Who touches whom, where, and how far apart the parts of two people are, in one frame.

Four steps, each dearer than the one before and left with fewer points: patches against patches (balls),
centres of cells and then points against corners (lower and upper bounds of the distance), points against
triangles (exact and signed).
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import cdist

from whacamole.labels.arrays import Bools, Float64s, Indices, rows
from whacamole.labels.bounds import TIE_WITHIN, Bounds, bound
from whacamole.labels.closest import Closest, SkinSearch
from whacamole.labels.flood import Flood, flood, one_of_each
from whacamole.labels.patches import PosedSkin, SkinMap
from whacamole.labels.winding import inside

EXACT_WITHIN = 0.05
"""Gaps up to this are exact [m]; longer ones are measured between some vertices and may be too long."""

_ROWS_AT_ONCE = 1024


@dataclass(frozen=True, eq=False)
class Touch:
    """One person's parts against one other person. C parts, n points of the skin.

    Attributes:
        distance: ``(C,)`` shortest signed gap of each part [m], ``inf`` for a part without points.
        other_part: ``(C,)`` the other's part that a touching part touches, -1 for a part that does not touch.
        points: ``(n,)`` points of the skin that touch.
    """

    distance: Float64s
    other_part: Indices
    points: Bools


@dataclass
class _Side:
    """What one direction, points of A against the skin of B, has found so far.

    ``near`` lists points whose signed distance is exact, with the corner of B they are nearest to; ``within``
    points inside B, exact or not.
    """

    near: Indices
    distance: Float64s
    corner: Indices
    gap: Float64s
    within: Indices


def touch(a: PosedSkin, b: PosedSkin, num_parts: int, threshold: float) -> tuple[Touch, Touch]:
    """Contact between two people, seen from either.

    Args:
        a: one person's skin.
        b: the other's, of the same model.
        num_parts: C.
        threshold: a point this close to the other's skin, or inside, touches [m].
    """
    between = cdist(a.centre, b.centre)
    gap_a = _sampled_gaps(a, b, between, num_parts)
    gap_b = _sampled_gaps(b, a, between.T, num_parts)
    if _box_gap(a, b) > EXACT_WITHIN:
        none = np.full(num_parts, -1, dtype=np.intp)
        untouched = np.zeros(len(a.points), dtype=np.bool_)
        return Touch(gap_a, none, untouched), Touch(gap_b, none, untouched)
    apart = np.maximum(between - a.radius[:, None] - b.radius, 0.0)
    side_a = _one_way(a, b, apart, gap_a, threshold)
    side_b = _one_way(b, a, apart.T, gap_b, threshold)
    return _join(side_a, side_b, a.map, threshold), _join(side_b, side_a, a.map, threshold)


def _box_gap(a: PosedSkin, b: PosedSkin) -> float:
    """Distance between the boxes around two skins, 0 where they overlap."""
    return float(np.linalg.norm(np.maximum(np.maximum(a.low - b.high, b.low - a.high), 0.0)))


def _sampled_gaps(a: PosedSkin, b: PosedSkin, between: Float64s, num_parts: int) -> Float64s:
    """``(C,)`` upper bounds of the gaps, over all points of the two patches with the nearest centres."""
    patches = a.map.patches
    nearest = between.argmin(axis=1)
    order = np.lexsort((between[np.arange(len(between)), nearest], patches.part))
    parts, first = np.unique(patches.part[order], return_index=True)
    gaps = np.full(num_parts, np.inf)
    for part, mine in zip(parts, order[first], strict=True):
        if part >= 0:
            theirs = nearest[mine]
            own = a.points[patches.start[mine] : patches.start[mine + 1]]
            gaps[part] = cdist(own, b.points[patches.start[theirs] : patches.start[theirs + 1]]).min()
    return gaps


def _one_way(a: PosedSkin, b: PosedSkin, apart: Float64s, gap: Float64s, threshold: float) -> _Side:
    """Exact signed distances of all points of A that touch B, lie in B, or decide the gap of their part."""
    part, patch = a.map.part, a.map.patches.patch
    need = np.maximum(np.minimum(np.append(gap, -np.inf), EXACT_WITHIN), threshold)
    mine, theirs, clear = _patches_near(a, apart, need)
    if not len(mine):
        return _far_or_enclosed(a, b, gap)
    search = SkinSearch(b, theirs)
    bounds = bound(a, search, mine, clear, need, threshold)
    gap = np.minimum(gap, bounds.least[:-1])
    cell_low = apart.min(axis=1)[a.map.cell_patch]
    cell_low[bounds.cells] = bounds.cell_low
    sides = flood(a, b, bounds.close, bounds.low, bounds.cells, cell_low)
    asked = np.flatnonzero(~sides.free | (bounds.low[sides.points] <= bounds.need[part[sides.points]]))
    clear = clear[patch]
    clear[sides.points[sides.free]] = np.inf  # nearer than what was left out, if they matter
    within = sides.points[sides.enclosed]
    deep = _own_deepest(a, within, bounds)
    asked = asked[~sides.enclosed[asked]]
    chosen, free = sides.points[asked], sides.free[asked]
    count = len(chosen)
    chosen = np.append(chosen, within[deep])
    found = _measured(a, b, search, chosen, bounds.high, clear)
    more = within[~deep]
    more = more[_maybe_deepest(a, b, more, bounds.high, part[found.corner[count:]], found.distance[count:])]
    rest = _measured(a, b, search, more, bounds.high, clear)
    chosen, corner = np.append(chosen, more), np.append(found.corner, rest.corner)
    by_normals = found.distance[:count]
    low = bounds.low
    low[chosen[:count][~free]] = np.abs(by_normals[~free])
    group = np.where(free, -1, sides.group[asked])
    group[_outside(a, low, sides, chosen[:count], group)] = -1
    agreed = _agree(by_normals, group)
    distance = np.concatenate([agreed, -np.abs(found.distance[count:]), -np.abs(rest.distance)])
    doubtful = _doubtful(by_normals, distance, group, (part[chosen], part[corner]), len(gap), threshold)
    told = inside(a.points[chosen[doubtful]], b)
    turned = group[doubtful[told != (agreed[doubtful] < 0)]]
    distance[:count][np.isin(group, turned)] *= -1
    return _Side(chosen, distance, corner, gap, within)


def _patches_near(a: PosedSkin, apart: Float64s, need: Float64s) -> tuple[Indices, Indices, Float64s]:
    """Patches of A that matter, those of B to search for them, and how far each of A is from the others of B.

    The others are farther than ``need`` from all of A's that matter.
    """
    need = need[a.map.patches.part, None]
    mine = np.flatnonzero((apart <= need).any(axis=1))
    near = (apart[mine] <= np.maximum(need[mine], TIE_WITHIN)).any(axis=0)
    return mine, np.flatnonzero(near), np.where(near, np.inf, apart).min(axis=1)


def _own_deepest(a: PosedSkin, within: Indices, bounds: Bounds) -> Bools:
    """Which of the points ``within`` B may be the deepest of their part."""
    part = a.map.part[within]
    low = bounds.low[within]
    deepest = np.zeros(len(bounds.need))
    np.maximum.at(deepest, part, np.where(low < np.inf, low, 0.0))
    return np.asarray(bounds.high[within] >= deepest[part], dtype=np.bool_)


def _maybe_deepest(
    a: PosedSkin, b: PosedSkin, within: Indices, high: Float64s, part: Indices, depth: Float64s
) -> Bools:
    """Which of the points ``within`` B may be the deepest of those closest to some part of B.

    Of others the ``part`` and ``depth`` are known. The closest point of B lies in a patch whose ball is no
    farther than the point may be deep.
    """
    deepest = np.zeros(int(a.map.part.max()) + 2)
    np.maximum.at(deepest, part, np.abs(depth))
    most = high[within, None]
    may = deepest[b.map.patches.part] < most
    may &= cdist(rows(a.points, within), b.centre) - b.radius <= most
    return np.asarray(may.any(axis=1), dtype=np.bool_)


def _measured(
    a: PosedSkin, b: PosedSkin, search: SkinSearch, points: Indices, high: Float64s, clear: Float64s
) -> Closest:
    """Distances of points of A to all of B: searched anew where patches left out may be nearer."""
    if not len(points):
        return Closest(np.zeros(0), points)
    places, most = rows(a.points, points), high[points]
    unknown = np.flatnonzero(np.isinf(most))
    most[unknown] = search.at_most(places[unknown])
    found = search.closest(places, float(most.max()))
    again = np.flatnonzero(np.abs(found.distance) > clear[points])
    if len(again):
        more = _search_around(b, places[again]).closest(places[again])
        found.distance[again], found.corner[again] = more.distance, more.corner
    return found


def _outside(a: PosedSkin, low: Float64s, sides: Flood, chosen: Indices, group: Indices) -> Bools:
    """Which of the points ``chosen`` are of a group, not -1, with one tied to a point surely outside.

    Like :func:`flood`, but with the distances now known.
    """
    count = int(group.max(initial=-1)) + 2  # the last is of points in no group
    surely = np.ones(len(low), dtype=np.bool_)
    surely[sides.points[~sides.free]] = False
    group_of = np.full(len(low), count - 1)
    group_of[chosen] = np.where(group < 0, count - 1, group)
    asked = group_of < count - 1
    start, end = a.map.edge
    edges = np.flatnonzero(asked.take(start) & surely.take(end) | surely.take(start) & asked.take(end))
    start, end = start[edges], end[edges]
    ties = a.edge_lengths(edges) < low[start] + low[end]
    seen = np.zeros(count, dtype=np.bool_)
    seen[group_of[start[ties]]] = True
    seen[group_of[end[ties]]] = True
    seen[-1] = False
    return seen[group]


def _agree(distance: Float64s, group: Indices) -> Float64s:
    """Signed distances with one sign a group; group -1 is outside."""
    within = np.zeros(int(group.max(initial=0)) + 2, dtype=np.bool_)
    within[group[distance < 0]] = True
    within[-1] = False
    return np.where(within[group], -np.abs(distance), np.abs(distance))


def _doubtful(
    distance: Float64s,
    signed: Float64s,
    group: Indices,
    parts: tuple[Indices, Indices],
    num_parts: int,
    threshold: float,
) -> Indices:
    """One point of each group whose side is in doubt, where it makes a difference.

    ``distance`` has signs by normals, ``signed`` one sign a group; then come the distances of other points.

    Where B's skin crosses itself, a point inside may be nearest to a sheet that lies inside too, and the sign
    by normals then says outside; or one outside to a sheet turned inside out. A group whose points disagree
    is in doubt. One that seems to be outside matters if a point of it does not touch, or would be the deepest
    of its part or of the part of B it is closest to.
    """
    agreed = signed[: len(group)]
    matters = agreed > threshold
    for part in parts:
        deepest = np.full(num_parts + 1, np.inf)
        np.minimum.at(deepest, part, signed)
        matters |= -agreed < deepest[part[: len(group)]]
    matters = np.where(agreed < 0, distance > 0, matters)
    return one_of_each(group, matters & (group >= 0))


def _far_or_enclosed(a: PosedSkin, b: PosedSkin, gap: Float64s) -> _Side:
    """A skin with no patch near B's is outside, unless B is so much larger that it holds all of A."""
    none = np.zeros(0, dtype=np.intp)
    if (a.low < b.low).any() or (a.high > b.high).any():
        return _Side(none, np.zeros(0), none, gap, none)
    found = _search_around(b, a.points).closest(a.points)
    return _Side(np.arange(len(a.points)), found.distance, found.corner, gap, none)


def _search_around(skin: PosedSkin, points: Float64s) -> SkinSearch:
    """A search of all patches that may hold the point of the skin closest to one of ``points``.

    A patch's centre is a point of the skin, so the nearest centre bounds the distance; a patch whose ball is
    farther than that cannot hold the closest point.
    """
    among = np.zeros(len(skin.centre), dtype=np.bool_)
    for start in range(0, len(points), _ROWS_AT_ONCE):
        far = cdist(points[start : start + _ROWS_AT_ONCE], skin.centre)
        among |= (far - skin.radius <= far.min(axis=1, keepdims=True)).any(axis=0)
    return SkinSearch(skin, np.flatnonzero(among))


def _join(own: _Side, other: _Side, skin_map: SkinMap, threshold: float) -> Touch:
    """A's labels from its own points near B and from B's points that touch A, so that touch is mutual."""
    count = len(own.gap)
    theirs = np.flatnonzero(other.distance <= threshold)
    part = np.concatenate([skin_map.part[own.near], skin_map.part[other.corner[theirs]]])
    against = np.concatenate([skin_map.part[own.corner], skin_map.part[other.near[theirs]]])
    distance = np.concatenate([own.distance, other.distance[theirs]])
    order = np.lexsort((distance, part))
    order = order[part[order] >= 0]
    parts, first = np.unique(part[order], return_index=True)
    shortest = np.full(count, np.inf)
    shortest[parts] = distance[order[first]]
    touched = np.full(count, -1, dtype=np.intp)
    touched[parts] = against[order[first]]
    touched[shortest > threshold] = -1
    points = np.zeros(len(skin_map.ids), dtype=np.bool_)
    points[own.near[own.distance <= threshold]] = True
    points[own.within] = True
    # Where an exact distance was asked for, it is no longer than the sampled bound.
    return Touch(np.minimum(shortest, own.gap), touched, points)
