"""Opening a motion file: npz, npy or pickle, told apart by its first bytes, read within bounds.

A :class:`Record` is a file seen as named values. Arrays of an npz and the array of an npy are read one by
one when asked for; their shapes come from the headers. Nothing in a file is executed, and no claim of a
header is believed before it is compared with the bytes that are there.
"""

from __future__ import annotations

import io
import math
import zipfile
import zlib
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import IO, Any, cast

import numpy as np
from numpy.lib import format as npy_format

from whacamole.errors import MotionError
from whacamole.motion import safe_pickle
from whacamole.motion.data import FloatArray

MAX_BYTES = 1 << 30
"""Largest file to unpickle and largest array to read: a day of motion is less."""

ARRAY_KEY = "array"
"""The name under which the one array of an npy file is found."""

_Header = tuple[tuple[int, ...], bool, "np.dtype[Any]"]


class Record:
    """Named values of one motion file (or of one person in it).

    ``keys`` are the names; ``where`` stands in front of every complaint. Shapes are cheap; values are read
    when asked for.
    """

    def __init__(self, where: str, keys: Mapping[str, Callable[[], Any]], shapes: Mapping[str, Any]) -> None:
        self.where = where
        self._values = keys
        self._shapes = shapes

    @property
    def keys(self) -> frozenset[str]:
        """Names of the values."""
        return frozenset(self._values)

    def fail(self, what: str) -> MotionError:
        """The error that says ``what`` is wrong with this file, to be raised by the caller."""
        return MotionError(f"{self.where}: {what}")

    def shape(self, key: str) -> tuple[int, ...] | None:
        """Shape of the array ``key``; None where there is none."""
        shape = self._shapes.get(key)
        return shape() if callable(shape) else shape

    def value(self, key: str) -> Any:
        """The value ``key``; :class:`MotionError` where it is missing or cannot be read."""
        if key not in self._values:
            raise self.fail(f"'{key}' is missing; give a file that still holds it")
        return self._values[key]()

    def child(self, key: str) -> Record:
        """The dictionary ``key`` as a record."""
        value = self.value(key)
        if not isinstance(value, dict):
            raise self.fail(f"'{key}' is no dictionary; export the motion again")
        return _from_dict(f"{self.where} ({key})", value)

    def array(self, key: str, *columns: int) -> FloatArray:
        """The array ``key`` as finite float64, with as many entries per frame as ``columns`` multiply to.

        Returns ``(T, *columns)`` whatever the file's own grouping, or any shape where no columns are named.
        """
        try:
            given = np.asarray(self.value(key))
        except (TypeError, ValueError, OverflowError) as error:  # a ragged list
            raise self.fail(f"'{key}' holds no plain numbers; export the motion again") from error
        if given.dtype.kind not in "biuf":
            raise self.fail(f"'{key}' holds {given.dtype}, no plain numbers; export the motion again")
        array = given.astype(np.float64)
        if columns:
            width = math.prod(columns)
            if array.ndim < 2 or math.prod(array.shape[1:]) != width:
                raise self.fail(
                    f"'{key}' has shape {array.shape}, expected (frames, {width}); export the motion again"
                )
            array = array.reshape(-1, *columns)
        if not np.isfinite(array).all():
            bad = int(np.argwhere(~np.isfinite(array))[0][0]) if array.ndim else 0
            raise self.fail(f"'{key}' is not finite (first at entry {bad}); repair or cut the motion")
        return array

    def number(self, key: str) -> float:
        """The value ``key`` as one number."""
        array = self.array(key)
        if array.size != 1:
            raise self.fail(f"'{key}' has shape {array.shape}, expected one number; export the motion again")
        return float(array.reshape(()))

    def text(self, key: str, default: str = "") -> str:
        """The value ``key`` as text: a string, bytes, or an array of one; else ``default``."""
        if key not in self._values:
            return default
        value = self.value(key)
        if isinstance(value, np.ndarray):
            value = value.reshape(-1)[0] if value.size else default
        return value.decode("latin1") if isinstance(value, bytes) else str(value)


def open_record(path: Path) -> Record:
    """Opens ``path`` and reads its headers. Raises :class:`MotionError` for what is no npz, npy or pickle."""
    try:
        if not path.is_file():
            raise MotionError(f"{path}: not a regular file; give a motion file")
        with path.open("rb") as stream:
            magic = stream.read(6)
            size = path.stat().st_size
            if not magic:
                raise MotionError(f"{path}: the file is empty; copy or download it again")
            if magic.startswith(b"PK\x03\x04"):
                return _open_npz(path)
            if magic == npy_format.MAGIC_PREFIX:
                stream.seek(0)
                return _open_npy(path, stream, size)
            if magic[:1] == b"\x80" or path.suffix.lower() in (".pkl", ".pickle"):
                stream.seek(0)
                return _from_pickle(path, _bounded_read(path, stream, size))
    except OSError as error:
        raise MotionError(
            f"{path}: cannot be read ({error.strerror or error}); check the file and its rights"
        ) from error
    raise MotionError(
        f"{path}: neither npz, npy nor pickle (starts with {magic!r}); copy or download it again"
    )


def _bounded_read(path: Path, stream: IO[bytes], size: int) -> bytes:
    if size > MAX_BYTES:
        raise MotionError(f"{path}: {size / 1e9:.1f} GB to unpickle, at most 1 GB; split the motion")
    return stream.read()


def _from_pickle(path: Path, data: bytes) -> Record:
    try:
        value = safe_pickle.loads(data)
    except safe_pickle.UnsafePickleError as error:
        raise MotionError(f"{path}: the pickle is refused: {error}; save plain arrays instead") from error
    if isinstance(value, np.ndarray):
        return _from_dict(str(path), {ARRAY_KEY: value})
    if not isinstance(value, dict):
        raise MotionError(
            f"{path}: holds a {type(value).__name__}, expected a dictionary; export the motion again"
        )
    return _from_dict(str(path), value)


def _from_dict(where: str, values: dict[Any, Any]) -> Record:
    named = {str(key): value for key, value in values.items()}
    return Record(
        where,
        {key: partial(named.__getitem__, key) for key in named},
        {key: np.shape(value) for key, value in named.items() if isinstance(value, np.ndarray | float | int)},
    )


def _open_npy(path: Path, stream: IO[bytes], size: int) -> Record:
    shape, fortran, dtype = _header(str(path), stream)
    if dtype.hasobject:
        return _from_pickle(path, _bounded_read(path, stream, size))
    offset = stream.tell()

    def read() -> Any:
        with path.open("rb") as again:
            again.seek(offset)
            return _array(str(path), again, (shape, fortran, dtype), size - offset)

    return Record(str(path), {ARRAY_KEY: read}, {ARRAY_KEY: shape})


def _open_npz(path: Path) -> Record:
    try:
        with zipfile.ZipFile(path) as archive:
            members = {
                info.filename.removesuffix(".npy"): info for info in archive.infolist() if not info.is_dir()
            }
    except (zipfile.BadZipFile, NotImplementedError, ValueError) as error:
        raise MotionError(f"{path}: damaged npz ({error}); copy or download it again") from error
    values = {key: partial(_member, path, key, info, shape_only=False) for key, info in members.items()}
    shapes = {key: partial(_member, path, key, info, shape_only=True) for key, info in members.items()}
    return Record(str(path), values, shapes)


def _member(path: Path, key: str, info: zipfile.ZipInfo, *, shape_only: bool) -> Any:
    where = f"{path}: '{key}'"
    try:
        with zipfile.ZipFile(path) as archive, archive.open(info) as stream:
            if stream.read(6) != npy_format.MAGIC_PREFIX:
                raise MotionError(f"{where} is no npy array; save the file with numpy.savez")
            head = io.BytesIO(npy_format.MAGIC_PREFIX + stream.read(12_000))
            header = _header(where, head)
            if shape_only:
                return header[0]
            start, length = head.tell(), len(head.getvalue())
            rest = info.file_size - start
            if rest > MAX_BYTES:
                raise MotionError(f"{where} claims {rest / 1e9:.1f} GB, at most 1 GB; split the motion")
            body = io.BytesIO(head.getvalue()[start:length] + stream.read(max(0, info.file_size - length)))
            if header[2].hasobject:
                return safe_pickle.loads(body.getvalue())
            return _array(where, body, header, len(body.getvalue()))
    except safe_pickle.UnsafePickleError as error:
        raise MotionError(f"{where}: the pickle is refused: {error}; save plain arrays instead") from error
    except (zipfile.BadZipFile, NotImplementedError, RuntimeError, EOFError, zlib.error) as error:
        raise MotionError(f"{where} is damaged ({error}); copy or download the file again") from error


def _header(where: str, stream: IO[bytes]) -> _Header:
    """Shape, order and dtype of an npy stream, which is left at the first byte of the data."""
    try:
        version = npy_format.read_magic(stream)  # type: ignore[no-untyped-call]
        if version == (1, 0):
            header = npy_format.read_array_header_1_0(stream)  # type: ignore[no-untyped-call]
        elif version == (2, 0):
            header = npy_format.read_array_header_2_0(stream)  # type: ignore[no-untyped-call]
        else:
            raise ValueError(f"npy version {version}")
    except (ValueError, SyntaxError, TypeError, RecursionError, MemoryError) as error:
        raise MotionError(f"{where} has a damaged npy header; copy or download the file again") from error
    return cast(_Header, header)


def _array(where: str, stream: IO[bytes], header: _Header, available: int) -> Any:
    shape, fortran, dtype = header
    need = math.prod(shape) * dtype.itemsize
    if any(n < 0 for n in shape) or need > MAX_BYTES:
        raise MotionError(
            f"{where} claims shape {shape} ({need / 1e9:.3g} GB), at most 1 GB; split the motion"
        )
    if need > available:
        raise MotionError(
            f"{where} is cut off: {available} of {need} bytes are there; copy or download it again"
        )
    data = stream.read(need)
    return np.ndarray(shape, dtype, data, order="F" if fortran else "C")
