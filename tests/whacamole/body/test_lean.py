"""The lean form: exact once decoded, the same again when packed again, and close to what it was made from."""

from dataclasses import fields, replace

import numpy as np
import pytest

from whacamole.body.lean import pack, unpack
from whacamole.body.schema import NpzReader, full_arrays, read_full, write_npz


@pytest.fixture
def dense(make_arrays):
    quads = np.random.default_rng(1).integers(0, 40, size=(40, 4))
    return read_full(make_arrays() | {"quads": quads, "quads_t": quads}, "synthetic")


def _same(a, b):
    for field in fields(a):
        left, right = getattr(a, field.name), getattr(b, field.name)
        if hasattr(left, "toarray"):
            left, right = left.toarray(), right.toarray()
        if field.name == "extras":
            assert left.keys() == right.keys()
            left, right = list(left.values()), list(right.values())
            for x, y in zip(left, right, strict=True):
                np.testing.assert_array_equal(x, y)
            continue
        np.testing.assert_array_equal(left, right, err_msg=field.name)
        assert left is None or left.dtype == right.dtype


def test_packing_loses_only_what_it_says(dense):
    lean = unpack(pack(dense), "lean")
    np.testing.assert_allclose(lean.shapedirs, dense.shapedirs, rtol=2**-11, atol=1e-7)
    np.testing.assert_allclose(lean.expression_dirs, dense.expression_dirs, rtol=2**-11, atol=1e-7)
    largest = np.abs(dense.posedirs.data).max()
    np.testing.assert_allclose(lean.posedirs.toarray(), dense.posedirs.toarray(), atol=largest * 2**-15)
    np.testing.assert_allclose(lean.weights, dense.weights, atol=1 / 65535)
    np.testing.assert_allclose(lean.weights.sum(axis=1, dtype=np.float64), 1, atol=1e-6)
    # All the rest is kept to the bit.
    kept = {name: getattr(dense, name) for name in ("shapedirs", "expression_dirs", "posedirs", "weights")}
    _same(replace(lean, **kept), dense)


def test_packing_what_was_unpacked_gives_the_same_file(dense, tmp_path):
    once = pack(dense)
    twice = pack(unpack(once, "lean"))
    for name, arrays in (("once", once), ("twice", twice)):
        write_npz(tmp_path / name, arrays)
    assert (tmp_path / "once").read_bytes() == (tmp_path / "twice").read_bytes()


def test_embedded_body_through_lean_and_full_is_itself(model, tmp_path):
    _same(unpack(pack(model.arrays), "lean"), model.arrays)
    write_npz(tmp_path / "full.npz", full_arrays(model.arrays))
    with (tmp_path / "full.npz").open("rb") as stream:
        _same(read_full(NpzReader(stream, "full.npz"), "full.npz"), model.arrays)


def test_no_part_file_stays_beside_the_written_one(tmp_path):
    write_npz(tmp_path / "deep" / "a.npz", {"x": np.arange(3)})
    assert [p.name for p in (tmp_path / "deep").iterdir()] == ["a.npz"]
    with pytest.raises(ValueError, match="allow_pickle"):
        write_npz(tmp_path / "deep" / "b.npz", {"x": np.array({}, dtype=object)})
    assert [p.name for p in (tmp_path / "deep").iterdir()] == ["a.npz"]
