"""Reading models: what is refused and how, what is carried over, what the embedded body is."""

import hashlib
import io
import os
import re
import subprocess
import sys
import zipfile
from contextlib import suppress
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from whacamole.body import JOINT_INDEX, PARENTS, BodyModel, BodyModelError

MEAN = np.zeros(10)


@pytest.fixture
def write(make_arrays, tmp_path):
    """Write the synthetic model with changes (``None`` takes a key out) and return its path."""

    def write_model(name="model.npz", **changes):
        path = tmp_path / name
        arrays = make_arrays() | changes
        np.savez(path, **{key: value for key, value in arrays.items() if value is not None})
        return path

    return write_model


def _refusal(path):
    with pytest.raises(BodyModelError) as caught:
        BodyModel.load(path)
    message = str(caught.value)
    assert "\n" not in message
    assert Path(path).name in message
    assert ";" in message  # what is wrong; what to do
    return message


def test_embedded_body_has_the_size_and_place_of_smplx(model):
    assert model.v_template.shape == (13886, 3)
    assert model.faces.shape == model.uv_faces.shape == (27676, 3)
    assert model.quads is not None
    assert model.uv_quads is not None
    assert model.quads.shape == model.uv_quads.shape
    np.testing.assert_allclose(model.weights.sum(axis=1), 1, atol=1e-6)
    # Motions made for SMPL-X keep their foot contact if pelvis and soles are where SMPL-X has them.
    np.testing.assert_allclose(model.rest_joints(MEAN)[0], [0, -0.3514, 0.012], atol=1e-3)
    assert model.pelvis_height(MEAN) == pytest.approx(0.974, abs=2e-3)
    left, right = (model.rest_joints(MEAN)[JOINT_INDEX[f"{side}_wrist"]] for side in ("left", "right"))
    np.testing.assert_allclose(left, right * [-1, 1, 1], atol=2e-3)
    assert left[0] > 0.6


def test_embedded_body_is_small_and_named_by_its_file(model):
    data = files("whacamole").joinpath("assets", "body", "open_body.npz").read_bytes()
    assert len(data) < 2_000_000
    assert model.sha256 == hashlib.sha256(data).hexdigest()
    assert model.name == "whacamole-open-body"
    assert BodyModel.embedded() is model


def test_lengths_follow_the_shape(model):
    tall = np.eye(10)[0]
    assert model.stature(MEAN) == pytest.approx(np.ptp(model.v_template[:, 1]), abs=1e-6)
    for measure in (model.stature, model.leg_length, model.pelvis_height, model.volume):
        assert measure(-2 * tall) < measure(MEAN) < measure(2 * tall)
    rest = model.rest_joints(MEAN)
    thigh, shin = (np.linalg.norm(rest[JOINT_INDEX[a]] - rest[JOINT_INDEX[b]])
                   for a, b in (("left_hip", "left_knee"), ("left_knee", "left_ankle")))  # fmt: skip
    assert model.leg_length(MEAN) == pytest.approx(thigh + shin, abs=1e-3)


def test_shared_arrays_cannot_be_written(model):
    for array in (model.v_template, model.faces, model.weights, model.parents):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_rest_joints_are_the_regressed_vertices(write, make_arrays, make_params):
    arrays, params = make_arrays(), make_params(0, 2)
    body = BodyModel.load(write())
    coefficients = np.concatenate([np.tile(params.betas, (2, 1)), params.expression], axis=1)
    shaped = arrays["v_template"] + np.einsum("vik,tk->tvi", arrays["shapedirs"], coefficients)
    expected = np.einsum("jv,tvi->tji", arrays["J_regressor"], shaped)
    np.testing.assert_allclose(body.rest_joints(params.betas, params.expression), expected, atol=1e-6)
    np.testing.assert_allclose(
        body.rest_vertices(params.betas),
        arrays["v_template"] + arrays["shapedirs"][..., :10] @ params.betas,
        atol=1e-6,
    )
    with pytest.raises(ValueError, match=r"shape \(9,\), expected"):
        body.rest_joints(np.zeros(9))


@pytest.mark.parametrize("width", [20, 300, 399])
def test_narrow_files_have_expression_at_ten(write, make_arrays, width):
    arrays = make_arrays(width=width)
    body = BodyModel.load(write(shapedirs=arrays["shapedirs"]))
    np.testing.assert_array_equal(
        body.arrays.expression_dirs, arrays["shapedirs"][..., 10:20].astype(np.float32)
    )


def test_export_keeps_every_array_and_every_byte(write, tmp_path):
    body = BodyModel.load(write("SMPLX_MALE.npz"))
    first, second = (body.export_full(tmp_path / name) for name in ("SMPLX_a.npz", "SMPLX_b.npz"))
    assert first.read_bytes() == second.read_bytes()
    again = BodyModel.load(first)
    assert again.gender == body.gender == "male"
    assert again.matches(body.sha256)
    assert again.matches(again.sha256)
    assert not body.matches(again.sha256)
    assert not body.matches("")
    with np.load(first, allow_pickle=False) as file:
        np.testing.assert_array_equal(file["kintree_table"][0], [2**32 - 1, *PARENTS[1:]])
        for key in ("lmk_faces_idx", "lmk_bary_coords", "hands_meanl", "hands_componentsr"):
            np.testing.assert_array_equal(file[key], body.extras[key])
    # Out of the export comes the same export, still named after the first.
    assert again.export_full(tmp_path / "SMPLX_c.npz").read_bytes() == first.read_bytes()


def test_export_to_a_place_that_cannot_be_written_says_so(model, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(BodyModelError, match="choose a place that can be written"):
        model.export_full(tmp_path / "file" / "body.npz")


def test_a_file_without_texture_coordinates_shows_one_point(write):
    body = BodyModel.load(write(vt=None, ft=None))
    np.testing.assert_array_equal(body.uv, [[0, 0]])
    assert body.uv_faces.shape == body.faces.shape
    assert not body.uv_faces.any()
    assert body.quads is None


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"posedirs": None}, "no key 'posedirs'"),
        ({"f": None, "weights": None}, "no key 'f', 'weights'"),
        ({"weights": np.ones((40, 24))}, r"'weights' is \(40, 24\) float64, SMPL-X has 40 × 55"),
        ({"posedirs": np.ones((40, 3, 207))}, "'posedirs' is"),
        ({"shapedirs": np.ones((40, 3, 16))}, "16 directions, fewer than 10"),
        ({"shapedirs": np.ones((39, 3, 20))}, "'shapedirs' is"),
        ({"J_regressor": np.ones((40, 55))}, "'J_regressor' is"),
        ({"v_template": np.full((40, 3), np.nan)}, "'v_template' holds values that are not finite"),
        ({"v_template": np.full((40, 3), "x")}, "'v_template' is"),
        ({"v_template": np.zeros((0, 3))}, "'v_template' is"),
        ({"f": np.full((80, 3), 40)}, "'f' points outside 0 … 39"),
        ({"f": np.zeros((80, 4), dtype=np.int64)}, "'f' is"),
        ({"ft": np.zeros((7, 3), dtype=np.int64)}, "'ft' has 7 faces but 'f' has 80"),
        ({"kintree_table": np.zeros((2, 55), dtype=np.int64)}, "'kintree_table' is not the tree"),
        ({"weights": np.array({}, dtype=object)}, "'weights' holds Python objects"),
    ],
)  # fmt: skip
def test_a_wrong_array_is_refused_by_name(write, changes, said):
    assert re.search(said, _refusal(write(**changes)))


def test_files_of_other_kinds_are_refused_with_a_remedy(tmp_path):
    kinds = {
        "SMPLX_NEUTRAL.pkl": (b"\x80\x02}q\x00.", "a pickle, which could run code"),
        "renamed.npz": (b"\x80\x04N.", "a pickle"),
        "protocol0.pkl": (b"(dp0\n.", "a pickle"),
        "text.npz": (b"hello", "not an .npz file"),
        "empty.npz": (b"", "not an .npz file"),
        "cut.npz": (b"PK\x03\x04half", "a damaged .npz"),
    }
    for name, (content, said) in kinds.items():
        (tmp_path / name).write_bytes(content)
        assert said in _refusal(tmp_path / name)
    with zipfile.ZipFile(tmp_path / "models_smplx_v1_1.zip", "w") as archive:
        archive.writestr("models/smplx/SMPLX_NEUTRAL.npz", b"")
    assert "unpack it" in _refusal(tmp_path / "models_smplx_v1_1.zip")


def test_a_path_that_is_no_file_is_refused_with_a_remedy(write, tmp_path):
    assert "check the path" in _refusal(tmp_path / "absent.npz")
    assert "name an SMPL-X .npz file" in _refusal(tmp_path)
    write("SMPLX_MALE.npz")
    assert "name one of SMPLX_MALE.npz" in _refusal(tmp_path)


def test_a_pickle_in_disguise_never_runs(tmp_path):
    path, trap = tmp_path / "trap.npz", tmp_path / "sprung"
    member = b"cpathlib\nPosixPath\n(S'" + str(trap).encode() + b"'\ntR."
    with zipfile.ZipFile(path, "w") as archive:
        for key in ("v_template", "f", "shapedirs", "posedirs", "J_regressor", "weights", "kintree_table"):
            archive.writestr(f"{key}.npy", member)
    assert "'v_template'" in _refusal(path)
    assert not trap.exists()


def test_damaged_bytes_are_refused_or_harmless(write, make_params):
    good = write().read_bytes()
    whole = BodyModel.load(write()).pose(make_params(0, 1)).vertices
    rng = np.random.default_rng(0)
    path = write()
    for _ in range(150):
        data = bytearray(good)
        if rng.random() < 0.3:
            data = data[: rng.integers(len(data))]
        else:
            for at in rng.integers(len(data) // 2 if rng.random() < 0.5 else len(data), size=3):
                data[at] = rng.integers(256)
        path.write_bytes(data)
        # Either the one kind of error, or the damage fell where nothing is read.
        with suppress(BodyModelError):
            np.testing.assert_array_equal(BodyModel.load(path).pose(make_params(0, 1)).vertices, whole)


def test_a_broken_lean_file_is_refused(tmp_path):
    buffer = io.BytesIO()
    np.savez(buffer, lean_body_version=np.array(1))
    path = tmp_path / "lean.npz"
    path.write_bytes(buffer.getvalue())
    assert "not a whole lean body" in _refusal(path)
    np.savez(path, lean_body_version=np.array(99))
    assert "lean body version 99" in _refusal(path)


def test_pack_tool_reports_and_refuses(write, tmp_path):
    root = Path(__file__).parents[3]
    lean = tmp_path / "out" / "lean.npz"

    def run(*arguments):
        command = [sys.executable, str(root / "tools" / "body_pack.py"), *map(str, arguments)]
        variables = os.environ | {"PYTHONPATH": str(root)}
        return subprocess.run(command, env=variables, capture_output=True, text=True, check=False)

    done = run(write(), lean)
    assert done.returncode == 0, done.stderr
    assert f"{lean}: {lean.stat().st_size:,} bytes" in done.stdout
    assert BodyModel.load(lean).num_vertices == 40
    failed = run(tmp_path / "absent.npz", lean)
    assert failed.returncode == 1
    assert failed.stderr.count("\n") == 1
