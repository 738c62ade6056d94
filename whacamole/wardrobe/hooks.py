"""Points of a cloth that other surfaces hang below, with axes that turn as the cloth folds there."""

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import numpy.typing as npt
import scipy.sparse
import scipy.spatial

from whacamole.body import triangulated

FloatArray = npt.NDArray[np.float64]
Float32Array = npt.NDArray[np.float32]
Int32Array = npt.NDArray[np.int32]
IndexArray = npt.NDArray[np.int64]

SPLITS: Final = 4
"""Points along each side of a face where something may hang …"""

CARRIERS: Final = 6
"""… and how many of them carry one hook."""


@dataclass(frozen=True, eq=False)
class Hooks:
    """m points of a cloth of N vertices.

    Attributes:
        mix: sparse (m, N).
        edge: (m, 2) vertices of the cloth whose difference gives a direction along it.
        triangles: (F, 3) of the cloth around the hooks.
        around: sparse (m, F): whose normals count at a hook.
    """

    mix: Any  # scipy.sparse.csr_array
    edge: Int32Array
    triangles: Int32Array
    around: Any  # scipy.sparse.csr_array

    def of(self, chosen: IndexArray) -> "Hooks":
        """Some of them."""
        around = self.around[chosen]
        used = np.unique(around.indices)
        return Hooks(self.mix[chosen], self.edge[chosen], self.triangles[used], around[:, used])

    def points(self, cloth: Float32Array) -> tuple[Float32Array, Float32Array]:
        """The points (T, m, 3) on the cloth (T, N, 3), and vectors (T, m, 3) out of it.

        A vector is shorter than 1 where the faces around do not agree: in a sharp crease it shrinks to
        nothing before it turns round, so that what follows it does not jump.
        """
        corners = cloth[:, self.triangles]
        flat = _cross(corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0])
        area = _carry(self.around, np.linalg.norm(flat, axis=-1, keepdims=True))
        return _carry(self.mix, cloth), _carry(self.around, flat) / np.maximum(area, np.float32(1e-12))

    def frames(self, cloth: Float32Array) -> tuple[Float32Array, Float32Array]:
        """The points (T, m, 3) on the cloth (T, N, 3), and axes (T, m, 3, 3): outwards, two along it.

        All three axes are as long as the vector outwards (see :meth:`points`).
        """
        points, outwards = self.points(cloth)
        length = np.linalg.norm(outwards, axis=-1, keepdims=True)
        normal = outwards / np.maximum(length, np.float32(1e-9))
        along = cloth[:, self.edge[:, 1]] - cloth[:, self.edge[:, 0]]
        along -= (along * normal).sum(axis=-1, keepdims=True) * normal
        along *= length / np.maximum(np.linalg.norm(along, axis=-1, keepdims=True), np.float32(1e-9))
        return points, np.stack([outwards, along, _cross(normal, along)], axis=-2)


def hang(faces: Int32Array, cloth: FloatArray, below: FloatArray) -> Hooks:
    """Hooks for points (m, 3): where the cloth is nearest to them.

    Args:
        faces: (F, 4) of the cloth, −1 in the last column of a triangle.
        cloth: (N, 3).
        below: (m, 3).
    """
    corners = np.where(faces < 0, faces[:, 2:3], faces)
    t = (np.arange(SPLITS) + 0.5) / SPLITS
    u, v = (grid.ravel() for grid in np.meshgrid(t, t))
    shares = np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=1)
    at = np.einsum("pk,fkc->fpc", shares, cloth[corners]).reshape(-1, 3)
    distance, point = scipy.spatial.cKDTree(at).query(below, k=CARRIERS)
    weight = 1 / np.maximum(distance, 1e-3) ** 2
    weight /= weight.sum(axis=1, keepdims=True)
    face, place = np.divmod(point, len(shares))
    values = (weight[..., None] * shares[place]).ravel().astype(np.float32)
    rows = np.repeat(np.arange(len(below)), CARRIERS * corners.shape[1])
    mix = scipy.sparse.csr_array((values, (rows, corners[face].ravel())), shape=(len(below), len(cloth)))
    triangles = triangulated(faces)
    ones = np.ones(triangles.size, dtype=np.float32)
    entries = (ones, (triangles.ravel(), np.repeat(np.arange(len(triangles)), 3)))
    touches = scipy.sparse.coo_array(entries, shape=(len(cloth), len(triangles))).tocsr()
    return Hooks(mix, corners[face[:, 0], :2], triangles, scipy.sparse.csr_array(mix @ touches))


def _carry(mix: Any, values: Float32Array) -> Float32Array:
    """Values (T, n, k), mixed (m, n): (T, m, k)."""
    flat = np.ascontiguousarray(values.transpose(1, 0, 2)).reshape(values.shape[1], -1)
    return np.asarray((mix @ flat).reshape(mix.shape[0], *values.shape[::2]).transpose(1, 0, 2))


def _cross(a: Float32Array, b: Float32Array) -> Float32Array:
    """``np.cross`` along the last axis, several times faster."""
    ax, ay, az = a[..., 0], a[..., 1], a[..., 2]
    bx, by, bz = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx], axis=-1)
