"""The SMPL-X model file: what its keys hold, read from and written to ``.npz`` without unpickling."""

import io
import os
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import numpy.typing as npt
import scipy.sparse

from whacamole.body.joints import NUM_BETAS, NUM_EXPRESSION, NUM_JOINTS, PARENTS
from whacamole.errors import BodyModelError

Array = npt.NDArray[Any]
Float32Array = npt.NDArray[np.float32]
Int32Array = npt.NDArray[np.int32]

NUM_POSE_FEATURES = 9 * (NUM_JOINTS - 1)
ROOT_PARENT = 2**32 - 1  # what the official files write for "no parent"
WIDE_SHAPEDIRS = 400  # 300 shape, then 100 expression directions; narrower files hold 10 and 10
_FIRST_WIDE_EXPRESSION = 300
_EARLIEST = (1980, 1, 1, 0, 0, 0)  # the zip format's zero: the bytes must not depend on the clock
_WHERE = "take SMPLX_NEUTRAL.npz from https://smpl-x.is.tue.mpg.de, or leave --body-model out"

_READ_FAULTS = (ValueError, OSError, EOFError, RuntimeError, MemoryError, zipfile.BadZipFile, zlib.error)
_REQUIRED = ("v_template", "f", "shapedirs", "posedirs", "J_regressor", "weights", "kintree_table")
_OPTIONAL = ("vt", "ft", "quads", "quads_t")


@dataclass(frozen=True, eq=False)
class BodyArrays:
    """The arrays of one SMPL-X model.

    Attributes:
        v_template: (V, 3) float32 [m], y up, facing +z, T-pose.
        faces: (F, 3) int32.
        shapedirs: (V, 3, 10) float32 [m] a unit of beta.
        expression_dirs: (V, 3, 10) float32 [m] a unit of expression.
        posedirs: sparse (3V, 486) float32 [m] a unit of R − I; row 3v + axis, column 9(j − 1) + 3·row + col.
        joint_regressor: sparse (55, V) float32.
        weights: (V, 55) float32, rows sum to 1.
        uv: (VT, 2) float32; a file without texture coordinates has the one point (0, 0).
        uv_faces: (F, 3) int32 into ``uv``.
        quads: (Q, 4) int32, the same surface in quads, where the file has them.
        uv_quads: (Q, 4) int32 into ``uv``, where the file has them.
        extras: everything else in the file that is a plain array (landmarks, hand means …).
    """

    v_template: Float32Array
    faces: Int32Array
    shapedirs: Float32Array
    expression_dirs: Float32Array
    posedirs: Any
    joint_regressor: Any
    weights: Float32Array
    uv: Float32Array
    uv_faces: Int32Array
    quads: Int32Array | None = None
    uv_quads: Int32Array | None = None
    extras: Mapping[str, Array] = field(default_factory=dict)

    def __post_init__(self) -> None:
        # One model is shared by all who ask for it: a stray write must fail, not bend everybody's bodies.
        for member in fields(self):
            value = getattr(self, member.name)
            if isinstance(value, np.ndarray):
                value.setflags(write=False)


class NpzReader(Mapping[str, Array]):
    """The arrays of an ``.npz``, each read when asked for; a fault of the file is a ``BodyModelError``.

    Args:
        stream: the opened file, seekable.
        label: the file's name for messages.
    """

    def __init__(self, stream: BinaryIO, label: str) -> None:
        self._label = label
        _refuse_other_kinds(stream, label)
        try:
            self._zip = zipfile.ZipFile(stream)
        except (zipfile.BadZipFile, OSError) as error:
            raise BodyModelError(f"{label}: a damaged .npz ({error}); fetch it again") from error
        self._keys = tuple(n.removesuffix(".npy") for n in self._zip.namelist() if n.endswith(".npy"))
        if not self._keys:
            raise BodyModelError(f"{label}: a zip without arrays; unpack it and name the .npz inside")

    def __getitem__(self, key: str) -> Array:
        if key not in self._keys:
            raise KeyError(key)
        try:
            array: Array = np.load(io.BytesIO(self._zip.read(f"{key}.npy")), allow_pickle=False)
        except _READ_FAULTS as error:
            if "pickle" in str(error):
                raise BodyModelError(f"{self._label}: key '{key}' holds Python objects; {_WHERE}") from error
            raise BodyModelError(
                f"{self._label}: key '{key}' cannot be read ({error}); fetch the file again"
            ) from error
        return array

    def __iter__(self) -> Iterator[str]:
        return iter(self._keys)

    def __len__(self) -> int:
        return len(self._keys)


def _refuse_other_kinds(stream: BinaryIO, label: str) -> None:
    """Tell a pickle and other files apart from an ``.npz`` by their first bytes."""
    magic = stream.read(8)
    stream.seek(0)
    if magic.startswith(b"PK"):
        return
    if magic[:1] == b"\x80" or label.endswith(".pkl"):
        raise BodyModelError(f"{label}: a pickle, which could run code when opened; {_WHERE}")
    raise BodyModelError(f"{label}: not an .npz file; {_WHERE}")


def read_full(source: Mapping[str, Array], label: str) -> BodyArrays:
    """Read a full-schema model as the ``smplx`` package does: expression at 300 if 400 wide, else at 10.

    Raises:
        BodyModelError: a key is missing, a shape is not SMPL-X's, or a value is out of range.
    """
    absent = [key for key in _REQUIRED if key not in source]
    if absent:
        raise BodyModelError(f"{label}: no key {', '.join(map(repr, absent))}, so no SMPL-X model; {_WHERE}")
    v_template = _shaped(source, "v_template", (None, 3), label)
    V = len(v_template)
    dirs = _shaped(source, "shapedirs", (V, 3, None), label)
    if dirs.shape[2] < NUM_BETAS + NUM_EXPRESSION:
        raise BodyModelError(
            f"{label}: 'shapedirs' has {dirs.shape[2]} directions, fewer than 10 + 10 expression; {_WHERE}"
        )
    first = _FIRST_WIDE_EXPRESSION if dirs.shape[2] >= WIDE_SHAPEDIRS else NUM_BETAS
    weights = _shaped(source, "weights", (V, NUM_JOINTS), label)
    posedirs = _shaped(source, "posedirs", (V, 3, NUM_POSE_FEATURES), label)
    regressor = _shaped(source, "J_regressor", (NUM_JOINTS, V), label)
    _check_tree(source["kintree_table"], label)
    faces = _indices(source, "f", 3, V, label)
    uv, uv_faces = _read_uv(source, len(faces), label)
    quads = _indices(source, "quads", 4, V, label) if "quads" in source else None
    uv_quads = _indices(source, "quads_t", 4, len(uv), label) if "quads_t" in source else None
    return BodyArrays(
        v_template=v_template,
        faces=faces,
        shapedirs=np.ascontiguousarray(dirs[:, :, :NUM_BETAS]),
        expression_dirs=np.ascontiguousarray(dirs[:, :, first : first + NUM_EXPRESSION]),
        posedirs=scipy.sparse.csr_array(posedirs.reshape(3 * V, NUM_POSE_FEATURES)),
        joint_regressor=scipy.sparse.csr_array(regressor),
        weights=weights,
        uv=uv,
        uv_faces=uv_faces,
        quads=quads,
        uv_quads=uv_quads,
        extras=_extras(source),
    )


def full_arrays(body: BodyArrays) -> dict[str, Array]:
    """The full-schema keys of a model, as the ``smplx`` package and Blender add-ons read them."""
    V = len(body.v_template)
    parents = np.array([ROOT_PARENT, *PARENTS[1:]], dtype=np.int64)
    arrays: dict[str, Array] = {
        "v_template": body.v_template,
        "f": body.faces.astype(np.uint32),
        "shapedirs": np.concatenate([body.shapedirs, body.expression_dirs], axis=2),
        "posedirs": body.posedirs.toarray().reshape(V, 3, NUM_POSE_FEATURES),
        "J_regressor": body.joint_regressor.toarray(),
        "weights": body.weights,
        "kintree_table": np.stack([parents, np.arange(NUM_JOINTS)]),
        "vt": body.uv,
        "ft": body.uv_faces.astype(np.uint32),
    }
    for key, quads in (("quads", body.quads), ("quads_t", body.uv_quads)):
        if quads is not None:
            arrays[key] = quads.astype(np.uint32)
    return arrays | dict(body.extras)


def write_npz(path: Path, arrays: Mapping[str, Array]) -> None:
    """Write a compressed ``.npz``: whole or not at all, the same bytes for the same arrays and zlib."""
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with zipfile.ZipFile(part, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
            for key, array in arrays.items():
                buffer = io.BytesIO()
                np.save(buffer, np.asarray(array, order="C"), allow_pickle=False)
                entry = zipfile.ZipInfo(f"{key}.npy", _EARLIEST)
                entry.compress_type = zipfile.ZIP_DEFLATED
                archive.writestr(entry, buffer.getvalue(), compresslevel=9)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)


def _shaped(
    source: Mapping[str, Array], key: str, wanted: tuple[int | None, ...], label: str
) -> Float32Array:
    """A key's array as finite float32 of the wanted shape, ``None`` for any length."""
    raw = source[key]
    fits = raw.ndim == len(wanted) and all(w in (None, n) for n, w in zip(raw.shape, wanted, strict=True))
    if not fits or raw.dtype.kind not in "fiu" or 0 in raw.shape:
        shape = " × ".join("any" if w is None else str(w) for w in wanted)
        raise BodyModelError(f"{label}: '{key}' is {raw.shape} {raw.dtype}, SMPL-X has {shape}; {_WHERE}")
    array = np.ascontiguousarray(raw, dtype=np.float32)
    if not np.isfinite(array).all():
        raise BodyModelError(f"{label}: '{key}' holds values that are not finite; fetch the file again")
    return array


def _indices(source: Mapping[str, Array], key: str, corners: int, limit: int, label: str) -> Int32Array:
    """A key's (N, corners) array of indices below ``limit``."""
    raw = source[key]
    if raw.ndim != 2 or raw.shape[1] != corners or raw.dtype.kind not in "iu":
        raise BodyModelError(
            f"{label}: '{key}' is {raw.shape} {raw.dtype}, expected whole numbers (N, {corners}); {_WHERE}"
        )
    if raw.size and (int(raw.min()) < 0 or int(raw.max()) >= limit):
        raise BodyModelError(f"{label}: '{key}' points outside 0 … {limit - 1}; fetch the file again")
    return np.ascontiguousarray(raw, dtype=np.int32)


def _read_uv(source: Mapping[str, Array], num_faces: int, label: str) -> tuple[Float32Array, Int32Array]:
    """Texture coordinates; a file without gets one point for all corners, which shows a flat colour."""
    if "vt" not in source or "ft" not in source:
        return np.zeros((1, 2), dtype=np.float32), np.zeros((num_faces, 3), dtype=np.int32)
    uv = _shaped(source, "vt", (None, 2), label)
    uv_faces = _indices(source, "ft", 3, len(uv), label)
    if len(uv_faces) != num_faces:
        raise BodyModelError(
            f"{label}: 'ft' has {len(uv_faces)} faces but 'f' has {num_faces}; fetch the file again"
        )
    return uv, uv_faces


def _check_tree(table: Array, label: str) -> None:
    """Joint labels go by position, so a rig with another tree would get wrong names without a word."""
    if table.shape != (2, NUM_JOINTS) or tuple(int(p) for p in table[0, 1:]) != PARENTS[1:]:
        raise BodyModelError(f"{label}: 'kintree_table' is not the tree of SMPL-X's 55 joints; {_WHERE}")


def _extras(source: Mapping[str, Array]) -> dict[str, Array]:
    """The other plain arrays. Official files also hold pickled dictionaries: those are left alone, unread."""
    extras = {}
    for key in source:
        if key not in _REQUIRED + _OPTIONAL:
            try:
                extras[key] = source[key]
            except BodyModelError:
                continue
    return extras
