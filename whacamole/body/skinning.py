"""Linear blend skinning with shape, expression and pose correctives (SMPL, Loper et al. 2015, eqs. 2 to 10).

Every number here comes from elementwise operations and from sparse products that add in a fixed order: no
BLAS, whose sums change with the number of threads and the size of a batch. So a frame's vertices are the
same bits whatever frames it is posed with.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse
from scipy.spatial.transform import Rotation

from whacamole.body.joints import NUM_JOINTS, tree_levels

FloatArray = npt.NDArray[np.float64]
Float32Array = npt.NDArray[np.float32]
Sparse = Any  # scipy.sparse.csr_array; its type parameters differ between scipy-stubs releases

BLOCK = 32
"""Frames worked on at once: bounds the working memory (about 20 floats a vertex and frame)."""

_LEVELS = tree_levels()


@dataclass(frozen=True, eq=False)
class Skin:
    """What the vertices of one model need, in the form the products want.

    Attributes:
        correctives: sparse (3V, 10 + 486) float32, columns: expression, then R − I of 54 joints row by row.
        weights: sparse (V, 55) float32.
    """

    correctives: Sparse
    weights: Sparse

    @classmethod
    def build(cls, expression_dirs: Float32Array, posedirs: Sparse, weights: Float32Array) -> "Skin":
        """From expression directions (V, 3, 10), sparse pose directions (3V, 486) and weights (V, 55)."""
        expression = scipy.sparse.csr_array(expression_dirs.reshape(-1, expression_dirs.shape[-1]))
        correctives = scipy.sparse.hstack([expression, posedirs], format="csr", dtype=np.float32)
        correctives.sort_indices()
        return cls(correctives, scipy.sparse.csr_array(weights, dtype=np.float32))


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
    frames = len(local)
    turned, placed = forward_kinematics(local, rest)
    feature = np.concatenate([expression, (local[:, 1:] - np.eye(3)).reshape(frames, -1)], axis=1)
    bare = skin.correctives @ np.ascontiguousarray(feature.T, dtype=np.float32)
    bare += shaped
    x, y, z = bare.reshape(-1, 3, frames).transpose(1, 0, 2)
    moves = np.concatenate([turned, (placed - _apply(turned, rest))[..., None]], axis=-1, dtype=np.float32)
    columns = np.ascontiguousarray(moves.reshape(frames, NUM_JOINTS, 12).transpose(1, 2, 0))
    blend = (skin.weights @ columns.reshape(NUM_JOINTS, -1)).reshape(-1, 3, 4, frames)
    vertices = np.empty((len(x), 3, frames), dtype=np.float32)
    for axis in range(3):
        out, row = vertices[:, axis], blend[:, axis]
        np.multiply(row[:, 0], x, out=out)
        out += row[:, 1] * y
        out += row[:, 2] * z
        out += row[:, 3]
    return vertices, placed
