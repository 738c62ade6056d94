"""Who touches whom, where, and how far apart the parts of two people are, in one frame.

Four steps, each dearer than the one before and left with fewer points: patches against patches (balls),
centres of cells and then points against corners (lower and upper bounds of the distance), points against
triangles (exact and signed).
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import cdist

from whacamole.labels.arrays import Bools, Float64s, Indices, lengths, rows
from whacamole.labels.closest import SkinSearch
from whacamole.labels.flood import Flood, flood, one_of_each
from whacamole.labels.patches import PosedSkin, SkinMap, members
from whacamole.labels.winding import inside

EXACT_WITHIN = 0.05
"""Gaps up to this are exact [m]; longer ones are measured between some vertices and may be too long."""

_ROWS_AT_ONCE = 1024

_TIE_WITHIN = (
    0.03  # metres from which B is searched whatever the need, so that most of A's edges are seen clear
)

_CELL_REACH = 0.04  # metres: points farther than this from the centre of their cell are always looked at


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

    ``near`` lists points whose signed distance is exact, with the corner of B they are nearest to.
    """

    near: Indices
    distance: Float64s
    corner: Indices
    gap: Float64s


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
    near = apart <= need[a.map.patches.part, None]
    mine = np.flatnonzero(near.any(axis=1))
    if not len(mine):
        return _far_or_enclosed(a, b, gap)
    # The others of B are farther than ``need`` from all of these, and from each as far as ``clear``.
    theirs = (apart[mine] <= np.maximum(need[a.map.patches.part[mine], None], _TIE_WITHIN)).any(axis=0)
    clear = np.where(theirs, np.inf, apart).min(axis=1)
    search = SkinSearch(b, np.flatnonzero(theirs))
    bounds = _bounds(a, search, mine, clear, need, threshold)
    cell_low = apart.min(axis=1)[a.map.cell_patch]
    cell_low[bounds.cells] = bounds.cell_low
    close = bounds.close
    sides = flood(a, b, close, bounds.low, bounds.cells, cell_low)
    asked = np.flatnonzero(~sides.free | (bounds.low[sides.points] <= bounds.need[part[sides.points]]))
    chosen, free, enclosed = sides.points[asked], sides.free[asked], sides.enclosed[asked]
    distance, corner = np.full(len(chosen), np.inf), np.zeros(len(chosen), dtype=np.intp)
    high = bounds.high[chosen]
    bounded = np.flatnonzero(np.isfinite(high))
    found = search.closest(a.points[chosen[bounded]], float(high[bounded].max(initial=0.0)))
    distance[bounded], corner[bounded] = found.distance, found.corner
    # Where the patches of B left out may be nearer than what was found, all of B must be searched.
    again = np.flatnonzero(~free & (np.abs(distance) > clear[patch[chosen]]) | np.isinf(distance))
    if len(again):
        more = _search_around(b, a.points[chosen[again]]).closest(a.points[chosen[again]])
        distance[again], corner[again] = more.distance, more.corner
    low = bounds.low
    low[chosen[~free]] = np.abs(distance[~free])
    group = np.where(free | enclosed, -1, sides.group[asked])
    group[_outside(a, low, sides, chosen, group)] = -1
    agreed = np.where(enclosed, -np.abs(distance), _agree(distance, group))
    doubtful = _doubtful(distance, agreed, group, (part[chosen], part[corner]), len(gap), threshold)
    told = inside(a.points[chosen[doubtful]], b)
    turned = group[doubtful[told != (agreed[doubtful] < 0)]]
    agreed[np.isin(group, turned)] *= -1
    return _Side(chosen, agreed, corner, gap)


@dataclass(frozen=True, eq=False)
class _Bounds:
    """How far points of A are from B, at least and at most.

    Attributes:
        low: ``(n,)`` at least [m]; inf outside the patches asked about.
        high: ``(n,)`` at most [m]; inf where it is not known.
        close: points whose bounds are their own. Each other one is farther than ``need``, and nearer to the
            centre of its cell than that is to B.
        cells: cells of the patches asked about.
        cell_low: distance of their centres, at least [m].
        need: ``(C + 1,)`` points of a part farther than this do not matter [m].
    """

    low: Float64s
    high: Float64s
    close: Indices
    cells: Indices
    cell_low: Float64s
    need: Float64s


def _bounds(
    a: PosedSkin, search: SkinSearch, mine: Indices, clear: Float64s, need: Float64s, threshold: float
) -> _Bounds:
    """Bounds for the points of some patches: by the centres of their cells, then where needed their own."""
    part, patch, cells = a.map.part, a.map.patches.patch, a.map.cells
    which, points = members(a.map.cell_start, mine), a.map.patches.points(mine)
    owner = np.repeat(np.arange(len(which)), cells.sizes[which])
    centre = rows(a.points, cells.centre[which])
    reach = lengths(rows(a.points, points) - rows(centre, owner))
    cell_low, cell_high = search.bounds(centre, 1.001 * float(need.max()) + _CELL_REACH)
    np.minimum(cell_low, clear[a.map.cell_patch[which]], out=cell_low)
    low, high = np.full(len(part), np.inf), np.full(len(part), np.inf)
    low[points] = np.minimum(cell_low[owner] - reach, clear[patch[points]])
    high[points] = cell_high[owner] + reach
    need = _lowered(need, cells.part[which], cell_high, threshold)
    close = points[low[points] <= need[part[points]]]
    within = max(float(need[part[close]].max(initial=0.0)), _TIE_WITHIN)
    own_low, own_high = search.bounds(rows(a.points, close), 1.001 * within)
    low[close] = np.maximum(low[close], np.minimum(own_low, clear[patch[close]]))
    high[close] = np.minimum(high[close], own_high)
    need = _lowered(need, part[close], own_high, threshold)
    return _Bounds(low, high, close, which, cell_low, need)


def _lowered(need: Float64s, part: Indices, high: Float64s, threshold: float) -> Float64s:
    """``need``, given points of some parts that are at most ``high`` from B; at least the threshold."""
    need = need.copy()
    np.minimum.at(need, part, high)
    return np.maximum(need, threshold)


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
    agreed: Float64s,
    group: Indices,
    parts: tuple[Indices, Indices],
    num_parts: int,
    threshold: float,
) -> Indices:
    """One point of each group whose side is in doubt, where it makes a difference.

    Where B's skin crosses itself, a point inside may be nearest to a sheet that lies inside too, and the sign
    by normals then says outside; or one outside to a sheet turned inside out. A group whose points disagree
    is in doubt. One that seems to be outside matters if a point of it does not touch, or would be the deepest
    of its part or of the part of B it is closest to.
    """
    matters = agreed > threshold
    for part in parts:
        deepest = np.full(num_parts + 1, np.inf)
        np.minimum.at(deepest, part, agreed)
        matters |= -agreed < deepest[part]
    matters = np.where(agreed < 0, distance > 0, matters)
    return one_of_each(group, matters & (group >= 0))


def _far_or_enclosed(a: PosedSkin, b: PosedSkin, gap: Float64s) -> _Side:
    """A skin with no patch near B's is outside, unless B is so much larger that it holds all of A."""
    none = np.zeros(0, dtype=np.intp)
    if (a.low < b.low).any() or (a.high > b.high).any():
        return _Side(none, np.zeros(0), none, gap)
    found = _search_around(b, a.points).closest(a.points)
    return _Side(np.arange(len(a.points)), found.distance, found.corner, gap)


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
    # Where an exact distance was asked for, it is no longer than the sampled bound.
    return Touch(np.minimum(shortest, own.gap), touched, points)
