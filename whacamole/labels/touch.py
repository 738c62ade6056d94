"""Who touches whom, where, and how far apart the parts of two people are, in one frame.

Three steps, each dearer than the one before and left with fewer points: patches against patches (balls),
points against samples (lower and upper bounds of the distance), points against triangles (exact and signed).
"""

from dataclasses import dataclass

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import connected_components
from scipy.spatial.distance import cdist

from whacamole.labels.arrays import Bools, Float64s, Indices
from whacamole.labels.closest import SkinSearch
from whacamole.labels.patches import PosedSkin, SkinMap

EXACT_WITHIN = 0.05
"""Gaps up to this are exact [m]; longer ones are measured between some vertices and may be too long."""

_LONG_EDGE = 0.05  # metres; bounds longer than any edge would tie no more points together


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
    coarse = a.map.coarse
    nearest = between.argmin(axis=1)
    order = np.lexsort((between[np.arange(len(between)), nearest], coarse.part))
    parts, first = np.unique(coarse.part[order], return_index=True)
    gaps = np.full(num_parts, np.inf)
    for part, mine in zip(parts, order[first], strict=True):
        if part >= 0:
            theirs = nearest[mine]
            own = a.points[coarse.start[mine] : coarse.start[mine + 1]]
            gaps[part] = cdist(own, b.points[coarse.start[theirs] : coarse.start[theirs + 1]]).min()
    return gaps


@dataclass(frozen=True, eq=False)
class _Near:
    """The fine patches of A that may decide anything, and those of B they must be held against.

    Attributes:
        mine: fine patches of A.
        theirs: fine patches of B.
        clear: for each of ``mine``, no other patch of B is nearer than this [m].
    """

    mine: Indices
    theirs: Indices
    clear: Float64s


def _near_patches(a: PosedSkin, b: PosedSkin, apart: Float64s, need: Float64s) -> _Near:
    """All pairs of fine patches whose balls are at most ``need`` apart.

    Args:
        a: the one whose patches decide how far is near.
        b: the other.
        apart: ``(m, m)`` distance between the balls round coarse patches [m].
        need: ``(m,)`` for each coarse patch of A [m].
    """
    close = apart <= need[:, None]
    mine, theirs = close.any(axis=1), close.any(axis=0)
    coarse_of = a.map.coarse_of
    fine_a, fine_b = np.flatnonzero(mine[coarse_of]), np.flatnonzero(theirs[coarse_of])
    if not len(fine_a):
        return _Near(fine_a, fine_b, np.zeros(0))
    beyond = np.where(theirs, np.inf, apart).min(axis=1)[coarse_of[fine_a]]
    centre_a, radius_a = a.map.fine.balls(a.points, fine_a)
    centre_b, radius_b = b.map.fine.balls(b.points, fine_b)
    apart = np.maximum(cdist(centre_a, centre_b) - radius_a[:, None] - radius_b, 0.0)
    close = apart <= need[coarse_of[fine_a], None]
    mine, theirs = close.any(axis=1), close.any(axis=0)
    clear = np.minimum(beyond, np.where(theirs, np.inf, apart).min(axis=1))
    return _Near(fine_a[mine], fine_b[theirs], clear[mine])


def _one_way(a: PosedSkin, b: PosedSkin, apart: Float64s, gap: Float64s, threshold: float) -> _Side:
    """Exact signed distances of all points of A that touch B, lie in B, or decide the gap of their part."""
    skin_map = a.map
    exact = np.minimum(np.append(gap, np.inf), EXACT_WITHIN)
    need = np.maximum(exact, threshold)
    near = _near_patches(a, b, apart, need[skin_map.coarse.part])
    if not len(near.mine):
        return _Side(near.mine, near.clear, near.mine, gap)
    points = skin_map.fine.points(near.mine)
    search = SkinSearch(b, skin_map.fine.points(near.theirs))
    within = max(float(need.max()), _LONG_EDGE)
    lower, upper = search.bounds(a.points[points], within)
    clear = np.zeros(len(skin_map.fine.centre))
    clear[near.mine] = near.clear
    lower = np.minimum(lower, clear[skin_map.fine.patch[points]])
    free, deep = _outside(a, b, points, lower, near.mine)
    part = skin_map.part[points]
    best = np.append(gap, -np.inf)
    np.minimum.at(best, part[free & (part >= 0)], upper[free & (part >= 0)])
    ask = ~free | (lower <= np.maximum(np.minimum(best[part], EXACT_WITHIN), threshold))
    found = search.closest(a.points[points[ask]], float(upper[ask].max(initial=0.0)))
    side = _Side(points[ask], found.distance, found.corner, gap)
    return _with_enclosed(side, a, b, deep) if len(deep) else side


def _outside(
    a: PosedSkin, b: PosedSkin, points: Indices, lower: Float64s, mine: Indices
) -> tuple[Bools, Indices]:
    """Which points of A are surely outside B: tied to a point outside B's box by edges too short to reach B.

    The ball round a patch that is not among ``mine`` holds the patch and all edges from it and does not touch
    B, so all its edges tie. An edge between two of ``points`` ties if it is shorter than one end's distance
    to B.

    Args:
        a: whose points.
        b: inside or outside whom.
        points: the points of the fine patches ``mine``.
        lower: their distance to B, at least.
        mine: fine patches.

    Returns:
        A flag for each of ``points``, and all points of other patches that may be inside B.
    """
    fine, count = a.map.fine, len(points)
    # Nodes: each of ``points``, then every fine patch; those of ``mine`` stay alone.
    node = count + fine.patch
    node[points] = np.arange(count)
    near = np.zeros(len(node), dtype=np.bool_)
    near[points] = True
    start, end = a.map.edge
    touched = np.flatnonzero(near[start] | near[end])
    start, end = node[start[touched]], node[end[touched]]
    clear = np.full(count + len(fine.centre), np.inf)
    clear[:count] = lower
    ties = a.edge_lengths(touched) < np.maximum(clear[start], clear[end])
    left_out = np.ones(len(fine.centre), dtype=np.bool_)
    left_out[mine] = False
    links = fine.links[:, left_out[fine.links[0]] & left_out[fine.links[1]]] + count
    i, j = np.concatenate([start[ties], links[0]]), np.concatenate([end[ties], links[1]])
    graph = scipy.sparse.coo_array((np.ones(len(i), dtype=np.int8), (i, j)), shape=(len(clear), len(clear)))
    _, label = connected_components(graph, directed=False)
    places = np.concatenate([a.points[points], a.points[fine.centre]])
    beyond = ((places < b.low) | (places > b.high)).any(axis=1)
    beyond[count + mine] = False
    anchored = np.zeros(len(clear), dtype=np.bool_)
    anchored[label[beyond]] = True
    free = anchored[label]
    return free[:count], fine.points(np.flatnonzero(left_out & ~free[count:]))


def _with_enclosed(side: _Side, a: PosedSkin, b: PosedSkin, points: Indices) -> _Side:
    """Add points far from B's skin that nothing ties to the outside: mostly the inside of a deep overlap."""
    found = SkinSearch(b, np.arange(len(b.points))).closest(a.points[points])
    return _Side(
        np.concatenate([side.near, points]),
        np.concatenate([side.distance, found.distance]),
        np.concatenate([side.corner, found.corner]),
        side.gap,
    )


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
