"""Files of joblib, torch and chumpy are read as plain data, and nothing in them runs."""

import pickle
import sys
import types
from collections import OrderedDict, defaultdict
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse

from whacamole.evaluation import EvaluationError
from whacamole.evaluation.io.inert import load

torch = pytest.importorskip("torch")
joblib = pytest.importorskip("joblib")


def tracks():
    rng = np.random.default_rng(0)
    result = defaultdict(dict)
    result[3] = {
        "pose": rng.normal(size=(5, 72)).astype("f4"),
        "fortran": np.asfortranarray(rng.normal(size=(4, 3))),
        "ids": np.arange(5),
        "one": np.float32(3.5),
        "flags": np.array([True, False]),
        "name": "someone",
        "nothing": None,
    }
    return result


def test_joblib(tmp_path):
    written = tracks()
    joblib.dump(written, tmp_path / "a.pkl")
    read = load(tmp_path / "a.pkl")
    for key in ("pose", "fortran", "ids", "flags"):
        np.testing.assert_array_equal(read[3][key], written[3][key])
    assert (read[3]["one"], read[3]["name"], read[3]["nothing"]) == (3.5, "someone", None)


def tensors():
    return {
        "params": OrderedDict(a=torch.rand(4, 3), b=torch.arange(6).reshape(2, 3).T),
        "double": torch.rand(2, 3, 3).double(),
        "half": torch.rand(3).half(),
        "flags": torch.tensor([True, False]),
        "scalar": torch.tensor(3.0),
        "list": [1, "x", None, True],
        "view": torch.arange(12.0).reshape(3, 4)[1:, ::2],
    }


def assert_tensors(read, written):
    np.testing.assert_array_equal(read["params"]["a"], written["params"]["a"].numpy())
    for key in ("double", "half", "flags", "scalar", "view"):
        np.testing.assert_array_equal(read[key], written[key].numpy())
    np.testing.assert_array_equal(read["params"]["b"], written["params"]["b"].numpy())
    assert read["list"] == written["list"]


@pytest.mark.parametrize("new", [True, False])
def test_torch_files_of_both_kinds(tmp_path, new):
    written = tensors()
    torch.save(written, tmp_path / "a.pt", _use_new_zipfile_serialization=new)
    assert_tensors(load(tmp_path / "a.pt"), written)


def test_tensors_inside_joblib_and_inside_numpy(tmp_path):
    written = tensors()
    joblib.dump(written, tmp_path / "a.pkl")
    assert_tensors(load(tmp_path / "a.pkl"), written)
    np.save(tmp_path / "b.npy", written, allow_pickle=True)
    assert_tensors(load(tmp_path / "b.npy"), written)


def test_a_plain_npy_is_its_array(tmp_path):
    np.save(tmp_path / "a.npy", np.arange(6.0).reshape(2, 3))
    np.testing.assert_array_equal(load(tmp_path / "a.npy"), np.arange(6.0).reshape(2, 3))


@pytest.fixture
def chumpy(monkeypatch):
    """A module that pickles like chumpy's arrays."""
    package, module = types.ModuleType("chumpy"), types.ModuleType("chumpy.ch")

    class Ch:
        def __init__(self, x):
            self.x = x

    Ch.__module__, Ch.__qualname__ = "chumpy.ch", "Ch"
    module.Ch, package.ch = Ch, module
    monkeypatch.setitem(sys.modules, "chumpy", package)
    monkeypatch.setitem(sys.modules, "chumpy.ch", module)
    return Ch


@pytest.mark.parametrize("protocol", [0, 2, 4])
def test_body_models_with_chumpy_and_sparse_matrices(tmp_path, chumpy, protocol):
    dense = np.random.default_rng(0).random((4, 5)) * (np.arange(20).reshape(4, 5) % 3 == 0)
    model = {"shapedirs": chumpy(np.arange(6.0)), "J_regressor": scipy.sparse.csc_matrix(dense), "bs": "lbs"}
    (tmp_path / "m.pkl").write_bytes(pickle.dumps(model, protocol))
    read = load(tmp_path / "m.pkl")
    np.testing.assert_array_equal(read["shapedirs"], np.arange(6.0))
    np.testing.assert_array_equal(read["J_regressor"], dense)


class Attack:
    """Runs code when it is unpickled in good faith."""

    def __reduce__(self):
        return (exec, ("import pathlib; pathlib.Path('hacked').touch()",))


@pytest.mark.parametrize("how", ["pickle", "joblib", "torch", "npy"])
def test_nothing_runs(tmp_path, monkeypatch, how):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / {"npy": "a.npy"}.get(how, "a.pkl")
    value = {"x": Attack()}
    {
        "pickle": lambda: path.write_bytes(pickle.dumps(value)),
        "joblib": lambda: joblib.dump(value, path),
        "torch": lambda: torch.save(value, path),
        "npy": lambda: np.save(path, value, allow_pickle=True),
    }[how]()
    with pytest.raises(EvaluationError, match=r"asks for (builtins|__builtin__)\.exec"):
        load(path)
    assert not Path("hacked").exists()


def one_line(excinfo) -> str:
    text = str(excinfo.value)
    assert "\n" not in text
    return text


def test_cut_files_are_named_damaged(tmp_path):
    joblib.dump(tracks(), tmp_path / "a.pkl")
    whole = (tmp_path / "a.pkl").read_bytes()
    for size in (10, 200, len(whole) // 2, len(whole) - 3):
        (tmp_path / "b.pkl").write_bytes(whole[:size])
        with pytest.raises(EvaluationError) as excinfo:
            load(tmp_path / "b.pkl")
        assert str(tmp_path / "b.pkl") in one_line(excinfo)


def test_a_tensor_cannot_reach_outside_its_storage(tmp_path):
    torch.save(torch.arange(4.0), tmp_path / "a.pt")
    import zipfile

    with zipfile.ZipFile(tmp_path / "a.pt") as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    index = next(name for name in members if name.endswith("data.pkl"))
    assert b"K\x04\x85" in members[index]
    members[index] = members[index].replace(b"K\x04\x85", b"K\x40\x85")
    with zipfile.ZipFile(tmp_path / "b.pt", "w") as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    with pytest.raises(EvaluationError, match="outside its storage"):
        load(tmp_path / "b.pt")


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "no pickle"),
        (b"hello", "no pickle"),
        (b"\x80\x04\x95", "damaged"),
        (pickle.dumps(np.array([{}, 1], dtype=object)), "Python objects"),
        (pickle.dumps(np.array(["a"])), "type"),
        (b"PK\x03\x04nothing", "damaged"),
    ],
)
def test_what_is_not_plain_data_is_refused_in_one_line(tmp_path, content, said):
    (tmp_path / "a.pkl").write_bytes(content)
    with pytest.raises(EvaluationError, match=said) as excinfo:
        load(tmp_path / "a.pkl")
    one_line(excinfo)


def test_compressed_joblib_says_what_to_do(tmp_path):
    joblib.dump(tracks(), tmp_path / "a.pkl", compress=3)
    with pytest.raises(EvaluationError, match="without compression"):
        load(tmp_path / "a.pkl")


def test_a_missing_file_is_said(tmp_path):
    with pytest.raises(EvaluationError, match="No such file"):
        load(tmp_path / "a.pkl")
