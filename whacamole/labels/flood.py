"""Which points of one skin are inside another, by following edges that do not cross it."""

from dataclasses import dataclass

import numpy as np
import scipy.sparse
from scipy.sparse.csgraph import connected_components

from whacamole.labels.arrays import Bools, Float64s, Indices
from whacamole.labels.patches import PosedSkin
from whacamole.labels.winding import inside


@dataclass(frozen=True, eq=False)
class Flood:
    """Points of A in groups that lie on one side of B's skin.

    Attributes:
        free: for each of the points asked about, whether it is surely outside B.
        group: for each of them, which others share its side.
        deep: other points that may be inside B, far from its skin.
        deep_group: their groups.
    """

    free: Bools
    group: Indices
    deep: Indices
    deep_group: Indices


def flood(a: PosedSkin, b: PosedSkin, points: Indices, lower: Float64s, mine: Indices) -> Flood:
    """Tie points of A by edges too short to reach B, and free those tied to a point outside B.

    The ball round a patch that is not among ``mine`` holds the patch and all edges from it and does not touch
    B, so all its edges tie. An edge between two of ``points`` ties if it is shorter than the distances of
    its ends to B together: the balls of these radii round them do not touch B either, and cover the edge.

    Args:
        a: whose points.
        b: inside or outside whom.
        points: the points of the patches ``mine``.
        lower: their distance to B, at least [m].
        mine: patches of A.
    """
    patches, count = a.map.patches, len(points)
    # Nodes: each of ``points``, then every patch; those of ``mine`` stay alone.
    node = count + patches.patch
    node[points] = np.arange(count)
    near = np.zeros(len(node), dtype=np.bool_)
    near[points] = True
    start, end = a.map.edge
    touched = np.flatnonzero(near.take(start) | near.take(end))
    start, end = node[start[touched]], node[end[touched]]
    clear = np.full(count + len(patches.centre), np.inf)
    clear[:count] = lower
    ties = a.edge_lengths(touched) < clear[start] + clear[end]
    left_out = np.ones(len(patches.centre), dtype=np.bool_)
    left_out[mine] = False
    links = patches.links[:, left_out[patches.links[0]] & left_out[patches.links[1]]] + count
    group = _connect(np.append(start[ties], links[0]), np.append(end[ties], links[1]), len(clear))
    places = np.concatenate([a.points[points], a.centre])
    beyond = ((places < b.low) | (places > b.high)).any(axis=1)
    beyond[count + mine] = False
    anchored = np.zeros(len(clear), dtype=np.bool_)
    anchored[group[beyond]] = True
    # A tied group that its box does not free, as a hand reached past somebody: one of its points tells.
    open_ = one_of_each(group[count:], left_out & ~anchored[group[count:]])
    anchored[group[count + open_[~inside(a.centre[open_], b)]]] = True
    free = anchored[group]
    deep = patches.points(np.flatnonzero(left_out & ~free[count:]))
    return Flood(free[:count], group[:count], deep, group[count + patches.patch[deep]])


def one_of_each(group: Indices, among: Bools) -> Indices:
    """The first of the flagged entries of every group."""
    flagged = np.flatnonzero(among)
    _, first = np.unique(group[flagged], return_index=True)
    return flagged[first]


def _connect(start: Indices, end: Indices, count: int) -> Indices:
    """Connected components of ``count`` nodes: one label a node."""
    ends = start.astype(np.int32), end.astype(np.int32)
    graph = scipy.sparse.coo_array((np.ones(len(start)), ends), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    return label.astype(np.intp)
