"""Clothes and hair as a second skin: a surface that poses with the body, in the same sparse products.

An item vertex is a fixed mix of support vertices plus an offset. The support has shape, expression and pose
directions and skinning weights like the body; mixing them once gives the item its own, and from then on
it poses as a body does (:mod:`whacamole.body.skinning`).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
import numpy.typing as npt
import scipy.sparse
import scipy.spatial

from whacamole.body import NUM_BETAS, NUM_EXPRESSION, NUM_JOINTS, BodyModel, BodyParams
from whacamole.body.skinning import BLOCK, Skin, rotations, skin_block
from whacamole.wardrobe.catalogue import Catalogue, Slot

Float32Array = npt.NDArray[np.float32]

HELD_STIFFLY: Final[tuple[Slot, ...]] = ("shoes",)
"""Items hung on a few far vertices to keep their form; what moves them is the nearest skin."""

CARRIERS: Final = 4
"""Support vertices that carry a vertex of such an item."""


@dataclass(frozen=True, eq=False)
class Layer:
    """Items as one surface of N vertices.

    Attributes:
        template: (N, 3) float32 at rest, mean shape [m].
        shape_dirs: (3N, 10) float32 [m] a unit of beta.
        skin: what posing needs.
    """

    template: Float32Array
    shape_dirs: Float32Array
    skin: Skin

    @property
    def num_vertices(self) -> int:
        """N."""
        return len(self.template)

    def rest(self, betas: npt.NDArray[np.float64]) -> Float32Array:
        """Vertices (N, 3) at rest for one shape (10,) [m]."""
        moved: Float32Array = self.template.reshape(-1) + self.shape_dirs @ betas.astype(np.float32)
        return moved.reshape(-1, 3)

    def pose(self, body: BodyModel, params: BodyParams) -> Float32Array:
        """Vertices (T, N, 3) float32 in the frame of the parameters [m].

        Args:
            body: whose joints the layer moves with.
            params: T frames with one shape.

        Raises:
            ValueError: the parameters hold a shape a frame.
        """
        if params.betas.ndim != 1:
            raise ValueError(
                f"betas: shape {params.betas.shape}; clothes need one shape (10,) for all frames"
            )
        shaped = self.rest(params.betas)
        rest = np.broadcast_to(
            body.rest_joints(params.betas, params.expression), (params.num_frames, NUM_JOINTS, 3)
        )
        full = params.full_pose()
        out = np.empty((params.num_frames, self.num_vertices, 3), dtype=np.float32)
        for start in range(0, params.num_frames, BLOCK):
            part = slice(start, min(start + BLOCK, params.num_frames))
            local = rotations(full[part])
            block, _ = skin_block(
                self.skin, shaped.reshape(-1, 1), params.expression[part], local, rest[part]
            )
            block += params.transl[part].T.astype(np.float32)
            out[part] = block.transpose(2, 0, 1)
        return out


@lru_cache(maxsize=64)
def item_layer(wardrobe: Catalogue, name: str) -> Layer:
    """One item as a layer."""
    geometry, support = wardrobe.geometry(name), wardrobe.support
    mix = _mix(geometry.refs, geometry.weights, len(support.v_template))
    template = mix @ support.v_template + geometry.offsets
    if wardrobe.items[name].slot in HELD_STIFFLY:
        carry = _nearest(template, support.v_template)
    else:
        convex = np.clip(geometry.weights, 0, None)
        carry = _mix(geometry.refs, convex / convex.sum(axis=1, keepdims=True), len(support.v_template))
    weights = carry @ support.weights
    carry_axes = scipy.sparse.kron(carry, scipy.sparse.eye_array(3), format="csr")
    shape = mix @ support.shapedirs.reshape(len(support.v_template), -1)
    expression = mix @ support.expression_dirs.reshape(len(support.v_template), -1)
    return Layer(
        template=template.astype(np.float32),
        shape_dirs=shape.reshape(-1, NUM_BETAS).astype(np.float32),
        skin=Skin.build(
            expression.reshape(-1, 3, NUM_EXPRESSION).astype(np.float32),
            (carry_axes @ support.posedirs).astype(np.float32),
            (weights / weights.sum(axis=1, keepdims=True)).astype(np.float32),
        ),
    )


def join(layers: Sequence[Layer]) -> Layer:
    """Several layers as one, vertices in order: one product poses all."""
    return Layer(
        np.concatenate([layer.template for layer in layers]),
        np.concatenate([layer.shape_dirs for layer in layers]),
        Skin.joined([layer.skin for layer in layers]),
    )


def _mix(refs: npt.NDArray[np.int32], weights: npt.NDArray[np.float64], count: int) -> scipy.sparse.csr_array:
    rows = np.repeat(np.arange(len(refs)), 3)
    return scipy.sparse.csr_array((weights.ravel(), (rows, refs.ravel())), shape=(len(refs), count))


def _nearest(points: npt.NDArray[np.float64], support: Float32Array) -> scipy.sparse.csr_array:
    """(n, S) weights over the nearest support vertices, falling with the square of the distance."""
    distance, index = scipy.spatial.cKDTree(support).query(points, k=CARRIERS)
    share = 1 / np.maximum(distance, 1e-4) ** 2
    share /= share.sum(axis=1, keepdims=True)
    rows = np.repeat(np.arange(len(points)), CARRIERS)
    return scipy.sparse.csr_array((share.ravel(), (rows, index.ravel())), shape=(len(points), len(support)))
