"""Who touches whom, where, and how far apart the parts of two people are, in one frame.

Three steps, each dearer than the one before and left with fewer points: patches against patches (balls),
points against samples (lower and upper bounds of the distance), points against triangles (exact and signed).
"""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import cdist

from whacamole.labels.arrays import Bools, Float64s, Indices
from whacamole.labels.closest import SkinSearch
from whacamole.labels.flood import flood, one_of_each
from whacamole.labels.patches import PosedSkin, SkinMap
from whacamole.labels.winding import inside

EXACT_WITHIN = 0.05
"""Gaps up to this are exact [m]; longer ones are measured between some vertices and may be too long."""

_ROWS_AT_ONCE = 1024

_TIE_WITHIN = (
    0.03  # metres from which B is searched whatever the need, so that most of A's edges are seen clear
)


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
    skin_map, patches = a.map, a.map.patches
    need = np.maximum(np.minimum(np.append(gap, -np.inf), EXACT_WITHIN), threshold)
    near = apart <= need[patches.part, None]
    mine = np.flatnonzero(near.any(axis=1))
    if not len(mine):
        return _far_or_enclosed(a, b, gap)
    # The others of B are farther than ``within`` from all of these, and from each as far as ``clear``.
    within = max(float(need.max()), _TIE_WITHIN)
    theirs = (apart[mine] <= np.maximum(need[patches.part[mine], None], _TIE_WITHIN)).any(axis=0)
    points = patches.points(mine)
    clear = np.where(theirs, np.inf, apart[mine]).min(axis=1)
    clear = np.repeat(clear, np.diff(patches.start)[mine])
    search = SkinSearch(b, patches.points(np.flatnonzero(theirs)))
    lower, upper = search.bounds(a.points[points], 1.001 * within)
    sides = flood(a, b, points, np.minimum(lower, clear), mine)
    part = skin_map.part[points]
    best = need.copy()
    counted = sides.free & (part >= 0)
    np.minimum.at(best, part[counted], upper[counted])
    ask = np.flatnonzero(~sides.free | (lower <= np.maximum(best[part], threshold)))
    found = search.closest(a.points[points[ask]], float(upper[ask].max(initial=0.0)))
    # Where the patches of B left out may be nearer than what was found, all of B must be searched.
    again = np.flatnonzero(~sides.free[ask] & (np.abs(found.distance) > clear[ask]))
    chosen = np.concatenate([points[ask], sides.deep])
    distance = np.append(found.distance, np.zeros(len(sides.deep)))
    corner = np.append(found.corner, np.zeros(len(sides.deep), dtype=np.intp))
    open_ = np.append(again, np.arange(len(ask), len(chosen)))
    if len(open_):
        more = _search_around(b, a.points[chosen[open_]]).closest(a.points[chosen[open_]])
        distance[open_], corner[open_] = more.distance, more.corner
    group = np.append(np.where(sides.free[ask], -1, sides.group[ask]), sides.deep_group)
    parts = skin_map.part[chosen], skin_map.part[corner]
    agreed = _agree(distance, group)
    doubtful = _doubtful(agreed, group, parts, len(gap), threshold)
    doubtful = doubtful[inside(a.points[chosen[doubtful]], b)]
    agreed[np.isin(group, group[doubtful])] *= -1
    return _Side(chosen, agreed, corner, gap)


def _agree(distance: Float64s, group: Indices) -> Float64s:
    """Signed distances with one sign a group; group -1 is outside."""
    within = np.isin(group, np.unique(group[(distance < 0) & (group >= 0)]))
    return np.where(within, -np.abs(distance), np.abs(distance))


def _doubtful(
    distance: Float64s, group: Indices, parts: tuple[Indices, Indices], num_parts: int, threshold: float
) -> Indices:
    """One point of each group that seems to be outside, where it makes a difference.

    Where B's skin crosses itself, a point inside may be nearest to a sheet that lies inside too, and the sign
    by normals then says outside. (It never errs the other way: behind any sheet is inside.) That matters if
    the point does not touch, or would be the deepest of its part or of the part of B it is closest to.
    """
    matters = distance > threshold
    for part in parts:
        deepest = np.full(num_parts + 1, np.inf)
        np.minimum.at(deepest, part, distance)
        matters |= -distance < deepest[part]
    return one_of_each(group, matters & (distance >= 0) & (group >= 0))


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
    return SkinSearch(skin, skin.map.patches.points(np.flatnonzero(among)))


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
