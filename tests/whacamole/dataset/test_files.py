"""Files: plain, whole, and the same bytes for the same content."""

from pathlib import Path

import numpy as np
import pytest

from whacamole.dataset.files import sha256_of, write_arrays, write_json


def test_equal_arrays_give_equal_bytes(tmp_path: Path) -> None:
    arrays = {"K": np.eye(3), "name": np.array("walk"), "valid": np.array([True, False])}
    for name in ("a.npz", "b.npz"):
        write_arrays(tmp_path / name, arrays)
    assert sha256_of(tmp_path / "a.npz") == sha256_of(tmp_path / "b.npz")
    with np.load(tmp_path / "a.npz", allow_pickle=False) as stored:
        for key, value in arrays.items():
            assert stored[key].dtype == value.dtype
            np.testing.assert_array_equal(stored[key], value)


def test_nothing_that_needs_pickle_is_written(tmp_path: Path) -> None:
    with pytest.raises(TypeError, match="pickle"):
        write_arrays(tmp_path / "a.npz", {"people": np.array([{"a": 1}], dtype=object)})
    assert not list(tmp_path.iterdir())


def test_json_refuses_what_other_readers_cannot_read(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="JSON"):
        write_json(tmp_path / "a.json", {"gap": float("inf")})
    assert not (tmp_path / "a.json").exists()
