"""Ground truth of the benchmarks, read from files of the same schema that the tests write."""

import csv
import json
import pickle

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from whacamole.evaluation import (
    Bodies,
    EvaluationError,
    evaluate,
    open_truth,
    pooled,
    score_recording,
    summary,
)
from whacamole.evaluation.figure import Figure
from whacamole.evaluation.library import BodyLibrary

T = 12


def rigid(rng, frames):
    T_world_camera = np.tile(np.eye(4), (frames, 1, 1))
    T_world_camera[:, :3, :3] = Rotation.from_rotvec(0.1 * rng.normal(size=(frames, 3))).as_matrix()
    T_world_camera[:, :3, 3] = np.cumsum(0.3 * rng.normal(size=(frames, 3)), axis=0)
    return T_world_camera


def assert_self_consistent(truth, models):
    """The recording is a perfect prediction of itself, whatever its bodies."""
    score = score_recording(truth, truth, "wham", Bodies(files=(models,)))
    for key in ("mpjpe", "pve", "wa_mpjpe"):
        assert pooled([score], key) == pytest.approx(0.0, abs=1e-3)
    assert score.counts["people_missing"] == 0


@pytest.fixture
def emdb(tmp_path):
    rng = np.random.default_rng(0)
    cameras = rigid(rng, T)
    for name, emdb1, emdb2 in (("P0/09_walk", True, False), ("P1/10_run", False, True)):
        subject, sequence = name.split("/")
        folder = tmp_path / subject / sequence
        folder.mkdir(parents=True)
        good = np.ones(T, bool)
        good[3] = False
        data = {
            "gender": "male", "name": f"{subject}_{sequence}", "emdb1": emdb1, "emdb2": emdb2, "n_frames": T,
            "good_frames_mask": good,
            "camera": {"intrinsics": np.diag([900.0, 900.0, 1.0]), "extrinsics": np.linalg.inv(cameras),
                       "width": 1440, "height": 1920},
            "smpl": {"poses_root": rng.normal(size=(T, 3)), "poses_body": 0.2 * rng.normal(size=(T, 69)),
                     "trans": rng.normal(size=(T, 3)) + np.array([0, 0, 5]), "betas": rng.normal(size=10)},
            "kp2d": np.zeros((T, 24, 2)), "bboxes": {"bboxes": np.zeros((T, 4)), "invalid_idxs": np.zeros(0)},
        }  # fmt: skip
        (folder / f"{subject}_{sequence}_data.pkl").write_bytes(pickle.dumps(data))
    return tmp_path, cameras


def test_emdb(emdb, models):
    root, cameras = emdb
    source = open_truth(root)
    assert source.name == "EMDB"
    assert source.ids("emdb1") == ["P0_09_walk"]
    assert source.ids("emdb2") == ["P1_10_run"]
    assert source.ids("all") == ["P0_09_walk", "P1_10_run"]
    truth = source.read("P0_09_walk")
    np.testing.assert_allclose(truth.camera.T_world_camera, cameras, atol=1e-9)
    assert truth.people[0].gender == "male"
    assert truth.people[0].valid.sum() == T - 1
    assert truth.up == (0.0, 1.0, 0.0)
    assert_self_consistent(truth, models)


def test_emdb_scores_a_wham_output_of_its_truth(emdb, models, tmp_path_factory):
    joblib = pytest.importorskip("joblib")
    root, _ = emdb
    truth = open_truth(root).read("P0_09_walk")
    person, out = truth.people[0], tmp_path_factory.mktemp("wham")
    body = BodyLibrary([models]).body_of(person)
    orient, pelvis = Figure(person, body, truth.camera).root("camera")
    rows, body_pose = np.flatnonzero(person.valid), person.body_pose.reshape(T, 69)
    seen = np.concatenate([Rotation.from_matrix(orient).as_rotvec(), body_pose[rows]], axis=1)
    track = {
        "pose": seen, "trans": pelvis - body.rest_pelvis(person.betas),
        "pose_world": np.concatenate([person.world.orient, body_pose], axis=1)[rows],
        "trans_world": person.world.transl[rows], "betas": np.tile(person.betas, (len(rows), 1)),
        "frame_ids": rows,
    }  # fmt: skip
    (out / "P0_09_walk").mkdir()
    joblib.dump({0: track}, out / "P0_09_walk" / "wham_output.pkl")
    # WHAM's body is neutral: give the truth's model for both by a folder where they are the same file.
    same = tmp_path_factory.mktemp("same")
    for gender in ("MALE", "NEUTRAL"):
        (same / f"SMPL_{gender}.npz").write_bytes((models / "SMPL_MALE.npz").read_bytes())
    result = evaluate(root, out, "wham", split="emdb1", bodies=Bodies(files=(same,)))
    found = summary(result)[out.name]
    for key in ("mpjpe", "pa_mpjpe", "pve", "w_mpjpe", "wa_mpjpe", "rte", "accel"):
        assert found[key] == pytest.approx(0.0, abs=1e-2), key
    assert result.complete


def test_3dpw(tmp_path, models):
    rng = np.random.default_rng(1)
    cameras = rigid(rng, T)
    valid = [np.ones(T), np.ones(T)]
    valid[1][:4] = 0
    detections = [np.ones((T, 3, 18)), np.ones((T, 3, 18))]
    detections[0][5] = 0.0
    data = {
        "sequence": "walk_00", "genders": ["m", "f"], "cam_poses": np.linalg.inv(cameras),
        "campose_valid": valid,
        "betas": [rng.normal(size=10), rng.normal(size=300)], "poses2d": detections,
        "poses": [0.2 * rng.normal(size=(T, 72)) for _ in range(2)],
        "trans": [rng.normal(size=(T, 3)) + np.array([i * 3, 0, 5]) for i in range(2)],
        "cam_intrinsics": np.eye(3),
        "img_frame_ids": np.arange(T), "jointPositions": [np.zeros((T, 72))] * 2,
    }  # fmt: skip
    folder = tmp_path / "sequenceFiles" / "test"
    folder.mkdir(parents=True)
    (folder / "walk_00.pkl").write_bytes(pickle.dumps(data, 2))
    source = open_truth(tmp_path)
    assert (source.name, source.ids("test"), source.ids("all")) == ("3DPW", ["walk_00"], ["walk_00"])
    truth = source.read("walk_00")
    assert [p.gender for p in truth.people] == ["male", "female"]
    assert [p.betas.shape for p in truth.people] == [(10,), (10,)]
    assert [int(p.valid.sum()) for p in truth.people] == [T - 1, T - 4]
    np.testing.assert_allclose(truth.camera.T_world_camera, cameras, atol=1e-9)
    assert_self_consistent(truth, models)
    with pytest.raises(EvaluationError, match="no split 'val'"):
        source.ids("val")


def smplx_frame(rng, gender=None):
    """One frame as RICH and EgoBody store it: rows of one, hands as 12 principal components."""
    sizes = {
        "transl": 3, "global_orient": 3, "body_pose": 63, "betas": 10, "expression": 10, "jaw_pose": 3,
        "leye_pose": 3, "reye_pose": 3, "left_hand_pose": 12, "right_hand_pose": 12,
    }  # fmt: skip
    frame = {key: (0.2 * rng.normal(size=(1, size))).astype("f4") for key, size in sizes.items()}
    frame["transl"] += np.array([0, 0, 4], "f4")
    return frame | ({"gender": gender, "pose_embedding": np.zeros((1, 32), "f4")} if gender else {})


CALIBRATION = """<?xml version="1.0"?>
<opencv_storage>
<CameraMatrix type_id="opencv-matrix">
  <rows>3</rows> <cols>4</cols> <dt>d</dt> <data>{extrinsic}</data></CameraMatrix>
<Intrinsics type_id="opencv-matrix">
  <rows>3</rows> <cols>3</cols> <dt>d</dt> <data>{intrinsic}</data></Intrinsics>
<Distortion type_id="opencv-matrix">
  <rows>1</rows> <cols>5</cols> <dt>d</dt> <data>0 0 0 0 0</data></Distortion>
</opencv_storage>
"""


@pytest.fixture
def rich(tmp_path):
    rng = np.random.default_rng(2)
    for frame in range(3, 3 + T):
        folder = tmp_path / "bodies" / "test" / "Gym_012_pushup" / f"{frame:05d}"
        folder.mkdir(parents=True)
        if frame != 7:
            (folder / "012.pkl").write_bytes(pickle.dumps(smplx_frame(rng)))
    folder = tmp_path / "scan_calibration" / "Gym" / "calibration"
    folder.mkdir(parents=True)
    cameras = rigid(rng, 2)
    for number, camera in enumerate(cameras):
        extrinsic = " ".join(map(str, np.linalg.inv(camera)[:3].ravel()))
        text = CALIBRATION.format(extrinsic=extrinsic, intrinsic="900 0 600 0 910 300 0 0 1")
        (folder / f"{number:03d}.xml").write_text(text, encoding="utf-8")
    (tmp_path / "gender.json").write_text(json.dumps({"12": "male"}), encoding="utf-8")
    return tmp_path, cameras


def test_rich(rich, models):
    root, cameras = rich
    source = open_truth(root)
    assert source.ids("test") == ["Gym_012_pushup_cam_00", "Gym_012_pushup_cam_01"]
    truth = source.read("Gym_012_pushup_cam_01")
    person = truth.people[0]
    assert (person.gender, person.kind, person.left_hand_pose.shape) == ("male", "smplx", (T, 12))
    assert person.valid.tolist() == [frame != 7 for frame in range(3, 3 + T)]
    assert truth.frame_index[0] == 3
    np.testing.assert_allclose(truth.camera.T_world_camera[4], cameras[1], atol=1e-9)
    np.testing.assert_allclose(truth.camera.K[0], [[900, 0, 600], [0, 910, 300], [0, 0, 1]])
    assert_self_consistent(truth, models)


def test_rich_without_genders_says_that_bodies_are_neutral(rich, models):
    root, _ = rich
    (root / "gender.json").unlink()
    truth = open_truth(root).read("Gym_012_pushup_cam_00")
    assert truth.people[0].gender == "neutral"
    assert any("gender.json" in note for note in truth.notes)
    assert_self_consistent(truth, models)


@pytest.fixture
def egobody(tmp_path):
    rng = np.random.default_rng(3)
    name = "recording_20210907_S02_S01_01"
    with (tmp_path / "data_info_release.csv").open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(
            ["scene_name", "recording_name", "start_frame", "end_frame", "body_idx_0", "body_idx_fpv"]
        )
        writer.writerow(["cab_e", name, 100, 100 + T - 1, "male", "1 male"])
    with (tmp_path / "data_splits.csv").open("w", newline="", encoding="utf-8") as stream:
        csv.writer(stream).writerows([["train", "val", "test"], ["other", name, ""]])
    bodies = tmp_path / "smplx_interactee_val" / name / "body_idx_1" / "results"
    color = tmp_path / "egocentric_color" / name / "2021-09-07-000000"
    color.mkdir(parents=True)
    holo_to_kinect, cameras = rigid(rng, 1)[0], rigid(rng, T)
    times = 132000000 + 333 * np.arange(T)
    rows = ["960.5,540.25,1920,1080"]
    to_opengl = np.diag([1.0, -1.0, -1.0, 1.0])
    for row, time in enumerate(times):
        pv_to_world = np.linalg.inv(holo_to_kinect) @ cameras[row] @ to_opengl
        rows.append(",".join(map(str, [time, 1400.0 + row, 1401.0, *pv_to_world.ravel()])))
        if row != 5:
            (bodies / f"frame_{100 + row:05d}").mkdir(parents=True)
            frame = pickle.dumps(smplx_frame(rng, "male"))
            (bodies / f"frame_{100 + row:05d}" / "000.pkl").write_bytes(frame)
    (color / "2021-09-07-000000_pv.txt").write_text("\n".join(rows), encoding="utf-8")
    images = [f"egocentric_color/{name}/x/PV/{time}_frame_{100 + i:05d}.jpg" for i, time in enumerate(times)]
    np.savez(color / "valid_frame.npz", imgname=np.array(images[:-1]), valid=np.arange(T - 1) != 2)
    folder = tmp_path / "calibrations" / name / "cal_trans"
    folder.mkdir(parents=True)
    text = json.dumps({"trans": holo_to_kinect.tolist()})
    (folder / "holo_to_kinect12.json").write_text(text, encoding="utf-8")
    return tmp_path, name, cameras


def test_egobody(egobody, models):
    root, name, cameras = egobody
    source = open_truth(root)
    assert (source.name, source.ids("val"), source.ids("all")) == ("EgoBody", [name], [name])
    truth = source.read(name)
    person = truth.people[0]
    assert (person.gender, person.track_id, truth.source) == ("male", 1, "cab_e")
    # No body at 5, no detection at 2, no image at the last.
    assert person.valid.tolist() == [i not in (2, 5, T - 1) for i in range(T)]
    np.testing.assert_allclose(truth.camera.T_world_camera[:-1], cameras[:-1], atol=1e-6)
    np.testing.assert_allclose(truth.camera.K[3], [[1403, 0, 960.5], [0, 1401, 540.25], [0, 0, 1]])
    assert_self_consistent(truth, models)


def test_each_benchmark_says_what_is_missing(emdb, rich, egobody):
    for root in {emdb[0], rich[0], egobody[0]}:
        source = open_truth(root)
        with pytest.raises(EvaluationError, match="has no"):
            source.read("nothing_cam_00")
        with pytest.raises(EvaluationError, match="no split"):
            source.ids("somewhere")


def test_a_benchmark_file_that_wants_to_run_code_is_refused(emdb):
    root, _ = emdb

    class Attack:
        def __reduce__(self):
            return (print, ("no",))

    path = root / "P0" / "09_walk" / "P0_09_walk_data.pkl"
    path.write_bytes(pickle.dumps({"smpl": Attack()}))
    with pytest.raises(EvaluationError, match="not plain data"):
        open_truth(root).read("P0_09_walk")


def test_folders_of_no_known_kind(tmp_path, dataset):
    with pytest.raises(EvaluationError, match="neither a dataset"):
        open_truth(tmp_path)
    with pytest.raises(EvaluationError, match="not a folder"):
        open_truth(tmp_path / "nothing")
    with pytest.raises(EvaluationError, match="no ground truth of kind"):
        open_truth(tmp_path, "coco")
    assert open_truth(dataset, "whacamole").name == "whacamole"


def test_the_projects_own_labels(dataset, scenes):
    source = open_truth(dataset)
    assert source.ids("test") == source.ids("all") == ["made-0", "made-1", "made-2"]
    truth = source.read("made-1")
    assert truth.num_frames == 50
    assert (truth.shots[0], truth.shots[-1], truth.source) == ("arc", "tracking", "made")
    np.testing.assert_array_equal(truth.joints["world"], scenes[1].people["joints_world"])
    assert truth.contact.part_names == ("left_foot", "right_foot")
    with pytest.raises(EvaluationError, match=r"train\.txt"):
        source.ids("train")


def test_labels_that_are_broken_are_named(dataset, tmp_path):
    import shutil

    root = shutil.copytree(dataset, tmp_path / "copy")
    (root / "sequences" / "made-0" / "shot.json").write_text("{", encoding="utf-8")
    with pytest.raises(EvaluationError, match=r"shot\.json: not readable as JSON"):
        open_truth(root).read("made-0")
    (root / "sequences" / "made-1" / "people.npz").unlink()
    with pytest.raises(EvaluationError, match=r"people\.npz: not there"):
        open_truth(root).read("made-1")
    (root / "splits" / "test.txt").write_text("", encoding="utf-8")
    with pytest.raises(EvaluationError, match="has no sequence"):
        open_truth(root).ids("test")
