"""Unpickling that cannot execute anything.

Some motion formats are pickles. The standard unpickler imports and calls whatever the file names; this one
knows a dozen names, all answered by inert stand-ins of this module, and refuses every other. NumPy's own
classes are never called from the stream (``ndarray((10**12,))`` is a valid pickle and takes all memory): an
array becomes a read-only view of the bytes that the file really holds.
"""

from __future__ import annotations

import io
import math
import pickle
import pickletools
from collections.abc import Callable
from typing import Any, cast

import numpy as np

MAX_OPCODES = 20_000_000
_NATIVE_KINDS = "biufcSU"


class UnsafePickleError(ValueError):
    """The pickle asks for more than plain data, or is damaged. The message says for what."""


class _DType:
    """Stands in for a pickled ``numpy.dtype``: its spelling and its byte order."""

    def __init__(self, spec: object, _align: object = False, _copy: object = True) -> None:
        if not isinstance(spec, str) or len(spec) > 16:
            raise UnsafePickleError("it holds an array of structured type")
        self.spec = spec

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        order = state[1]
        if order in ("<", ">"):
            self.spec = order + self.spec.lstrip("<>=|")

    def native(self) -> np.dtype[Any]:
        """The dtype; only plain numbers and strings."""
        try:
            dtype = np.dtype(self.spec)
        except TypeError as error:
            raise UnsafePickleError(f"it holds an array of unknown type {self.spec!r}") from error
        if dtype.kind not in _NATIVE_KINDS:
            raise UnsafePickleError(f"it holds an array of type {self.spec!r}")
        return dtype

    @property
    def is_object(self) -> bool:
        """Whether the elements are pickled objects."""
        return self.spec.lstrip("<>=|").startswith("O")


class _Array:
    """Stands in for a pickled ``numpy.ndarray`` until its bytes are seen."""

    def __init__(self) -> None:
        self.value: Any = None

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        _, shape, dtype, fortran, data = state
        self.value = _build(data, dtype, shape, "F" if fortran else "C")


def _build(data: object, dtype: _DType, shape: tuple[int, ...], order: str) -> Any:
    """The array of ``shape`` over ``data``; an object array of one element becomes that element."""
    if not (isinstance(shape, tuple) and all(isinstance(n, int) and n >= 0 for n in shape)):
        raise UnsafePickleError("it holds an array of impossible shape")
    if dtype.is_object:
        if not isinstance(data, list) or len(data) != math.prod(shape):
            raise UnsafePickleError("it holds a damaged object array")
        return data[0] if len(data) == 1 else data
    if isinstance(data, str):  # bytes written by Python 2
        data = data.encode("latin1")
    if not isinstance(data, bytes | bytearray):
        raise UnsafePickleError("it holds an array without bytes")
    native = dtype.native()
    if len(data) != math.prod(shape) * native.itemsize:
        raise UnsafePickleError(f"it holds an array of shape {shape} with {len(data)} bytes")
    return np.ndarray(shape, native, bytes(data), order="F" if order == "F" else "C")


def _reconstruct(_kind: object, _shape: object, _code: object) -> _Array:
    return _Array()


def _from_buffer(data: object, dtype: _DType, shape: tuple[int, ...], order: str) -> _Array:
    array = _Array()
    array.value = _build(data, dtype, shape, order)
    return array


def _scalar(dtype: _DType, data: object) -> _Array:
    array = _Array()
    array.value = _build(data, dtype, (), "C")[()]
    return array


def _encode(text: object, encoding: object) -> bytes:
    if not isinstance(text, str) or encoding not in ("latin1", "latin-1"):
        raise UnsafePickleError("it holds text in an unexpected encoding")
    return text.encode("latin1")


def _empty_bytes() -> bytes:
    return b""


def _no_type(*_: object) -> None:
    raise UnsafePickleError("it calls numpy.ndarray directly")


_NAMES: dict[tuple[str, str], Callable[..., Any]] = {
    ("numpy", "ndarray"): _no_type,
    ("numpy", "dtype"): _DType,
    ("_codecs", "encode"): _encode,
    # How the old protocols write bytes without any content.
    ("__builtin__", "bytes"): _empty_bytes,
    ("builtins", "bytes"): _empty_bytes,
    ("collections", "OrderedDict"): dict,
    **{
        (f"numpy.{core}.{module}", name): stand_in
        for core in ("core", "_core")
        for module, name, stand_in in (
            ("multiarray", "_reconstruct", _reconstruct),
            ("multiarray", "scalar", _scalar),
            ("numeric", "_frombuffer", _from_buffer),
        )
    },
}


class _Unpickler(pickle.Unpickler):
    def find_class(self, module: str, name: str, /) -> Any:
        """The stand-in for ``module.name``; refuses all but the known names."""
        try:
            return _NAMES[module, name]
        except KeyError:
            raise UnsafePickleError(f"it asks for {module}.{name}, which is not plain data") from None


def _scan(data: bytes) -> None:
    """Walks the opcodes without executing them: refuses memory bombs hidden in memo indices and lengths."""
    for count, (opcode, argument, _) in enumerate(pickletools.genops(data)):
        if count > MAX_OPCODES:
            raise UnsafePickleError(f"it has more than {MAX_OPCODES} steps")
        if opcode.name in ("PUT", "BINPUT", "LONG_BINPUT") and not 0 <= cast(int, argument) <= len(data):
            raise UnsafePickleError("it has an impossible memo index")


def _plain(value: object, seen: dict[int, tuple[object, object]]) -> object:
    """Replaces the stand-ins by their arrays, in place, each container once.

    ``seen`` holds the containers themselves, not only their ids, so that no id is given out twice.
    """
    if isinstance(value, _Array):
        return _plain(value.value, seen)
    if isinstance(value, _DType):
        return value.spec
    if id(value) in seen:
        return seen[id(value)][1]
    if isinstance(value, dict):
        seen[id(value)] = (value, value)
        for key in list(value):
            value[key] = _plain(value[key], seen)
    elif isinstance(value, list):
        seen[id(value)] = (value, value)
        value[:] = [_plain(item, seen) for item in value]
    elif isinstance(value, tuple):
        result = tuple(_plain(item, seen) for item in value)
        seen[id(value)] = (value, result)
        return result
    return value


def loads(data: bytes) -> object:
    """The plain data (dicts, lists, strings, numbers, NumPy arrays) of a pickle, executing nothing.

    Trailing bytes are ignored, as by the standard unpickler. Raises :class:`UnsafePickleError` for a pickle
    that names anything else, is damaged, or claims more memory than it holds.
    """
    try:
        _scan(data)
        value = _Unpickler(io.BytesIO(data), encoding="latin1").load()
        return _plain(value, {})
    except UnsafePickleError:
        raise
    except Exception as error:  # a damaged stream may raise nearly anything from the C unpickler
        raise UnsafePickleError(f"it is damaged ({type(error).__name__})") from error
