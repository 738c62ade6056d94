"""How far points of one skin are from another, at least and at most: exact distances are dear."""

from dataclasses import dataclass

import numpy as np

from whacamole.labels.arrays import Float64s, Indices, lengths, rows
from whacamole.labels.closest import SkinSearch
from whacamole.labels.patches import PosedSkin, members

TIE_WITHIN = 0.03
"""B is searched this far from A, whatever the need, so that most of A's edges are seen clear of it [m]."""

_CELL_REACH = 0.04  # metres: points farther than this from the centre of their cell are always looked at


@dataclass(frozen=True, eq=False)
class Bounds:
    """How far points of A are from B, at least and at most.

    Attributes:
        low: ``(n,)`` at least [m]; inf outside the patches asked about.
        high: ``(n,)`` at most [m]; inf where it is not known.
        close: points whose bounds are their own. Each other one is farther than ``need``, and nearer to the
            centre of its cell than that is to B.
        cells: cells of the patches asked about.
        cell_low: distance of their centres, at least [m].
        need: ``(C + 1,)`` points of a part farther than this do not matter [m].
        least: ``(C + 1,)`` how far the nearest point of a part is, at most [m]; inf where it is not known.
    """

    low: Float64s
    high: Float64s
    close: Indices
    cells: Indices
    cell_low: Float64s
    need: Float64s
    least: Float64s


def bound(
    a: PosedSkin, search: SkinSearch, mine: Indices, clear: Float64s, need: Float64s, threshold: float
) -> Bounds:
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
    within = max(float(need[part[close]].max(initial=0.0)), TIE_WITHIN)
    own_low, own_high = search.bounds(rows(a.points, close), 1.001 * within)
    low[close] = np.maximum(low[close], np.minimum(own_low, clear[patch[close]]))
    high[close] = np.minimum(high[close], own_high)
    need = _lowered(need, part[close], own_high, threshold)
    least = np.full(len(need), np.inf)
    np.minimum.at(least, part[points], high[points])
    return Bounds(low, high, close, which, cell_low, need, least)


def _lowered(need: Float64s, part: Indices, high: Float64s, threshold: float) -> Float64s:
    """``need``, given points of some parts that are at most ``high`` from B; at least the threshold."""
    need = need.copy()
    np.minimum.at(need, part, high)
    return np.maximum(need, threshold)
