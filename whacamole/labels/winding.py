"""How often a closed surface goes round a point: 0 outside, more inside, even where it crosses itself."""

import numpy as np

from whacamole.labels.arrays import Float64s, Indices


def winding_number(point: Float64s, points: Float64s, corner: Indices) -> float:
    """The signed solid angle of all triangles seen from ``point``, over 4π (van Oosterom and Strackee 1983).

    Args:
        point: ``(3,)``, not on the surface.
        points: ``(n, 3)`` of the surface.
        corner: ``(3, F)`` its triangles, outward; closed.
    """
    towards = points - point
    length = np.sqrt(np.einsum("ij,ij->i", towards, towards))
    ids_a, ids_b, ids_c = corner
    a, b, c = towards[ids_a], towards[ids_b], towards[ids_c]
    la, lb, lc = length[ids_a], length[ids_b], length[ids_c]
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    spread = la * lb * lc
    spread += np.einsum("ij,ij->i", a, b) * lc
    spread += np.einsum("ij,ij->i", b, c) * la
    spread += np.einsum("ij,ij->i", c, a) * lb
    return float(np.arctan2(volume, spread).sum() / (2 * np.pi))
