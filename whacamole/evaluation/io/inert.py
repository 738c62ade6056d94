"""Reading joblib, torch and body-model pickles without executing anything.

``whacamole.motion.safe_pickle`` reads pickles of plain arrays. The outputs of other methods wrap their arrays
in classes of joblib, torch, chumpy and SciPy. Here those names are answered by stand-ins of this module that
only keep what they are given; every other name is refused, and no library named in a file is imported.
"""

import io
import math
import pickle
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from whacamole.errors import EvaluationError

_PLAIN_KINDS = "biufc"
_STORAGES = {
    "DoubleStorage": "f8", "FloatStorage": "f4", "HalfStorage": "f2", "LongStorage": "i8", "IntStorage": "i4",
    "ShortStorage": "i2", "CharStorage": "i1", "ByteStorage": "u1", "BoolStorage": "?",
}  # fmt: skip
_LEGACY_MAGIC = 0x1950A86A20F9469CFC6C


class _RefusedError(ValueError):
    """What the file asks for is not plain data."""


class _DType:
    """Stands in for ``numpy.dtype``."""

    def __init__(self, spec: object, *_: object) -> None:
        self.spec = str(spec)

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        if state[1] in ("<", ">"):
            self.spec = state[1] + self.spec.lstrip("<>=|")

    def plain(self) -> np.dtype[Any]:
        """The dtype, if it is one of plain numbers."""
        dtype = np.dtype(self.spec) if len(self.spec) < 8 else None
        if dtype is None or dtype.kind not in _PLAIN_KINDS:
            raise _RefusedError(f"it holds an array of type {self.spec!r}")
        return dtype


class _Box:
    """Stands in for an object that becomes something else once its state is known."""

    value: Any = None

    def __init__(self, *_: object) -> None:
        pass


class _NumpyArray(_Box):
    def __setstate__(self, state: tuple[Any, ...]) -> None:
        _, shape, dtype, fortran, data = state
        if isinstance(data, str):
            data = data.encode("latin1")
        if not isinstance(data, bytes | bytearray):
            raise _RefusedError("it holds an array of Python objects")
        self.value = _array(bytes(data), dtype.plain(), shape, "F" if fortran else "C")


class _JoblibArray(_Box):
    """joblib writes an array's bytes into the stream right behind this object."""

    state: Mapping[str, Any]

    def __setstate__(self, state: Mapping[str, Any]) -> None:
        self.state = state

    def read(self, stream: io.BytesIO) -> None:
        """Take the bytes that follow."""
        dtype, shape = self.state["dtype"].plain(), tuple(self.state["shape"])
        if self.state.get("numpy_array_alignment_bytes") is not None:
            stream.read(stream.read(1)[0])
        data = stream.read(math.prod(shape) * dtype.itemsize)
        self.value = _array(data, dtype, shape, str(self.state["order"]))


class _Chumpy(_Box):
    """chumpy's array: its numbers are under ``x``."""

    def __setstate__(self, state: Mapping[str, Any]) -> None:
        if not isinstance(state, dict) or "x" not in state:
            raise _RefusedError("it holds a chumpy expression, not a chumpy array")
        self.value = state["x"]


class _SparseMatrix(_Box):
    """SciPy's csc_matrix, as the dense array."""

    def __setstate__(self, state: Mapping[str, Any]) -> None:
        import scipy.sparse

        data, indices, indptr = (_unbox(state[key]) for key in ("data", "indices", "indptr"))
        shape = _unbox(state.get("_shape", state.get("shape")))
        self.value = scipy.sparse.csc_array((data, indices, indptr), shape=shape).toarray()


def _array(data: bytes, dtype: np.dtype[Any], shape: tuple[int, ...], order: str) -> Any:
    if len(data) != math.prod(shape) * dtype.itemsize:
        raise _RefusedError(f"it holds {len(data)} bytes for an array {shape}")
    return np.frombuffer(data, dtype).reshape(shape, order="F" if order == "F" else "C")


def _scalar(dtype: _DType, data: object) -> Any:
    return _array(data if isinstance(data, bytes) else str(data).encode("latin1"), dtype.plain(), (), "C")[()]


def _rebuild_tensor(
    storage: Any, offset: int, size: tuple[int, ...], stride: tuple[int, ...], *_: object
) -> Any:
    """A torch tensor as an array over its storage."""
    storage = _unbox(storage)
    reach = (
        offset + sum((n - 1) * step for n, step in zip(size, stride, strict=True)) if math.prod(size) else -1
    )
    if min((offset, *stride, *size), default=0) < 0 or reach >= len(storage):
        raise _RefusedError("it holds a tensor that reaches outside its storage")
    strides = tuple(step * storage.itemsize for step in stride)
    return np.lib.stride_tricks.as_strided(storage[offset:], size, strides).copy()


def _storage_from_bytes(data: bytes) -> Any:
    return _legacy_torch(data)


def _reconstructor(kind: Any, _base: object, _state: object) -> Any:
    """How pickle protocols 0 and 1 make an object."""
    return kind()


def _encode(text: str, _encoding: str) -> bytes:
    return text.encode("latin1")


_NAMES: dict[tuple[str, str], Callable[..., Any]] = {
    ("numpy", "ndarray"): _NumpyArray,
    ("numpy", "dtype"): _DType,
    ("_codecs", "encode"): _encode,
    ("collections", "OrderedDict"): dict,
    ("collections", "defaultdict"): lambda *_: {},
    ("builtins", "dict"): dict,
    ("builtins", "list"): list,
    ("__builtin__", "dict"): dict,
    **{(module, "_reconstructor"): _reconstructor for module in ("copy_reg", "copyreg")},
    **{(module, "object"): object for module in ("__builtin__", "builtins")},
    ("joblib.numpy_pickle", "NumpyArrayWrapper"): _JoblibArray,
    ("chumpy.ch", "Ch"): _Chumpy,
    ("scipy.sparse.csc", "csc_matrix"): _SparseMatrix,
    ("scipy.sparse._csc", "csc_matrix"): _SparseMatrix,
    ("torch._utils", "_rebuild_tensor_v2"): _rebuild_tensor,
    ("torch._utils", "_rebuild_parameter"): lambda data, *_: data,
    ("torch.storage", "_load_from_bytes"): _storage_from_bytes,
    **{(f"numpy.{core}.multiarray", "_reconstruct"): _NumpyArray for core in ("core", "_core")},
    **{(f"numpy.{core}.multiarray", "scalar"): _scalar for core in ("core", "_core")},
}


_InPython: Any = pickle._Unpickler  # the one written in Python, whose opcodes can be extended


class _Unpickler(_InPython):  # type: ignore[misc]
    dispatch: ClassVar[dict[int, Any]] = dict(_InPython.dispatch)

    def __init__(self, stream: io.BytesIO, storages: Callable[[str, int], bytes] | None = None) -> None:
        super().__init__(stream, encoding="latin1")
        self._stream, self._storages = stream, storages

    def find_class(self, module: str, name: str) -> Any:
        """The stand-in of a name; a torch storage type is answered by its element type."""
        if module == "torch" and name in _STORAGES:
            return _STORAGES[name]
        try:
            return _NAMES[module, name]
        except KeyError:
            raise _RefusedError(f"it asks for {module}.{name}, which is not plain data") from None

    def persistent_load(self, pid: Any) -> Any:
        """A torch storage."""
        if self._storages is None or not isinstance(pid, tuple) or pid[0] != "storage":
            raise _RefusedError("it refers to data outside the file")
        _, spec, key, _, count = pid[:5]
        dtype = np.dtype(spec)
        return _array(self._storages(str(key), int(count) * dtype.itemsize), dtype, (int(count),), "C")

    def load_build(self) -> None:
        """BUILD, and the array that joblib puts behind it."""
        super().load_build()
        if isinstance(self.stack[-1], _JoblibArray):
            self.stack[-1].read(self._stream)

    dispatch[pickle.BUILD[0]] = load_build


def _unbox(value: Any) -> Any:
    """Replace every stand-in by what it stands for, all through dicts, lists and tuples."""
    if isinstance(value, _Box):
        return _unbox(value.value)
    if isinstance(value, dict):
        return {key: _unbox(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return type(value)(_unbox(item) for item in value)
    return value


def _zip_torch(data: bytes) -> Any:
    """torch.save since 1.6: a zip with ``data.pkl`` and one member a storage."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        index = next((name for name in archive.namelist() if name.endswith("/data.pkl")), None)
        if index is None:
            raise _RefusedError("it is a zip without data.pkl, so not a torch file")
        folder = index.removesuffix("data.pkl")

        def storage(key: str, _size: int) -> bytes:
            return archive.read(f"{folder}data/{key}")

        return _unbox(_Unpickler(io.BytesIO(archive.read(index)), storage).load())


def _legacy_torch(data: bytes) -> Any:
    """torch.save before 1.6, and tensors in plain pickles: pickles in a row, then the storages."""
    stream = io.BytesIO(data)
    if _Unpickler(stream).load() != _LEGACY_MAGIC:
        raise _RefusedError("it holds a storage that is not torch's")
    for _ in range(2):  # protocol version, system
        _Unpickler(stream).load()
    start = stream.tell()
    pending: dict[str, int] = {}

    def measure(key: str, size: int) -> bytes:
        pending[key] = size
        return bytes(size) if size <= len(data) else _refuse_size()

    _Unpickler(stream, measure).load()
    keys = _Unpickler(stream).load()
    storages = {}
    for key in keys:
        stream.read(8)
        storages[key] = stream.read(pending[key])
    return _unbox(_Unpickler(io.BytesIO(data[start:]), lambda key, _: storages[key]).load())


def _refuse_size() -> bytes:
    raise _RefusedError("it claims more data than it holds")


def load(path: Path) -> Any:
    """The plain data of a pickle, joblib or torch file: dicts, lists, numbers, strings and NumPy arrays.

    Raises:
        EvaluationError: the file is missing, damaged, compressed, or asks for anything but plain data.
    """
    try:
        data = path.read_bytes()
        if data[:2] == b"PK":
            return _zip_torch(data)
        if data[:6] == b"\x93NUMPY":
            return _object_npy(data)
        if data[:1] != b"\x80" and data[:1] not in (b"(", b"c", b"]", b"}"):
            raise _RefusedError("it is compressed or no pickle; save it again without compression")
        value = _unbox(_Unpickler(io.BytesIO(data)).load())
        return _legacy_torch(data) if isinstance(value, int) and value == _LEGACY_MAGIC else value
    except OSError as error:
        raise EvaluationError(f"{path}: {error.strerror or error}; check the path") from error
    except _RefusedError as error:
        raise EvaluationError(f"{path}: {error}; not read, convert it to .npz (docs/metrics.md)") from error
    except Exception as error:  # a damaged stream may raise nearly anything from the unpickler
        raise EvaluationError(f"{path}: damaged ({type(error).__name__}); write it again") from error


def _object_npy(data: bytes) -> Any:
    """``np.save`` of one dict: a header of object type, then a pickle of the 0-d array."""
    stream = io.BytesIO(data)
    npy: Any = np.lib.format
    first = npy.read_magic(stream) == (1, 0)
    shape, fortran, dtype = (npy.read_array_header_1_0 if first else npy.read_array_header_2_0)(stream)
    if dtype.kind != "O":
        return _array(stream.read(), dtype, shape, "F" if fortran else "C")
    if shape != ():
        raise _RefusedError("it holds an array of Python objects")
    return _unbox(_ObjectScalar(stream).load())


class _ObjectScalar(_Unpickler):
    """The pickle of a 0-d object array: its only element is the state's data list."""

    def find_class(self, module: str, name: str) -> Any:
        """An array may be of objects here, if it has one element."""
        found = super().find_class(module, name)
        return _ObjectArray if found is _NumpyArray else found


class _ObjectArray(_NumpyArray):
    def __setstate__(self, state: tuple[Any, ...]) -> None:
        data = state[4]
        if isinstance(data, list) and len(data) == 1:
            self.value = data[0]
        else:
            super().__setstate__(state)
