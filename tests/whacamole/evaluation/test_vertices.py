"""Vertex metrics: another way to the same numbers, samples, blocks, parts, maps and regressed joints."""

import pickle
from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse

from whacamole.body import JOINT_INDEX, BodyModel, BodyParams
from whacamole.evaluation import (
    PROTOCOLS,
    Bodies,
    CameraTrack,
    PersonTrack,
    Placement,
    Recording,
    evaluate,
    pooled,
    score_recording,
    score_vertices,
)
from whacamole.evaluation.io.native import read_native
from whacamole.evaluation.truth.dataset import DatasetTruth

T = 8


def value(score, key):
    return pooled([score], key)


@pytest.fixture(scope="module")
def pair(dataset, scenes, make, tmp_path_factory):
    """The first scene and a noisy prediction of it."""
    folder = tmp_path_factory.mktemp("predictions")
    make["predictions"](folder, {"made-0": make["prediction"](scenes[0], noise=0.03)})
    return DatasetTruth(dataset).read("made-0"), read_native(folder / "made-0.npz", "made-0", 30.0)


@pytest.fixture(scope="module")
def meshes(pair, scenes):
    """Both first people posed by the body model itself in the camera's frame."""
    guess, model = pair[1].people[0], BodyModel.embedded()
    rest = (guess.left_hand_pose, guess.right_hand_pose, guess.jaw_pose, guess.leye_pose, guess.reye_pose)
    seen = (guess.camera.orient, guess.camera.transl, guess.body_pose)
    theirs = model.pose(BodyParams(guess.betas, guess.expression, *seen, *rest))
    return theirs, model.pose(BodyParams.from_arrays(scenes[0].people, "camera", 0))


@pytest.fixture(scope="module")
def score(pair):
    return score_recording(*pair, "whac", Bodies())


def mean_distance(a, b):
    return np.linalg.norm(a - b, axis=-1).mean(axis=1) * 1000


def test_pve_is_the_mean_over_the_posed_meshes(score, meshes):
    theirs, ours = meshes
    np.testing.assert_allclose(
        score.values["t_pve"][0], mean_distance(theirs.vertices, ours.vertices), rtol=1e-4, atol=1e-2
    )
    rooted = [posed.vertices - posed.joints[:, :1] for posed in meshes]
    np.testing.assert_allclose(score.values["pve"][0], mean_distance(*rooted), rtol=1e-4, atol=1e-2)


def test_pve_of_the_face_is_that_of_the_heads_vertices_at_the_neck(score, meshes):
    weights = BodyModel.embedded().weights
    head = weights[:, [JOINT_INDEX[n] for n in ("head", "jaw", "left_eye", "right_eye")]].sum(axis=1) > 0.5
    necks = [posed.vertices[:, head] - posed.joints[:, [JOINT_INDEX["neck"]]] for posed in meshes]
    np.testing.assert_allclose(score.values["pve_face"][0], mean_distance(*necks), rtol=1e-4, atol=1e-2)


def test_pve_of_the_hands_is_that_of_each_hand_at_its_wrist(score, meshes):
    weights, hands = BodyModel.embedded().weights, []
    for side, fingers in (("left", range(25, 40)), ("right", range(40, 55))):
        wrist = JOINT_INDEX[f"{side}_wrist"]
        hand = weights[:, [wrist, *fingers]].sum(axis=1) > 0.5
        hands.append(mean_distance(*(posed.vertices[:, hand] - posed.joints[:, [wrist]] for posed in meshes)))
    np.testing.assert_allclose(score.values["pve_hands"][0], np.mean(hands, axis=0), rtol=1e-4, atol=1e-2)


def test_emdbs_pa_pve_uses_the_alignment_of_the_joints(pair, score):
    emdb = score_recording(*pair, replace(PROTOCOLS["whac"], pa_vertices="joints"), Bodies())
    assert value(emdb, "pa_pve") > value(score, "pa_pve")
    assert value(emdb, "pve") == value(score, "pve")


def test_a_sample_of_vertices_estimates_all(pair, score):
    some = score_recording(*pair, "whac", Bodies(vertices=1000))
    for key in ("pve", "pa_pve", "t_pve"):
        assert value(some, key) == pytest.approx(value(score, key), rel=0.01)
    for key in ("mpjpe", "w_mpjpe", "foot_sliding"):
        assert value(some, key) == pytest.approx(value(score, key), rel=1e-4)


def test_the_size_of_a_block_changes_nothing(pair, monkeypatch):
    whole = score_recording(*pair, "whac", Bodies(vertices=300))
    monkeypatch.setattr(score_vertices, "BLOCK", 1)
    single = score_recording(*pair, "whac", Bodies(vertices=300))
    for key in ("pve", "pa_pve", "pve_hands", "foot_sliding"):
        np.testing.assert_allclose(single.values[key], whole.values[key], rtol=1e-4, atol=1e-4)


def recording(kind, seed=0):
    """Somebody who walks in front of a camera that stands."""
    rng = np.random.default_rng(seed)
    walk = np.cumsum(0.05 * rng.normal(size=(T, 3)), axis=0) + np.array([0.0, 0.0, 4.0])
    person = PersonTrack(
        track_id=0,
        kind=kind,
        betas=rng.normal(size=10),
        body_pose=0.2 * rng.normal(size=(T, 23 if kind == "smpl" else 21, 3)),
        valid=np.ones(T, bool),
        world=Placement(np.tile([np.pi, 0.0, 0.0], (T, 1)), walk),
    )
    camera = CameraTrack(np.tile(np.eye(4), (T, 1, 1)), np.ones(T, bool))
    return Recording("seq", np.arange(T), 30.0, (person,), camera)


def chosen():
    """The matrix that takes from the SMPL-X mesh the vertices that the made-up SMPL consists of."""
    every, some = 400, 200
    columns = np.linspace(0, every - 1, some).astype(int)
    return scipy.sparse.csr_matrix((np.ones(some), (np.arange(some), columns)), shape=(some, every))


@pytest.mark.parametrize("suffix", ["npz", "pkl"])
def test_a_map_carries_one_mesh_to_the_other(models, tmp_path, suffix):
    truth, guess = recording("smpl"), recording("smplx")
    path = tmp_path / f"smplx2smpl.{suffix}"
    if suffix == "npz":
        scipy.sparse.save_npz(path, chosen())
    else:
        path.write_bytes(pickle.dumps({"matrix": chosen().toarray()}))
    without = score_recording(truth, guess, "gvhmr", Bodies(files=(models,)))
    assert "pve" not in without.values
    assert any("add --vertex-map" in note for note in without.notes)
    mapped = score_recording(truth, guess, "gvhmr", Bodies(files=(models,), vertex_map=path))
    assert np.isfinite(mapped.values["pve"]).all()
    assert "foot_sliding" in mapped.values
    assert "pve_hands" not in mapped.values
    assert any("other hand joints" in note for note in mapped.notes)


def test_what_is_no_map_is_refused(models, tmp_path, dataset):
    np.savez(tmp_path / "map.npz", x=np.zeros(3))
    with pytest.raises(Exception, match="no vertex map"):
        evaluate(dataset, tmp_path, bodies=Bodies(vertex_map=tmp_path / "map.npz"))


def test_a_joint_regressor_gives_the_14_joints(models, tmp_path):
    truth = recording("smpl")
    path = tmp_path / "J_regressor_h36m.npy"
    rows = np.random.default_rng(0).random((17, 200))
    np.save(path, rows / rows.sum(axis=1, keepdims=True))
    protocol = replace(PROTOCOLS["wham"], joints="h36m14")
    other = replace(truth, people=(replace(truth.people[0], betas=truth.people[0].betas + 0.5),))
    score = score_recording(truth, other, protocol, Bodies(files=(models,), joint_regressor=path))
    plain = score_recording(truth, other, "wham", Bodies(files=(models,)))
    assert 0 < value(score, "mpjpe") != value(plain, "mpjpe")
    assert np.isfinite(value(score, "wa_mpjpe"))
    without = score_recording(truth, other, protocol, Bodies(files=(models,)))
    assert any("--joint-regressor" in note for note in without.notes)
    assert "mpjpe" not in without.values
