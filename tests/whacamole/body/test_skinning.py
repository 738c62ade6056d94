"""Posing against the PyPI package ``smplx`` (a test-only peer), and what must hold of any posing."""

import os
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
import smplx
import torch
from hypothesis import given, settings
from hypothesis import strategies as st

from whacamole.body import BodyModel, BodyParams

SEEDS = st.integers(0, 2**32 - 1)
PER_FRAME = (
    "expression", "global_orient", "transl", "body_pose", "left_hand_pose", "right_hand_pose",
    "jaw_pose", "leye_pose", "reye_pose",
)  # fmt: skip


def _peer(path, params):
    """Vertices and joints by the ``smplx`` package, from the file alone."""
    T = params.num_frames
    body = smplx.create(
        str(path), model_type="smplx", ext="npz", use_pca=False, flat_hand_mean=True, batch_size=T
    )
    given = {name: getattr(params, name).reshape(T, -1) for name in PER_FRAME}
    given["betas"] = np.broadcast_to(params.betas, (T, 10))
    with torch.no_grad():
        posed = body(**{k: torch.tensor(v, dtype=torch.float32) for k, v in given.items()})
    return posed.vertices.numpy(), posed.joints[:, :55].numpy()


@pytest.fixture(scope="module")
def exported(model, tmp_path_factory):
    return model.export_full(tmp_path_factory.mktemp("export") / "SMPLX_NEUTRAL.npz")


@pytest.mark.parametrize("betas_per_frame", [False, True])
def test_embedded_body_agrees_with_smplx(model, exported, make_params, betas_per_frame):
    params = make_params(0, 40, betas_per_frame)
    vertices, joints = _peer(exported, params)
    posed = model.pose(params)
    np.testing.assert_allclose(posed.vertices, vertices, atol=1e-5)
    np.testing.assert_allclose(posed.joints, joints, atol=1e-5)


def test_wide_model_with_pickled_keys_agrees_with_smplx(make_arrays, make_params, tmp_path):
    # As the official files: 400 directions with expression from 300 on, dictionaries in 0-d object arrays.
    arrays = make_arrays(V=10475, width=400)
    path = tmp_path / "SMPLX_FEMALE.npz"
    np.savez(path, **arrays, joint2num=np.array({"Pelvis": 0}, dtype=object))
    body, params = BodyModel.load(path), make_params(1, 3)
    vertices, joints = _peer(path, params)
    posed = body.pose(params)
    np.testing.assert_allclose(posed.vertices, vertices, atol=1e-5)
    np.testing.assert_allclose(posed.joints, joints, atol=1e-5)
    assert (body.gender, body.name) == ("female", "SMPLX_FEMALE")
    assert "joint2num" not in body.extras


def test_exported_file_poses_the_same_bits(model, exported, make_params):
    params = make_params(2, 5)
    again = BodyModel.load(exported).pose(params)
    posed = model.pose(params)
    np.testing.assert_array_equal(again.vertices, posed.vertices)
    np.testing.assert_array_equal(again.joints, posed.joints)


@settings(max_examples=15, deadline=None, derandomize=True)
@given(seed=SEEDS, start=st.integers(0, 69), length=st.integers(1, 70))
def test_a_slice_poses_to_the_same_bits(make_params, seed, start, length):
    model, params = BodyModel.embedded(), make_params(seed, 70, betas_per_frame=seed % 2 == 0)
    whole, part = model.pose(params), model.pose(params.slice(start, start + length))
    np.testing.assert_array_equal(part.vertices, whole.vertices[start : start + length])
    np.testing.assert_array_equal(part.joints, whole.joints[start : start + length])


def test_dense_model_poses_slices_to_the_same_bits(make_arrays, make_params, tmp_path):
    path = tmp_path / "dense.npz"
    np.savez(path, **make_arrays(V=300))
    model, params = BodyModel.load(path), make_params(6, 67)
    whole = model.pose(params).vertices
    for start, stop in ((0, 1), (31, 33), (5, 67), (66, 67)):
        np.testing.assert_array_equal(model.pose(params.slice(start, stop)).vertices, whole[start:stop])


def test_threads_change_no_bit():
    code = (
        "import hashlib, numpy as np; from dataclasses import replace;"
        "from whacamole.body import BodyModel, BodyParams;"
        "rng = np.random.default_rng(0); p = BodyParams.zeros(5, rng.normal(size=10));"
        "p = replace(p, body_pose=rng.normal(size=(5, 21, 3)), expression=rng.normal(size=(5, 10)));"
        "o = BodyModel.embedded().pose(p); b = o.vertices.tobytes() + o.joints.tobytes();"
        "print(hashlib.sha256(b).hexdigest())"
    )
    digests = set()
    for threads in ("1", "4"):
        variables = {"OPENBLAS_NUM_THREADS": threads, "OMP_NUM_THREADS": threads}
        done = subprocess.run(
            [sys.executable, "-c", code],
            env=os.environ | variables,
            capture_output=True,
            text=True,
            check=True,
        )
        digests.add(done.stdout)
    assert len(digests) == 1


def test_zero_pose_is_the_rest_body(model, make_params):
    betas = make_params(3, 1).betas
    posed = model.pose(BodyParams.zeros(2, betas))
    np.testing.assert_allclose(posed.vertices, np.stack([model.rest_vertices(betas)] * 2), atol=1e-6)
    np.testing.assert_allclose(posed.joints, np.stack([model.rest_joints(betas)] * 2), atol=1e-12)
    np.testing.assert_allclose(model.pose(BodyParams.zeros(1)).vertices[0], model.v_template, atol=1e-6)


@settings(max_examples=15, deadline=None, derandomize=True)
@given(seed=SEEDS)
def test_translation_adds(make_params, seed):
    model, params = BodyModel.embedded(), make_params(seed, 2)
    still, moved = model.pose(replace(params, transl=np.zeros((2, 3)))), model.pose(params)
    np.testing.assert_allclose(moved.vertices, still.vertices + params.transl[:, None], atol=2e-6)
    np.testing.assert_allclose(moved.joints, still.joints + params.transl[:, None], atol=1e-12)


@settings(max_examples=15, deadline=None, derandomize=True)
@given(seed=SEEDS)
def test_bones_keep_their_length(make_params, seed):
    model, params = BodyModel.embedded(), make_params(seed, 2)
    rest, posed = model.rest_joints(params.betas, params.expression), model.pose_joints(params)
    children, parents = np.arange(1, 55), model.parents[1:]
    for joints in (rest, posed):
        assert joints.shape == (2, 55, 3)
    expected = np.linalg.norm(rest[:, children] - rest[:, parents], axis=-1)
    np.testing.assert_allclose(
        np.linalg.norm(posed[:, children] - posed[:, parents], axis=-1), expected, atol=1e-12
    )


def test_joints_alone_are_the_joints_of_the_posed_body(model, make_params):
    for per_frame in (False, True):
        params = make_params(4, 35, per_frame)
        np.testing.assert_array_equal(model.pose_joints(params), model.pose(params).joints)


def test_one_shape_for_all_frames_or_the_same_for_each_is_one_body(model, make_params):
    params = make_params(5, 3)
    repeated = replace(params, betas=np.tile(params.betas, (3, 1)))
    np.testing.assert_array_equal(model.pose(repeated).vertices, model.pose(params).vertices)


def test_no_frames_give_no_bodies(model):
    posed = model.pose(BodyParams.zeros(0))
    assert posed.vertices.shape == (0, model.num_vertices, 3)
    assert posed.joints.shape == (0, 55, 3)
