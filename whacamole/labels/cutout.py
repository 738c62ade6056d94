"""Surfaces that the alpha of a texture cuts: hair, brows and lashes are cards, mostly air."""

from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import NDArray

from whacamole.labels.arrays import Bools, Float64s, Floats, Indices, Integers, transformed

OPAQUE = 0.5
"""Above this alpha a surface is there; at or below it is not. The renderers cut their masks here."""

_STEPS = 8  # a card is probed at this many steps along each side for the outline of what is there


@dataclass(frozen=True, eq=False)
class Cutout:
    """The alpha of a mesh's texture, and where each triangle lies on it.

    Attributes:
        alpha: ``(H, W)`` uint8, top row first; the texture repeats beyond its borders.
        uv: ``(F, 3, 2)`` texture coordinates of each triangle's corners, v up.
    """

    alpha: NDArray[np.uint8]
    uv: Float64s

    def opaque(self, triangle: Indices, weights: Float64s) -> Bools:
        """Whether points of the surface are there, alpha interpolated bilinearly between texel centres.

        Args:
            triangle: ``(N,)``.
            weights: ``(3, N)`` barycentric coordinates.
        """
        height, width = self.alpha.shape
        u, v = (weights * self.uv[triangle].transpose(2, 1, 0)).sum(axis=1)
        x, y = u * width - 0.5, (1.0 - v) * height - 0.5
        left, top = np.floor(x), np.floor(y)
        right_share, low_share = x - left, y - top
        columns = [(left + step).astype(np.intp) % width for step in (0, 1)]
        lines = [(top + step).astype(np.intp) % height for step in (0, 1)]
        upper, lower = (
            self.alpha[line, columns[0]] * (1.0 - right_share) + self.alpha[line, columns[1]] * right_share
            for line in lines
        )
        return np.asarray(upper * (1.0 - low_share) + lower * low_share > OPAQUE * 255, dtype=np.bool_)

    @cached_property
    def outline(self) -> tuple[Indices, Float64s]:
        """Outermost points that are there: triangles ``(N,)`` and barycentric coordinates ``(N, 3)``.

        Probed at eight steps along the sides of each triangle, so what is left out is narrower than that. Of
        the probes of a triangle the outermost in six directions stay.
        """
        grid = np.array([s for s in product(range(_STEPS + 1), repeat=3) if sum(s) == _STEPS]) / _STEPS
        count = len(self.uv)
        triangle = np.repeat(np.arange(count), len(grid))
        there = self.opaque(triangle, np.tile(grid, (count, 1)).T).reshape(count, len(grid))
        chosen = np.zeros_like(there)
        some = np.flatnonzero(there.any(axis=1))
        for corner, sign in product(range(3), (1, -1)):
            along = np.where(there[some], sign * grid[:, corner], -np.inf)
            chosen[some, along.argmax(axis=1)] = True
        kept, probe = np.nonzero(chosen)
        return kept, grid[probe]


class ProjectedCutout:
    """A cutout before a camera.

    A pixel p = (x, y, 1) sees the point with corner weights w where K [a b c] w is along p, so w is along
    (p·(b×c), p·(c×a), p·(a×b)) with the corners a, b, c in homogeneous pixels. That needs no division by
    depth, so triangles that reach behind the camera are no special case.

    Args:
        cutout: of the mesh.
        vertices: ``(V, 3)`` in the camera frame [m].
        faces: ``(F, 3)`` triangles.
        K: ``(3, 3)`` intrinsics in pixels.
    """

    def __init__(self, cutout: Cutout, vertices: Floats, faces: Integers, K: Float64s) -> None:
        self._cutout = cutout
        a, b, c = transformed(vertices, K)[faces].transpose(1, 0, 2)
        self._facing = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)])

    def opaque(self, triangle: Indices, x: Float64s, y: Float64s) -> Bools:
        """Whether there is a surface where triangles ``(N,)`` cover the pixels ``x``, ``y`` of the image."""
        normal = self._facing[:, triangle]
        weights = normal[..., 0] * x + normal[..., 1] * y + normal[..., 2]
        total = weights.sum(axis=0)
        weights /= np.where(total == 0, 1.0, total)
        # A triangle seen on edge has ill-conditioned weights; the point still lies on it.
        return self._cutout.opaque(triangle, np.clip(weights, 0.0, 1.0))
