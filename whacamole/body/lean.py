"""The lean form of a body model: what ships inside the package, a fraction of the full file.

Shape directions in half precision, pose directions as int16 blocks (vertex × joint), weights as uint16
shares, indices in the fewest bytes. Unpacking is exact: a lean file defines its float32 arrays to the bit,
and packing them again gives the same file.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse

from whacamole.body.joints import NUM_BETAS, NUM_JOINTS
from whacamole.body.schema import NUM_POSE_FEATURES, BodyArrays
from whacamole.errors import BodyModelError

Array = npt.NDArray[Any]

LEAN_KEY = "lean_body_version"
LEAN_VERSION = 1
_SHARES = 65535  # a vertex's weights are whole shares of this, and add up to it
_BLOCK = (3, 9)  # one vertex by one joint in posedirs
_EXTRA = "extra."


def pack(body: BodyArrays) -> dict[str, Array]:
    """The lean arrays of a model: shape directions to 11 bits, pose directions to 2⁻¹⁵ of the largest."""
    V = len(body.v_template)
    dirs = np.concatenate([body.shapedirs, body.expression_dirs], axis=2)
    weights = _to_shares(body.weights)
    exponent, pose = _to_blocks(body.posedirs)
    regressor = body.joint_regressor
    lean: dict[str, Array] = {
        LEAN_KEY: np.array(LEAN_VERSION, dtype=np.uint8),
        "v_template": body.v_template,
        "dirs": dirs.transpose(2, 1, 0).astype(np.float16),
        "pose_exponent": np.array(exponent, dtype=np.int8),
        "pose_counts": np.diff(pose.indptr).astype(np.uint8),
        "pose_joints": pose.indices.astype(np.uint8),
        "pose_values": pose.data.transpose(1, 2, 0),
        "regressor_counts": _narrow(np.diff(regressor.indptr)),
        "regressor_vertices": _narrow(regressor.indices),
        "regressor_values": regressor.data,
        "weight_counts": np.diff(weights.indptr).astype(np.uint8),
        "weight_joints": weights.indices.astype(np.uint8),
        "weight_shares": weights.data.astype(np.uint16),
        "faces": _narrow(body.faces.T, V),
        "uv": body.uv.T,
        "uv_faces": _narrow(body.uv_faces.T, len(body.uv)),
    }
    if body.quads is not None:
        lean["quads"] = _narrow(body.quads.T, V)
    if body.uv_quads is not None:
        lean["uv_quads"] = _narrow(body.uv_quads.T, len(body.uv))
    return lean | {f"{_EXTRA}{key}": array for key, array in body.extras.items()}


def unpack(lean: Mapping[str, Array], label: str) -> BodyArrays:
    """The model a lean file stands for.

    Raises:
        BodyModelError: the file was packed by another version of the format.
    """
    if int(lean[LEAN_KEY]) != LEAN_VERSION:
        raise BodyModelError(
            f"{label}: lean body version {int(lean[LEAN_KEY])}, expected {LEAN_VERSION}; pack it again"
        )
    v_template = lean["v_template"]
    V = len(v_template)
    dirs = np.ascontiguousarray(lean["dirs"].transpose(2, 1, 0), dtype=np.float32)
    values = np.ldexp(lean["pose_values"].transpose(2, 0, 1).astype(np.float32), int(lean["pose_exponent"]))
    pose = scipy.sparse.bsr_array(
        (values, lean["pose_joints"].astype(np.int32), _pointers(lean["pose_counts"])),
        shape=(3 * V, NUM_POSE_FEATURES),
    ).tocsr()
    pose.eliminate_zeros()
    shares = lean["weight_shares"].astype(np.float32) / np.float32(_SHARES)
    return BodyArrays(
        v_template=v_template,
        faces=_wide(lean["faces"]),
        shapedirs=np.ascontiguousarray(dirs[:, :, :NUM_BETAS]),
        expression_dirs=np.ascontiguousarray(dirs[:, :, NUM_BETAS:]),
        posedirs=pose,
        joint_regressor=_rows(
            lean["regressor_values"], lean["regressor_vertices"], lean["regressor_counts"], V
        ),
        weights=_rows(shares, lean["weight_joints"], lean["weight_counts"], NUM_JOINTS).toarray(),
        uv=np.ascontiguousarray(lean["uv"].T),
        uv_faces=_wide(lean["uv_faces"]),
        quads=_wide(lean["quads"]) if "quads" in lean else None,
        uv_quads=_wide(lean["uv_quads"]) if "uv_quads" in lean else None,
        extras={key.removeprefix(_EXTRA): lean[key] for key in lean if key.startswith(_EXTRA)},
    )


def _to_shares(weights: Array) -> Any:
    """Weights (V, 55) as whole shares with the same sum for every vertex: floor, then the largest rests."""
    scaled = weights / weights.sum(axis=1, keepdims=True, dtype=np.float64) * _SHARES
    shares = np.floor(scaled).astype(np.int64)
    missing = _SHARES - shares.sum(axis=1)
    rank = np.argsort(np.argsort(shares - scaled, axis=1, kind="stable"), axis=1, kind="stable")
    return scipy.sparse.csr_array(shares + (rank < missing[:, None]))


def _to_blocks(posedirs: Any) -> tuple[int, Any]:
    """Pose directions as int16 times a power of two (unpacking is exact), in vertex × joint blocks."""
    largest = float(np.abs(posedirs.data).max(initial=0.0))
    exponent = int(np.ceil(np.log2(largest / 32767))) if largest else 0
    whole = posedirs.copy()
    whole.data = np.rint(np.ldexp(posedirs.data.astype(np.float64), -exponent)).astype(np.int16)
    whole.eliminate_zeros()
    blocks = whole.tobsr(_BLOCK)
    blocks.sort_indices()
    return exponent, blocks


def _narrow(indices: Array, limit: int | None = None) -> Array:
    """Indices in the smallest unsigned type that holds them."""
    largest = limit - 1 if limit else int(indices.max(initial=0))
    return indices.astype(np.min_scalar_type(max(largest, 0)))


def _wide(indices: Array) -> npt.NDArray[np.int32]:
    return np.ascontiguousarray(indices.T, dtype=np.int32)


def _pointers(counts: Array) -> npt.NDArray[np.int32]:
    return np.concatenate([[0], np.cumsum(counts, dtype=np.int32)], dtype=np.int32)


def _rows(values: Array, columns: Array, counts: Array, width: int) -> Any:
    """A sparse matrix from its stored entries, row by row."""
    pointers = _pointers(counts)
    return scipy.sparse.csr_array((values, columns.astype(np.int32), pointers), shape=(len(counts), width))
