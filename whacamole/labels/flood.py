"""Which points of one skin are inside another, by following lines that do not cross it."""

from dataclasses import dataclass

import numpy as np

from whacamole.labels.arrays import Bools, Float64s, Indices, lengths, rows
from whacamole.labels.patches import PosedSkin
from whacamole.labels.winding import inside

_MANY = 64  # a ray costs as much as the exact distance of about so many points


@dataclass(frozen=True, eq=False)
class Flood:
    """Points of A in groups that lie on one side of B's skin.

    Attributes:
        points: those asked about, then all others that may be inside B.
        free: whether each is surely outside B.
        enclosed: whether it is surely inside.
        group: which others share its side.
    """

    points: Indices
    free: Bools
    enclosed: Bools
    group: Indices


def flood(
    a: PosedSkin, b: PosedSkin, close: Indices, clear: Float64s, which: Indices, cell_clear: Float64s
) -> Flood:
    """Tie points of A by lines that do not reach B, and tell the side of those that hang together.

    The ball round a point with its distance to B, at least, as radius does not touch B. So B does not cross
    the line between two points that is shorter than their two distances together: both are on one side.
    Tied are the ends of edges, the centres of neighbouring cells, and each point to the centre of its cell.
    The ball round a patch without cells among ``which`` holds it and all edges from it and does not touch B.
    A group with a point beyond the box around B is outside. Where others hold many points that were not asked
    about, one centre of each tells.

    Args:
        a: whose points.
        b: inside or outside whom.
        close: some points. B parts no other point from the centre of its cell.
        clear: ``(n,)`` distance of every point to B, at least [m]; inf in the patches left out.
        which: the cells of some patches, all of them that ``close`` lie in.
        cell_clear: ``(k,)`` distance of the centre of every cell to B, at least [m].
    """
    cells, count = a.map.cells, len(close)
    # Nodes: each of ``close``, then the centre of every cell of ``which``, then every patch left out.
    stands = count + len(which) + a.map.cell_patch
    stands[which] = count + np.arange(len(which))
    node = stands.take(cells.patch)
    node[close] = np.arange(count)
    asked = np.zeros(len(node), dtype=np.bool_)
    asked[close] = True
    start, end = a.map.edge
    touched = np.flatnonzero(asked.take(start) | asked.take(end))
    start, end = start.take(touched), end.take(touched)
    ties = a.edge_lengths(touched) < clear.take(start) + clear.take(end)
    centre = rows(a.points, cells.centre)
    one, other = _links_of(cells.links, which, len(centre))
    bridged = lengths(rows(centre, one) - rows(centre, other)) < cell_clear[one] + cell_clear[other]
    own = cells.patch[close]
    held = lengths(rows(a.points, close) - rows(centre, own)) < clear[close] + cell_clear[own]
    left_out = np.ones(len(a.centre), dtype=np.bool_)
    left_out[a.map.cell_patch[which]] = False
    links = a.map.patches.links
    links = count + len(which) + links[:, left_out[links[0]] & left_out[links[1]]]
    places = np.concatenate([rows(a.points, close), centre[which], a.centre])
    beyond = ((places < b.low) | (places > b.high)).any(axis=1)
    beyond[count + len(which) :] &= left_out
    start = np.concatenate([node[start[ties]], stands[one[bridged]], np.flatnonzero(held), links[0]])
    end = np.concatenate([node[end[ties]], stands[other[bridged]], stands[own[held]], links[1]])
    needed = ~(beyond.take(start) & beyond.take(end))
    group = _connect(start[needed], end[needed], len(places))
    anchored = np.zeros(len(places), dtype=np.bool_)
    anchored[group[beyond]] = True
    deep = np.flatnonzero(~(anchored[group].take(node) | asked))
    enclosed = np.zeros(len(places), dtype=np.bool_)
    if len(deep) > _MANY:
        # A tied group that its box does not free, as a hand reached past somebody.
        stand = np.zeros(len(places), dtype=np.bool_)
        stand[node[deep]] = True
        told = one_of_each(group, stand)
        within = inside(places[told], b)
        anchored[group[told[~within]]] = True
        enclosed[group[told[within]]] = True
        deep = deep[enclosed[group[node[deep]]]]
    points = np.append(close, deep)
    group = group[node[points]]
    return Flood(points, anchored[group], enclosed[group], group)


def _links_of(links: Indices, which: Indices, count: int) -> Indices:
    """``(2, L)`` those of the links between ``count`` cells that have an end among ``which``, each once."""
    among = np.zeros(count, dtype=np.bool_)
    among[which] = True
    return links[:, (links[0] < links[1]) & (among.take(links[0]) | among.take(links[1]))]


def one_of_each(group: Indices, among: Bools) -> Indices:
    """The first of the flagged entries of every group."""
    flagged = np.flatnonzero(among)
    _, first = np.unique(group[flagged], return_index=True)
    return flagged[first]


def _connect(start: Indices, end: Indices, count: int) -> Indices:
    """Connected components of ``count`` nodes: for each node the least node of its own.

    Each round hangs every component on the least of its neighbours. That takes a few passes over few edges,
    less time than SciPy needs to check its input.
    """
    label = np.arange(count)
    while True:
        one, other = label.take(start), label.take(end)
        apart = np.flatnonzero(one != other)
        if not len(apart):
            return label
        start, end, one, other = (ends.take(apart) for ends in (start, end, one, other))
        np.minimum.at(label, np.maximum(one, other), np.minimum(one, other))
        while True:
            above = label.take(label)
            if np.array_equal(above, label):
                break
            label = above
