"""From a dataset on disk to predictions on disk, by the command line."""

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from baseline_scenes import TrueScene
from camera_rigs import CameraPath
from whacamole.baseline.estimators.files import FilesEstimator
from whacamole.baseline.estimators.noisy_labels import LabelNoise, NoisyLabelsEstimator, spoil_rand
from whacamole.baseline.footage import sequence_footage, video_footage
from whacamole.baseline.predictions import prediction_arrays
from whacamole.baseline.recover import Recovery
from whacamole.baseline.setup import estimator_named, odometry_named
from whacamole.body import BodyModel, BodyParams
from whacamole.cli.baseline import app
from whacamole.dataset import DatasetLayout, open_dataset, write_index, write_summary
from whacamole.dataset.files import write_arrays
from whacamole.dataset.splitting import refresh_splits
from whacamole.errors import BaselineError
from whacamole.labels import LabelledPerson
from whacamole.labels.camera import camera_arrays
from whacamole.labels.people import PeopleLabels

K = np.array([[600.0, 0.0, 320.0], [0.0, 600.0, 180.0], [0.0, 0.0, 1.0]])


@pytest.fixture(scope="module")
def dataset(scene: TrueScene, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A dataset of one sequence without pixels."""
    root = tmp_path_factory.mktemp("baseline") / "data"
    layout = DatasetLayout(root)
    path = CameraPath(np.tile(K, (scene.num_frames, 1, 1)), scene.T_world_camera, 30.0, 640, 360)
    people = [LabelledPerson(i + 1, "somebody", "neutral", p) for i, p in enumerate(scene.world)]
    arrays = PeopleLabels(people, scene.body, path).arrays()
    arrays["valid"][:], arrays["visible_fraction"][:] = True, 1.0
    arrays["visible_fraction"][1, 100:] = 0.05
    sequence = layout.sequence("pair-00")
    sequence.folder.mkdir(parents=True)
    write_arrays(sequence.camera, camera_arrays(path))
    write_arrays(sequence.people, arrays)
    facts = {"motion_id": "somebody", "frames": scene.num_frames, "width": 640, "height": 360, "passes": []}
    write_summary(sequence, facts)
    write_index(layout, {})
    refresh_splits(layout, 1.0)
    return root


def _run(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(argument) for argument in arguments], catch_exceptions=True)


def _error(result: Result) -> str:
    assert isinstance(result.exception, BaselineError), result.output
    return str(result.exception)


ORACLE = ("--estimator", "noisy-labels", "--vo", "noisy-labels", "--masks", "none")


def test_a_run_writes_what_the_format_promises(dataset: Path, tmp_path: Path, scene: TrueScene) -> None:
    result = _run("run", "--data", dataset, "--out", tmp_path, *ORACLE, "--noise", 0, "--json")
    assert result.exit_code == 0, result.output
    report = json.loads(result.output)
    assert report["ground_truth_used"] == ["K", "camera", "people"]
    [one] = report["sequences"]
    assert one["people"] == 2
    assert "an ablation, not an estimate" in one["notes"][-1]
    with np.load(tmp_path / "pair-00.npz", allow_pickle=False) as stored:
        found = {key: stored[key] for key in stored.files}
    T = scene.num_frames
    shapes = {
        "track_id": (2,), "frame_index": (T,), "betas": (2, 10), "expression": (2, T, 10),
        "global_orient_world": (2, T, 3), "transl_camera": (2, T, 3), "body_pose": (2, T, 21, 3),
        "left_hand_pose": (2, T, 15, 3), "valid": (2, T), "T_world_camera": (T, 4, 4), "scale": (),
        "K": (T, 3, 3),
    }  # fmt: skip
    assert {key: found[key].shape for key in shapes} == shapes
    assert str(found["body_model_sha256"]) == scene.body.sha256
    assert found["valid"][0].all()
    assert found["valid"][1].tolist() == [True] * 100 + [False] * 50
    assert np.isnan(found["transl_world"][1, 100:]).all()
    # Without noise the camera-frame people are the labels.
    truth = open_dataset(dataset)["pair-00"].people
    np.testing.assert_allclose(found["transl_camera"][0], truth["transl_camera"][0], atol=1e-6)


def test_the_same_run_gives_the_same_bytes(dataset: Path, tmp_path: Path) -> None:
    for name in ("a", "b"):
        assert _run("run", "--data", dataset, "--out", tmp_path / name, *ORACLE, "-q").exit_code == 0
    first, second = ((tmp_path / name / "pair-00.npz").read_bytes() for name in ("a", "b"))
    assert first == second


def test_what_is_there_is_kept_if_asked_for(dataset: Path, tmp_path: Path) -> None:
    path = tmp_path / "pair-00.npz"
    path.write_bytes(b"done before")
    assert _run("run", "--data", dataset, "--out", tmp_path, *ORACLE, "--keep", "-q").exit_code == 0
    assert path.read_bytes() == b"done before"
    assert _run("run", "--data", dataset, "--out", tmp_path, *ORACLE, "-q").exit_code == 0
    assert path.read_bytes() != b"done before"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ((), "either a dataset by --data or a video by --video"),
        (("--data", "there", "--video", "there.mp4"), "either a dataset"),
        (
            ("--data", "there", "--estimator", "guess"),
            "no estimator 'guess', only mediapipe, files, noisy-labels",
        ),
        (("--data", "there", "--vo", "orb"), "no odometry 'orb', only opencv"),
        (("--data", "there", "--estimator", "files"), "--estimator files needs --estimates FOLDER"),
        (("--data", "there", "--vo", "files", "--trajectories", "nowhere"), "nowhere: not there"),
        (("--data", "there", "--mode", "best"), "no mode 'best', only paper, release, steady"),
        (("--data", "there", "--focal", "long"), "focal length 'long': expected given, diagonal"),
        (("--data", "there", "--components", "imu"), "components 'imu': expected both, vo, mv"),
        (("--video", "nowhere.mp4"), "nowhere.mp4: not readable as a video"),
        (("--data", "there", "--weights", "nowhere.safetensors"), "no weights of the velocimeter"),
    ],
)
def test_what_cannot_be_is_one_line(options: tuple[str, ...], message: str, tmp_path: Path) -> None:
    error = _error(_run("run", "--out", tmp_path, *options))
    assert message in error
    assert "\n" not in error


def test_a_sequence_that_fails_is_told_and_the_run_ends_in_failure(dataset: Path, tmp_path: Path) -> None:
    result = _run("run", "--data", dataset, "--out", tmp_path, *ORACLE[:4], "--masks", "guess")
    assert result.exit_code == 1
    assert "pair-00: masks 'guess': expected detector, labels, none" in result.output
    assert not (tmp_path / "pair-00.npz").exists()


def test_predictions_of_one_run_are_estimates_for_another(dataset: Path, tmp_path: Path) -> None:
    """`files` reads the project's own npz; a file made with another focal length is put to this one's
    depth."""
    _run("run", "--data", dataset, "--out", tmp_path / "a", *ORACLE, "--noise", 0, "-q")
    footage = sequence_footage(open_dataset(dataset)["pair-00"])
    body = BodyModel.embedded()
    given = np.tile(K, (footage.num_frames, 1, 1))
    wider = given.copy()
    wider[:, :2, :2] *= 1.5
    same, other = (FilesEstimator(tmp_path / "a").estimate(footage, k, body) for k in (given, wider))
    truth = open_dataset(dataset)["pair-00"].people["joints_camera"]
    for index, (one, two) in enumerate(zip(same, other, strict=True)):
        pelvis = truth[index, one.valid, 0]
        np.testing.assert_allclose(body.pose_joints(one.params)[one.valid, 0], pelvis, atol=1e-5)
        moved = body.pose_joints(two.params)[two.valid, 0]
        np.testing.assert_allclose(moved, pelvis * [1.0, 1.0, 1.5], atol=1e-5)
    assert np.flatnonzero(same[1].valid).tolist() == list(range(100))


def test_the_camera_of_one_run_is_odometry_for_another(dataset: Path, tmp_path: Path) -> None:
    """Its scale is lost on the way, and what true data it was made from is not."""
    _run("run", "--data", dataset, "--out", tmp_path / "a", *ORACLE, "-q")
    files = (
        "--estimator",
        "files",
        "--estimates",
        tmp_path / "a",
        "--vo",
        "files",
        "--trajectories",
        tmp_path / "a",
    )
    result = _run("run", "--data", dataset, "--out", tmp_path / "b", *files, "--masks", "none", "--json")
    assert result.exit_code == 0, result.output
    assert json.loads(result.output)["ground_truth_used"] == ["K", "camera", "people"]
    first, second = (np.load(tmp_path / name / "pair-00.npz") for name in ("a", "b"))
    np.testing.assert_allclose(second["T_world_camera"], first["T_world_camera"], atol=1e-6)
    np.testing.assert_array_equal(second["detected"], first["detected"])
    with np.load(tmp_path / "a" / "pair-00.npz") as stored:
        arrays = {key: stored[key] for key in stored.files}
    arrays["T_vo"][:, :3, 3] *= 7.0
    write_arrays(tmp_path / "a" / "pair-00.npz", arrays)
    _run("run", "--data", dataset, "--out", tmp_path / "c", *files, "--masks", "none", "-q")
    third = np.load(tmp_path / "c" / "pair-00.npz")
    np.testing.assert_allclose(third["T_world_camera"], second["T_world_camera"], atol=1e-6)


def test_estimates_with_a_focal_length_need_no_camera(dataset: Path, tmp_path: Path) -> None:
    """K alone, as a network's output has it, says at which depth its people are."""
    _run("run", "--data", dataset, "--out", tmp_path / "a", *ORACLE, "--noise", 0, "-q")
    path = tmp_path / "a" / "pair-00.npz"
    with np.load(path) as stored:
        kept = {key: stored[key] for key in stored.files if key not in ("T_world_camera", "camera_valid")}
    write_arrays(path, kept)
    footage, body = sequence_footage(open_dataset(dataset)["pair-00"]), BodyModel.embedded()
    far = np.tile(K * [[2.0], [2.0], [1.0]], (footage.num_frames, 1, 1))
    [one, _] = FilesEstimator(tmp_path / "a").estimate(footage, far, body)
    truth = open_dataset(dataset)["pair-00"].people["joints_camera"][0, :, 0]
    np.testing.assert_allclose(body.pose_joints(one.params)[:, 0], truth * [1.0, 1.0, 2.0], atol=1e-5)


def test_a_run_tells_how_far_it_is(dataset: Path) -> None:
    footage, told = sequence_footage(open_dataset(dataset)["pair-00"]), []
    footage = replace(footage, images=lambda: _images(3)).watched(told.append)
    assert len(list(footage.images())) == 3
    assert told == [1, 2, 3]


def test_crops_become_places_by_the_papers_depth(dataset: Path, tmp_path: Path, scene: TrueScene) -> None:
    """Weak-perspective crops of the true people put their transl back where it was."""
    footage = sequence_footage(open_dataset(dataset)["pair-00"])
    truth = open_dataset(dataset)["pair-00"].people
    transl = truth["transl_camera"]
    side = np.full(transl.shape[:2], 200.0)
    center = transl[..., :2] / transl[..., 2:] * 600.0 + np.array([320.0, 180.0])
    values = {key: truth[key] for key in ("track_id", "betas", "body_pose", "global_orient_camera")}
    values |= {
        "frame_index": np.arange(footage.num_frames), "crop_scale": 2.0 * 600.0 / (side * transl[..., 2]),
        "crop_side": side, "crop_center": center, "crop_translation": np.zeros((*side.shape, 2)),
    }  # fmt: skip
    np.savez(tmp_path / "pair-00.npz", **values)
    found = FilesEstimator(tmp_path).estimate(footage, np.tile(K, (footage.num_frames, 1, 1)), scene.body)
    for row, person in enumerate(found):
        np.testing.assert_allclose(person.params.transl, transl[row], atol=1e-9)


def test_estimates_that_do_not_fit_are_refused(dataset: Path, tmp_path: Path, scene: TrueScene) -> None:
    footage = sequence_footage(open_dataset(dataset)["pair-00"])
    with pytest.raises(BaselineError, match="no prediction for pair-00"):
        FilesEstimator(tmp_path).estimate(footage, np.tile(K, (footage.num_frames, 1, 1)), scene.body)
    people = scene.estimates()
    world = Recovery(scene.T_world_camera, np.ones(scene.num_frames, dtype=bool), 1.0, ())
    arrays = prediction_arrays(
        people,
        world,
        np.arange(scene.num_frames) + 7,
        30.0,
        np.tile(K, (scene.num_frames, 1, 1)),
        scene.body,
        {},
    )
    np.savez(tmp_path / "pair-00.npz", **arrays)
    with pytest.raises(BaselineError, match="has frame 150, the video has 150 from 0 on"):
        FilesEstimator(tmp_path).estimate(footage, np.tile(K, (footage.num_frames, 1, 1)), scene.body)


def test_noise_is_what_it_says(scene: TrueScene) -> None:
    truth, body = scene.estimates()[0].params, scene.body
    rng = np.random.default_rng(0)
    same = spoil_rand(rng, truth, body, LabelNoise().times(0.0))
    for name in ("transl", "body_pose", "global_orient", "betas"):
        np.testing.assert_allclose(getattr(same, name), getattr(truth, name), atol=1e-9)
    ratios = []
    for seed in range(20):
        spoiled = spoil_rand(np.random.default_rng(seed), truth, body, LabelNoise(depth=0.05, place=0.0))
        ratios.append(body.pose_joints(spoiled)[:, 0, 2] / body.pose_joints(truth)[:, 0, 2])
    assert np.log(ratios).std() == pytest.approx(0.05, rel=0.3)


def test_labels_of_another_body_are_refused(dataset: Path, tmp_path: Path, body: BodyModel) -> None:
    other = BodyModel(body.arrays, name="another", sha256="f" * 64)
    footage = sequence_footage(open_dataset(dataset)["pair-00"])
    with pytest.raises(
        BaselineError, match="labelled with whacamole-open-body, not another; give --body-model"
    ):
        NoisyLabelsEstimator().estimate(footage, np.tile(K, (footage.num_frames, 1, 1)), other)


def test_nobody_is_a_prediction_too(body: BodyModel) -> None:
    world = Recovery(np.tile(np.eye(4), (4, 1, 1)), np.ones(4, dtype=bool), float("nan"), ())
    arrays = prediction_arrays([], world, np.arange(4), 30.0, np.tile(K, (4, 1, 1)), body, {"method": "x"})
    assert arrays["body_pose"].shape == (0, 4, 21, 3)
    assert arrays["valid"].shape == (0, 4)
    assert arrays["transl_world"].shape == (0, 4, 3)


def test_a_video_is_footage(tmp_path: Path) -> None:
    path = tmp_path / "clip.mp4"
    _write_video(path, 12)
    footage = video_footage(path)
    assert (footage.id, footage.num_frames, footage.width, footage.height) == ("clip", 12, 64, 48)
    assert footage.fps == pytest.approx(25.0)
    assert [image.shape for image in footage.images()] == [(48, 64, 3)] * 12
    assert footage.given_K is None
    with pytest.raises(BaselineError, match="needs a dataset with labels"):
        estimator_named("noisy-labels", None, 1.0, 0).estimate(
            footage, np.tile(K, (12, 1, 1)), BodyModel.embedded()
        )
    assert odometry_named("noisy-labels", None, 1.0, 0).name == "noisy-labels"


def _write_video(path: Path, frames: int) -> None:
    import av

    with av.open(str(path), "w") as container:
        stream = container.add_stream("mpeg4", rate=25)
        stream.width, stream.height, stream.pix_fmt = 64, 48, "yuv420p"
        for image in _images(frames):
            container.mux(stream.encode(av.VideoFrame.from_ndarray(image, format="rgb24")))
        container.mux(stream.encode())


def _images(frames: int) -> Iterator[np.ndarray]:
    for frame in range(frames):
        yield np.full((48, 64, 3), 10 * frame, dtype=np.uint8)


def test_params_survive_the_file(scene: TrueScene) -> None:
    people = scene.estimates()
    world = Recovery(scene.T_world_camera, np.ones(scene.num_frames, dtype=bool), 1.0, ())
    K_all = np.tile(K, (scene.num_frames, 1, 1))
    arrays = prediction_arrays(people, world, np.arange(scene.num_frames), 30.0, K_all, scene.body, {})
    back = BodyParams.from_arrays(arrays, frame="world", person=1)
    wanted = scene.body.pose_joints(scene.world[1])
    np.testing.assert_allclose(scene.body.pose_joints(back), wanted, atol=1e-5)
