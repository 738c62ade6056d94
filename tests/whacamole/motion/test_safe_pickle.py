"""Nothing in a file can execute, take absurd memory or end in anything but the one refusal."""

import contextlib
import os
import pickle
import struct
from collections import OrderedDict
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from whacamole.errors import MotionError
from whacamole.motion import read_motion
from whacamole.motion.safe_pickle import UnsafePickleError, loads

PROTOCOLS = range(pickle.HIGHEST_PROTOCOL + 1)


class Bomb:
    """Pickles to a call that leaves a mark when it is executed."""

    def __init__(self, mark: Path) -> None:
        self.mark = mark

    def __reduce__(self) -> tuple[object, tuple[str]]:
        return os.system, (f"touch {self.mark}",)


def build(*parts: bytes) -> bytes:
    """A pickle of protocol 2 from raw opcodes."""
    return b"\x80\x02" + b"".join(parts) + b"."


@pytest.mark.parametrize("protocol", PROTOCOLS)
@pytest.mark.parametrize(
    "array",
    [
        np.arange(12.0).reshape(3, 4),
        np.asfortranarray(np.arange(12.0).reshape(3, 4)),
        np.arange(6, dtype=">i4").reshape(2, 3),
        np.array(3.5),
        np.zeros((0, 3), dtype=np.float32),
        np.array([True, False]),
        np.array(["male", "female"]),
        np.array([b"male"]),
    ],
)
def test_arrays_survive_every_protocol(array, protocol):
    found = loads(pickle.dumps({"a": array}, protocol=protocol))
    assert isinstance(found, dict)
    np.testing.assert_array_equal(found["a"], array)
    assert found["a"].dtype == array.dtype


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_plain_data_survives(protocol):
    value = {
        "scalar": np.float64(2.5),
        "list": [1, 2.0, "x", None, True],
        "tuple": (1, (2, 3)),
        "nested": {"gender": "male", "bytes": b"female"},
        "ordered": OrderedDict(a=1),
        "object": np.array({"k": np.arange(3)}, dtype=object),
        "shared": [[1], [1]],
    }
    found = loads(pickle.dumps(value, protocol=protocol))
    assert isinstance(found, dict)
    np.testing.assert_array_equal(found["object"].pop("k"), np.arange(3))
    assert found | {"object": None} == value | {"object": None}


def test_names_of_both_numpy_generations_are_known():
    old = pickle.dumps(np.arange(3.0), protocol=2)
    new = old.replace(b"numpy.core.multiarray", b"numpy._core.multiarray")
    assert new != old
    np.testing.assert_array_equal(loads(new), np.arange(3.0))


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_code_is_not_executed(tmp_path, protocol):
    mark = tmp_path / "executed"
    payload = pickle.dumps({"poses": Bomb(mark)}, protocol=protocol)
    with pytest.raises(UnsafePickleError, match=r"posix\.system|os\.system"):
        loads(payload)
    assert not mark.exists()


@pytest.mark.parametrize("container", ["pkl", "npy", "npz", "npz in poses"])
def test_code_in_a_motion_file_is_not_executed(tmp_path, container):
    mark = tmp_path / "executed"
    values = {"poses": Bomb(mark), "transl": np.zeros((2, 3))}
    if container == "pkl":
        path = tmp_path / "clip.pkl"
        path.write_bytes(pickle.dumps(values))
    elif container == "npy":
        path = tmp_path / "clip.npy"
        np.save(path, np.array(values, dtype=object), allow_pickle=True)
    elif container == "npz":
        path = tmp_path / "clip.npz"
        np.savez(
            path,
            poses=np.zeros((9, 156)),
            trans=np.zeros((9, 3)),
            mocap_framerate=np.array(Bomb(mark), dtype=object),
        )
    else:
        path = tmp_path / "clip.npz"
        np.savez(
            path, poses=np.array([Bomb(mark), 1], dtype=object), trans=np.zeros((9, 3)), mocap_framerate=30.0
        )
    with pytest.raises(MotionError, match="refused: it asks for") as refusal:
        read_motion(path)
    assert "\n" not in str(refusal.value)
    assert str(path) in str(refusal.value)
    assert not mark.exists()


@pytest.mark.parametrize(
    "name",
    ["builtins eval", "builtins getattr", "numpy load", "numpy.core.multiarray fromfile", "codecs encode",
     "collections defaultdict", "whacamole.motion.safe_pickle _Array", "_codecs decode", "copyreg call"],
)  # fmt: skip
def test_every_other_name_is_refused(name):
    module, attribute = name.split()
    with pytest.raises(UnsafePickleError, match="not plain data"):
        loads(build(f"c{module}\n{attribute}\n".encode()))


def test_numpy_classes_are_never_called():
    huge = b"cnumpy\nndarray\n(\x8a\x06" + (10**13).to_bytes(6, "little") + b"t\x85R"
    with pytest.raises(UnsafePickleError):
        loads(build(huge))


@pytest.mark.parametrize(
    "payload",
    [
        build(b"]", b"r" + struct.pack("<I", 0xFFFFFFFF)),  # a memo index that would allocate 32 GB
        build(b"\x96" + struct.pack("<Q", 1 << 40)),  # a bytearray of a terabyte that is not there
        build(b"\x8e" + struct.pack("<Q", 1 << 40)),  # bytes likewise
        build(b"]" * 200_000, b"a" * 199_999),  # nesting deeper than the stack
        b"",
        b"\x80",
        b"\x80\xff.",
        b"not a pickle at all",
        pickle.dumps(np.arange(100.0))[:-40],
    ],
    ids=["memo", "bytearray", "bytes", "nested", "empty", "short", "protocol", "text", "cut"],
)
def test_bombs_and_damage_end_in_the_refusal(payload):
    with pytest.raises(UnsafePickleError):
        loads(payload)


def test_an_array_cannot_claim_more_than_its_bytes():
    honest = pickle.dumps(np.zeros((3, 4)), protocol=2)
    lie = honest.replace(b"K\x03K\x04\x86", b"K\xffK\xff\x86")
    assert lie != honest
    with pytest.raises(UnsafePickleError, match="bytes"):
        loads(lie)


def test_a_laughing_list_is_walked_once():
    value: list[object] = []
    for _ in range(60):
        value = [value, value]
    assert isinstance(loads(pickle.dumps(value)), list)


@given(st.binary(max_size=300))
@settings(max_examples=300, derandomize=True, deadline=None)
def test_any_bytes_are_data_or_refused(data):
    with contextlib.suppress(UnsafePickleError):
        loads(data)


@given(st.data())
@settings(max_examples=300, derandomize=True, deadline=None)
def test_damaged_pickles_are_data_or_refused(data):
    payload = bytearray(
        pickle.dumps(
            {"poses": np.arange(6.0), "meta": {"gender": "male"}},
            protocol=data.draw(st.sampled_from(list(PROTOCOLS))),
        )
    )
    for _ in range(data.draw(st.integers(1, 4))):
        payload[data.draw(st.integers(0, len(payload) - 1))] = data.draw(st.integers(0, 255))
    with contextlib.suppress(UnsafePickleError):
        loads(bytes(payload))
