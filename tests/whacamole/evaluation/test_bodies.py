"""Body models: SMPL against the smplx package, samples of vertices, feet, and where files are found."""

import numpy as np
import pytest

from whacamole.body import BodyModel, BodyParams
from whacamole.evaluation import EvaluationError, PersonTrack, Placement
from whacamole.evaluation.bodies import LocalPose, SmplBody, SmplxBody, foot_points
from whacamole.evaluation.figure import Figure
from whacamole.evaluation.library import BodyLibrary
from whacamole.evaluation.records import CameraTrack
from whacamole.evaluation.smpl import SmplModel


def person(kind="smplx", **changes):
    rng = np.random.default_rng(0)
    joints = 23 if kind == "smpl" else 21
    values = {
        "track_id": 1, "kind": kind, "betas": rng.normal(size=10), "valid": np.ones(6, dtype=bool),
        "body_pose": 0.2 * rng.normal(size=(6, joints, 3)),
        "world": Placement(rng.normal(size=(6, 3)), rng.normal(size=(6, 3))),
    } | changes  # fmt: skip
    return PersonTrack(**values)


@pytest.mark.parametrize("joints", [24, 52])
def test_smpl_is_posed_as_the_smplx_package_does(tmp_path, make, joints):
    torch, lbs = pytest.importorskip("torch"), pytest.importorskip("smplx.lbs")
    arrays = make["smpl"](7, joints=joints)
    np.savez(tmp_path / "SMPL.npz", **arrays)
    model = SmplModel.load(tmp_path / "SMPL.npz")
    rng = np.random.default_rng(1)
    pose, betas = 0.4 * rng.normal(size=(5, joints, 3)), rng.normal(size=(5, 10))
    parents = arrays["kintree_table"][0].copy()
    parents[0] = -1
    vertices, placed = lbs.lbs(
        *(torch.tensor(x, dtype=torch.float64) for x in (betas, pose.reshape(5, -1), arrays["v_template"])),
        torch.tensor(arrays["shapedirs"]),
        torch.tensor(arrays["posedirs"].reshape(-1, 9 * (joints - 1)).T.copy()),
        torch.tensor(arrays["J_regressor"]),
        torch.tensor(parents),
        torch.tensor(arrays["weights"]),
    )
    ours_joints, ours_vertices = model.pose(pose, betas)
    np.testing.assert_allclose(
        ours_joints, placed.numpy(), atol=1e-7
    )  # its axis-angle has an epsilon of 1e-8
    np.testing.assert_allclose(ours_vertices.transpose(2, 0, 1), vertices.numpy(), atol=1e-6)  # float32


def test_the_published_pkl_gives_the_same_model(tmp_path, make):
    import pickle

    import scipy.sparse

    arrays = make["smpl"](8)
    np.savez(tmp_path / "SMPL_MALE.npz", **arrays)
    packed = {**arrays, "J_regressor": scipy.sparse.csc_matrix(arrays["J_regressor"])}
    (tmp_path / "SMPL_MALE.pkl").write_bytes(pickle.dumps(packed, 2))
    a, b = (SmplModel.load(tmp_path / f"SMPL_MALE.{suffix}") for suffix in ("npz", "pkl"))
    np.testing.assert_array_equal(a.joint_regressor, b.joint_regressor)
    np.testing.assert_array_equal(a.posedirs, b.posedirs)


@pytest.mark.parametrize("change", [{"weights": None}, {"J": 23}])
def test_other_models_are_refused(tmp_path, make, change):
    arrays = make["smpl"](0)
    if "weights" in change:
        del arrays["weights"]
    else:
        arrays |= {"weights": arrays["weights"][:, :23], "posedirs": arrays["posedirs"][..., :198]}
    np.savez(tmp_path / "SMPL.npz", **arrays)
    with pytest.raises(EvaluationError, match=r"SMPL"):
        SmplModel.load(tmp_path / "SMPL.npz")


@pytest.mark.parametrize("file", [None, "SMPLX_NEUTRAL.npz"], ids=["few correctives", "dense correctives"])
def test_local_bodies_are_those_of_the_model_without_the_root(models, file):
    model = BodyModel.load(models / file) if file else BodyModel.embedded()
    body, rng = SmplxBody(model), np.random.default_rng(2)
    pose = LocalPose(
        betas=rng.normal(size=10),
        body_pose=0.2 * rng.normal(size=(3, 21, 3)),
        left_hand=0.1 * rng.normal(size=(3, 15, 3)),
        right_hand=0.1 * rng.normal(size=(3, 15, 3)),
        face=np.zeros((3, 3, 3)),
        expression=rng.normal(size=(3, 10)),
    )
    params = BodyParams(
        pose.betas, pose.expression, np.zeros((3, 3)), np.zeros((3, 3)), pose.body_pose, pose.left_hand,
        pose.right_hand, *np.zeros((3, 3, 3)),
    )  # fmt: skip
    posed = model.pose(params)
    np.testing.assert_allclose(body.local_joints(pose), posed.joints - posed.joints[:, :1], atol=1e-12)
    vertices = body.local_vertices(pose).transpose(2, 0, 1)
    np.testing.assert_allclose(vertices, posed.vertices - posed.joints[:, :1], atol=1e-6)


def test_a_sample_of_vertices_is_a_part_of_all_and_has_the_same_joints():
    whole, sample = SmplxBody(BodyModel.embedded()), SmplxBody(BodyModel.embedded(), 500)
    figures = [Figure(person(), body) for body in (whole, sample)]
    np.testing.assert_allclose(figures[0].local_joints, figures[1].local_joints, atol=1e-6)
    at = np.arange(3)
    every, some = (figure.local_vertices(at) for figure in figures)
    picked = np.linspace(0, len(every) - 1, 500).round().astype(int)
    np.testing.assert_allclose(some[sample.scored], every[picked], atol=1e-5)
    np.testing.assert_allclose(some[sample.feet], every[whole.feet], atol=1e-5)
    assert whole.topology != sample.topology


def test_feet_are_toe_and_heel_of_left_and_right():
    model = BodyModel.embedded()
    points = foot_points(model.v_template, model.weights, "smplx")
    left_toe, left_heel, right_toe, right_heel = model.v_template[points]
    assert left_toe[0] > 0 > right_toe[0]
    assert min(left_toe[2] - left_heel[2], right_toe[2] - right_heel[2]) > 0.15
    assert np.ptp([left_toe[1], left_heel[1], right_toe[1], right_heel[1]]) < 0.03


@pytest.mark.parametrize(("kind", "count"), [("smpl", 6890), ("smplh", 6890), ("smplx", 10475)])
def test_published_meshes_have_the_published_feet(kind, count):
    points = foot_points(np.zeros((count, 3)), np.zeros((count, 55)), kind)
    assert len(points) == 4
    assert points.max() < count


def test_files_are_told_by_name_kind_and_gender(models):
    library = BodyLibrary([models])
    male, female = (library.body_of(person("smpl", gender=gender)) for gender in ("male", "female"))
    assert male is not female
    assert library.body_of(person("smpl")) is library.body_of(person("smpl"))
    assert library.body_of(person("smplh")).kind == "smplh"
    assert library.body_of(person("smplx")).topology == "smplx-400"
    with pytest.raises(EvaluationError, match="no SMPL-H female body model"):
        library.body_of(person("smplh", gender="female"))


def test_a_named_model_is_that_model_or_none(models):
    sha = BodyModel.embedded().sha256
    assert BodyLibrary().body_of(person(model_sha256=sha)).topology == "smplx-13886"
    with pytest.raises(EvaluationError, match="neither the embedded body nor given"):
        BodyLibrary([models]).body_of(person(model_sha256="0" * 64))
    exact = BodyModel.load(models / "SMPLX_MALE.npz").sha256
    found = BodyLibrary([models]).body_of(person(model_sha256=exact))
    assert isinstance(found, SmplxBody)


@pytest.mark.parametrize(
    "name", ["basicmodel_m_lbs_10_207_0_v1.1.0.npz", "smpl/male/model.npz", "SMPL_MALE.npz"]
)
def test_the_names_of_the_published_files(tmp_path, make, name):
    path = tmp_path / "given" / name
    path.parent.mkdir(parents=True)
    np.savez(path, **make["smpl"](0))
    assert isinstance(BodyLibrary([tmp_path / "given"]).body_of(person("smpl", gender="male")), SmplBody)


def test_wrong_paths_are_said_at_once(tmp_path):
    with pytest.raises(EvaluationError, match="not there"):
        BodyLibrary([tmp_path / "nothing"])
    (tmp_path / "body.npz").write_bytes(b"")
    with pytest.raises(EvaluationError, match="neither SMPL"):
        BodyLibrary([tmp_path / "body.npz"])
    (tmp_path / "SMPLX_NEUTRAL.npz").write_bytes(b"")
    with pytest.raises(EvaluationError, match="SMPLX_NEUTRAL"):
        BodyLibrary([tmp_path / "SMPLX_NEUTRAL.npz"]).body_of(person())


def test_one_space_follows_from_the_other_through_the_camera(scenes):
    scene, body = scenes[0], SmplxBody(BodyModel.embedded())
    camera = CameraTrack(scene.camera["T_world_camera"], np.ones(40, bool))
    arrays = scene.people
    both = {
        space: Placement(arrays[f"global_orient_{space}"][0], arrays[f"transl_{space}"][0])
        for space in ("world", "camera")
    }
    common = {"betas": arrays["betas"][0], "body_pose": arrays["body_pose"][0], "valid": np.ones(40, bool)}
    only_world = Figure(person(**common, world=both["world"]), body, camera)
    only_camera = Figure(person(**common, world=None, camera=both["camera"]), body, camera)
    for space in ("world", "camera"):
        np.testing.assert_allclose(only_world.joints(space), only_camera.joints(space), atol=1e-6)
        stored = arrays[f"joints_{space}"][0, :, :22]  # without face and hands, which were not given
        np.testing.assert_allclose(only_world.joints(space)[:, :22], stored, atol=1e-5)
    assert Figure(person(**common, world=both["world"]), body).joints("camera") is None


def test_rows_that_are_not_finite_do_not_count():
    holed = person()
    holed.body_pose[2, 0, 0] = np.nan
    figure = Figure(holed, None)
    assert figure.rows.tolist() == [0, 1, 3, 4, 5]
    assert figure.dropped == 1


def test_hands_as_principal_components_are_about_the_mean_hand(models):
    body = BodyLibrary([models]).body_of(person())
    coefficients = np.random.default_rng(0).normal(size=(6, 12))
    figure = Figure(person(left_hand_pose=coefficients), body)
    extras = body.extras
    expected = coefficients @ extras["hands_componentsl"][:12] + extras["hands_meanl"]
    np.testing.assert_allclose(figure.pose.left_hand.reshape(6, 45), expected)
    np.testing.assert_array_equal(figure.pose.right_hand, 0.0)


def test_the_mean_shape_and_the_smoothed_root():
    body = SmplxBody(BodyModel.embedded())
    betas = np.random.default_rng(3).normal(size=(6, 10))
    figure = Figure(person(betas=betas), body, mean_betas=True, smooth_root=3.0)
    np.testing.assert_allclose(figure.betas, betas.mean(axis=0))
    rough = Figure(person(betas=betas), body, mean_betas=True).root("world")[1]
    smooth = figure.root("world")[1]
    assert np.abs(np.diff(smooth, axis=0)).max() < np.abs(np.diff(rough, axis=0)).max()
    assert smooth.mean(axis=0) == pytest.approx(rough.mean(axis=0), abs=1e-9)
