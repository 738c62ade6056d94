"""Linear blend skinning with shape, expression and pose correctives (SMPL, Loper et al. 2015, eqs. 2 to 10).

Every number of a sparse skin comes from elementwise operations and from products that add in a fixed order:
no BLAS, whose sums change with the number of threads and the size of a batch. So a frame's vertices are the
same bits whatever frames it is posed with. A dense skin trades that for speed.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse
from scipy.spatial.transform import Rotation

from whacamole.body.joints import tree_levels

FloatArray = npt.NDArray[np.float64]
Float32Array = npt.NDArray[np.float32]
Sparse = Any  # scipy.sparse.csr_array; its type parameters differ between scipy-stubs releases

BLOCK = 64
"""Frames worked on at once: bounds the working memory (three floats a vertex and frame)."""

_TILE = 128
"""Vertices worked on at once: with the frames of a block, what they need stays in the processor's cache."""

_LEVELS = tree_levels()


@dataclass(frozen=True, eq=False)
class Tile:
    """What some neighbouring vertices of a model need, in the form the products want.

    Attributes:
        correctives: (3n, 10 + 486) float32, columns: expression, then R − I of 54 joints row by row.
        weights: sparse (n, 55) float32.
    """

    correctives: Sparse | Float32Array
    weights: Sparse


@dataclass(frozen=True, eq=False)
class Skin:
    """What the vertices of one model need: tiles, in the order of the vertices."""

    tiles: tuple[Tile, ...]

    @classmethod
    def build(
        cls, expression_dirs: Float32Array, posedirs: Sparse, weights: Float32Array, *, dense: bool = False
    ) -> "Skin":
        """From expression directions (V, 3, E), sparse pose directions (3V, C) and weights (V, J).

        Args:
            dense: multiply the correctives by BLAS: several times faster where few of them are zero, but the
                last bits may differ between machines and batches.
        """
        expression = scipy.sparse.csr_array(expression_dirs.reshape(3 * len(weights), -1))
        correctives = scipy.sparse.hstack([expression, posedirs], format="csr", dtype=np.float32)
        correctives.sort_indices()
        blend = scipy.sparse.csr_array(weights, dtype=np.float32)
        parts = [
            (correctives[3 * a : 3 * (a + _TILE)], blend[a : a + _TILE])
            for a in range(0, len(weights), _TILE)
        ]
        return cls(tuple(Tile(part.toarray() if dense else part, share) for part, share in parts))

    @classmethod
    def joined(cls, skins: Sequence["Skin"]) -> "Skin":
        """Several skins as one, their vertices in order."""
        return cls(tuple(tile for skin in skins for tile in skin.tiles))


def rotations(pose: FloatArray) -> FloatArray:
    """Axis-angle (T, J, 3) to rotation matrices (T, J, 3, 3)."""
    return Rotation.from_rotvec(pose.reshape(-1, 3)).as_matrix().reshape(*pose.shape[:-1], 3, 3)


def _apply(R: FloatArray, v: FloatArray) -> FloatArray:
    """Product (…, 3, 3) · (…, 3), term by term so that no library chooses the order of the sum."""
    total: FloatArray = sum((R[..., k] * v[..., k, None] for k in (1, 2)), start=R[..., 0] * v[..., 0, None])
    return total


def _compose(A: FloatArray, B: FloatArray) -> FloatArray:
    """Product (…, 3, 3) · (…, 3, 3), term by term."""
    return np.stack([_apply(A, B[..., k]) for k in range(3)], axis=-1)


def forward_kinematics(local: FloatArray, rest: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Chain local rotations along the tree.

    Args:
        local: (T, 55, 3, 3) rotation of each joint in its parent's frame.
        rest: (T or 1, 55, 3) joints at rest [m].

    Returns:
        Global rotations (T, 55, 3, 3) and joints (T, 55, 3) [m] with the rest pelvis left in its place.
    """
    turned = local.copy()
    placed = np.empty(local.shape[:-1])
    placed[:, 0] = rest[:, 0]
    for joints, parents in _LEVELS:
        offset = rest[:, joints] - rest[:, parents]
        placed[:, joints] = placed[:, parents] + _apply(turned[:, parents], offset)
        turned[:, joints] = _compose(turned[:, parents], local[:, joints])
    return turned, placed


def skin_block(
    skin: Skin, shaped: Float32Array, expression: FloatArray, local: FloatArray, rest: FloatArray
) -> tuple[Float32Array, FloatArray]:
    """Pose one block of B frames, without translation.

    Args:
        skin: the model's sparse products.
        shaped: (3V, 1 or B) rest vertices for the shape [m].
        expression: (B, 10).
        local: (B, 55, 3, 3).
        rest: (B or 1, 55, 3) rest joints [m].

    Returns:
        Vertices (V, 3, B) and joints (B, 55, 3), rest pelvis in its place [m].
    """
    turned, placed = forward_kinematics(local, rest)
    feature = np.concatenate([expression, (local[:, 1:] - np.eye(3)).reshape(len(local), -1)], axis=1)
    moves = np.concatenate([turned, (placed - _apply(turned, rest))[..., None]], axis=-1)
    return deform(skin, shaped, feature, moves), placed


def deform(skin: Skin, shaped: Float32Array, feature: FloatArray, moves: FloatArray) -> Float32Array:
    """Vertices (V, 3, B) [m] of one block of B frames.

    Args:
        skin: the model's products.
        shaped: (3V, 1 or B) rest vertices for the shape [m].
        feature: (B, C) factors of the correctives.
        moves: (B, J, 3, 4) what takes a point at rest along with each joint.
    """
    frames, joints = moves.shape[:2]
    factors = np.ascontiguousarray(feature.T, dtype=np.float32)
    columns = np.ascontiguousarray(moves.reshape(frames, joints, 12).transpose(1, 2, 0), dtype=np.float32)
    columns = columns.reshape(joints, -1)
    vertices = np.empty((len(shaped) // 3, 3, frames), dtype=np.float32)
    start = 0
    for tile in skin.tiles:
        out = vertices[start : start + tile.weights.shape[0]]
        bare = tile.correctives @ factors
        bare += shaped[3 * start : 3 * start + len(bare)]
        blend = (tile.weights @ columns).reshape(-1, 3, 4, frames)
        blend[:, :, :3] *= bare.reshape(-1, 1, 3, frames)
        np.add(blend[:, :, 0], blend[:, :, 1], out=out)
        out += blend[:, :, 2]
        out += blend[:, :, 3]
        start += len(out)
    return vertices
