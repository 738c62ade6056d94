"""Which parts of a person touch other parts of the same person. docs/contact.md defines it."""

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.distance import cdist

from whacamole.labels.arrays import Bools, Float64s, Floats
from whacamole.labels.closest import SkinSearch
from whacamole.labels.patches import PosedSkin, SkinMap

SELF_APART = 0.1
"""Parts nearer to each other than this at rest are neighbours: that they touch says nothing [m]."""


def separable_parts(skin_map: SkinMap, closed_rest: Float64s, num_parts: int) -> Bools:
    """``(C, C)`` pairs of parts that can touch: at least :data:`SELF_APART` apart in the rest pose.

    Args:
        skin_map: of the body model.
        closed_rest: its closed skin at rest, as :meth:`OuterSkin.close` gives it [m].
        num_parts: C.
    """
    points = closed_rest[skin_map.ids]
    trees = [cKDTree(points[skin_map.part == part]) for part in range(num_parts)]
    apart = np.zeros((num_parts, num_parts), dtype=np.bool_)
    for one, tree in enumerate(trees):
        for other in range(one):
            if tree.n and trees[other].n:
                gap, _ = tree.query(trees[other].data, distance_upper_bound=SELF_APART)
                apart[one, other] = apart[other, one] = not np.isfinite(gap).any()
    return apart


def self_touch(skin: PosedSkin, separable: Bools, threshold: float) -> Bools:
    """``(C, C)`` pairs of parts of one skin that touch, symmetric.

    Two parts touch if a vertex of either is at most ``threshold`` from a triangle of the other, a triangle
    being of each part that one of its corners is of.

    Args:
        skin: the person.
        separable: ``(C, C)`` from :func:`separable_parts`.
        threshold: metres.
    """
    patches = skin.map.patches
    touching = np.zeros_like(separable)
    gaps: Floats = cdist(skin.centre, skin.centre) - skin.radius[:, None] - skin.radius
    named = np.flatnonzero(patches.part >= 0)
    own = patches.part[named]
    near = separable[own[:, None], own] & (gaps[np.ix_(named, named)] <= threshold)
    rows, columns = np.nonzero(near)
    for one, other in np.unique(np.stack([own[rows], own[columns]], axis=1), axis=0):
        if touching[one, other]:
            continue
        pair = (own[rows] == one) & (own[columns] == other)
        mine = patches.points(np.unique(named[rows[pair]]))
        search = SkinSearch(skin, np.unique(named[columns[pair]]))
        low, _ = search.bounds(skin.points[mine], 1.001 * threshold)
        asked = mine[low <= threshold]
        if len(asked):
            gap = np.abs(search.closest(skin.points[asked]).distance)
            touching[one, other] = touching[other, one] = bool((gap <= threshold).any())
    return touching
