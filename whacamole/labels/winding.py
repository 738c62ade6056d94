"""Which points are inside a closed skin, also where it crosses itself: by counting crossings along a ray.

The winding number of a point off the surface is how often a ray from it leaves the surface, less how often it
enters; it is positive inside. Each point takes the ray, of some, that meets the fewest patches: most that are
outside find one that meets none.
"""

import numpy as np

from whacamole.labels.arrays import Bools, Float64s, Indices, cross, dots, rows
from whacamole.labels.patches import PosedSkin

_AXES = np.random.default_rng(0).standard_normal((16, 3, 3))
_AXES, _ = np.linalg.qr(_AXES)
_AXES[:, :, 0] *= np.linalg.det(_AXES)[:, None]
"""Right-handed frames whose third axis is a ray, in general position: made meshes like axes and diagonals."""


def inside(points: Float64s, skin: PosedSkin) -> Bools:
    """Whether points ``(N, 3)`` that are not on a skin lie inside it: ``(N,)``."""
    if not len(points):
        return np.zeros(0, dtype=np.bool_)
    ray, met = _emptiest_rays(points, skin)
    query, patch = np.nonzero(met)
    faces = skin.map.own.of(patch)
    query = np.repeat(query, skin.map.own.counts(patch))
    crossings = _crossings(points, ray, query, skin, faces)
    number = np.bincount(query, weights=crossings, minlength=len(points))
    return number > 0.5


def _emptiest_rays(points: Float64s, skin: PosedSkin) -> tuple[Indices, Bools]:
    """For each point the number of a ray ``(N,)`` and the patches ``(N, m)`` whose balls it meets."""
    reach = skin.radius + 1e-6
    step = skin.centre - points[:, None]
    square = np.einsum("nmj,nmj->nm", step, step) - reach * reach
    along = np.stack([step @ axes[:, 2] for axes in _AXES])
    met = (square <= along * along) & (along >= -reach)
    best = met.sum(axis=2).argmin(axis=0)
    return best, met[best, np.arange(len(points))]


def _crossings(points: Float64s, ray: Indices, query: Indices, skin: PosedSkin, faces: Indices) -> Float64s:
    """``(M,)`` +1 where a ray leaves through a triangle, -1 where it enters, 0 where it misses.

    Seen along the ray, it passes an edge on one side or the other, by the sign of a product that is exactly
    opposite for the two triangles of the edge: no ray slips between two triangles or counts both.
    """
    start = rows(points, query)
    corners = [rows(skin.points, ids) - start for ids in skin.map.corner.take(faces, axis=1)]
    across = np.ascontiguousarray(_AXES[ray[query], :, :2])
    a, b, c = (np.einsum("ij,ijk->ki", corner, across) for corner in corners)
    left = [p[0] * q[1] - q[0] * p[1] for p, q in ((a, b), (b, c), (c, a))]
    leaves = (left[0] > 0) & (left[1] > 0) & (left[2] > 0)
    enters = (left[0] <= 0) & (left[1] <= 0) & (left[2] <= 0)
    hit = np.flatnonzero(leaves | enters)
    a, b, c = (corner[hit] for corner in corners)
    volume = dots(a, cross(b, c))
    forward = np.where(leaves[hit], volume > 0, volume < 0)
    sign = np.zeros(len(faces))
    sign[hit] = np.where(leaves[hit], 1.0, -1.0) * forward
    return sign
