"""Outputs of other methods, written in their own schemas by the tests, score as what they are made from."""

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from whacamole.evaluation import (
    FORMATS,
    Bodies,
    CameraTrack,
    EvaluationError,
    PersonTrack,
    Placement,
    PredictionFolder,
    Recording,
    evaluate,
    pooled,
    score_recording,
)
from whacamole.evaluation.figure import Figure
from whacamole.evaluation.library import BodyLibrary

joblib, torch = pytest.importorskip("joblib"), pytest.importorskip("torch")

T = 30


def value(score, key):
    return pooled([score], key)


@pytest.fixture(scope="module")
def library(models):
    return BodyLibrary([models])


def make_truth(kind, library, scenes, seed=0):
    """Two people of a kind of body in front of the first scene's camera, placed in both spaces."""
    rng = np.random.default_rng(seed)
    camera = CameraTrack(scenes[0].camera["T_world_camera"][:T], np.ones(T, bool), scenes[0].camera["K"][:T])
    joints = 23 if kind == "smpl" else 21
    people = []
    for i in range(2):
        walk = np.cumsum(0.02 * rng.normal(size=(T, 3)), axis=0)
        upright = Rotation.from_euler("xz", [90, 30 * i], degrees=True)
        orient = (
            Rotation.from_rotvec(np.cumsum(0.02 * rng.normal(size=(T, 3)), axis=0)) * upright
        ).as_rotvec()
        body_pose = 0.2 * rng.normal(size=(1, joints, 3)) + 0.02 * rng.normal(size=(T, joints, 3))
        person = PersonTrack(
            track_id=i, kind=kind, betas=rng.normal(size=10), body_pose=body_pose, valid=np.ones(T, bool),
            world=Placement(orient, walk + np.array([0.0, 1.5 * i - 0.7, 1.0])),
        )  # fmt: skip
        figure = Figure(person, library.body_of(person), camera)
        turned, pelvis = figure.root("camera")
        j0 = library.body_of(person).rest_pelvis(person.betas)
        seen = Placement(Rotation.from_matrix(turned).as_rotvec(), pelvis - j0)
        people.append(replace(person, camera=seen))
    return Recording("seq", np.arange(T), 30.0, tuple(people), camera)


def read(folder, form="auto", fps=30.0):
    return PredictionFolder(folder, form).read("seq", fps)


def assert_perfect(truth, prediction, models, keys, protocol="whac"):
    score = score_recording(truth, prediction, protocol, Bodies(files=(models,)))
    for key in keys:
        limit = 0.05 if "pve" in key else 2e-2  # files in float32
        assert value(score, key) == pytest.approx(0.0, abs=limit), (key, score.notes)
    return score


CAMERA = ("mpjpe", "pa_mpjpe", "t_mpjpe", "pve", "pa_pve", "mpjae")
WORLD = ("w_mpjpe", "wa_mpjpe", "w_mpjpe_rigid", "h_ate", "rte", "erve")
FILM = ("c_ate", "c_ate_rigid", "c_rpe_t", "sw_mpjpe", "sw_camera", "sw_offset")


def full_pose(person, space):
    placement = getattr(person, space)
    return np.concatenate([placement.orient, person.body_pose.reshape(T, -1)], axis=1).astype("f4")


@pytest.fixture
def wham(tmp_path, library, scenes):
    truth = make_truth("smpl", library, scenes)
    rows = [np.arange(T), np.arange(5, T)]
    tracks = {
        float(i): {
            "pose": full_pose(p, "camera")[at], "trans": p.camera.transl[at].astype("f4"),
            "pose_world": full_pose(p, "world")[at], "trans_world": p.world.transl[at].astype("f4"),
            "betas": np.tile(p.betas, (len(at), 1)).astype("f4"), "verts": np.zeros((2, 3), "f4"),
            "frame_ids": at,
        }
        for i, (p, at) in enumerate(zip(truth.people, rows, strict=True))
    }  # fmt: skip
    (tmp_path / "seq").mkdir()
    joblib.dump(tracks, tmp_path / "seq" / "wham_output.pkl")
    return truth, tmp_path


@pytest.mark.parametrize("protocol", ["whac", "wham"])
def test_wham(wham, models, protocol):
    truth, folder = wham
    prediction = read(folder)
    assert prediction.method == "WHAM"
    score = assert_perfect(truth, prediction, models, (*CAMERA, *WORLD), protocol)
    assert score.counts["person_frames_missing"] == 5
    assert score.counts["cameras_missing"] == 1
    assert "c_ate" not in score.values


def test_tram(tmp_path, library, scenes, models):
    truth = make_truth("smpl", library, scenes)
    folder = tmp_path / "seq"
    (folder / "hps").mkdir(parents=True)
    camera = {
        "pred_cam_R": truth.camera.T_world_camera[:, :3, :3],
        "pred_cam_T": truth.camera.T_world_camera[:, :3, 3],
        "img_focal": 500.0, "img_center": np.array([320.0, 180.0]),
    }  # fmt: skip
    np.save(folder / "camera.npy", camera, allow_pickle=True)
    for i, person in enumerate(truth.people):
        pose = full_pose(person, "camera").reshape(-1, 3)
        track = {
            "pred_rotmat": torch.tensor(Rotation.from_rotvec(pose).as_matrix().reshape(T, 24, 3, 3)).float(),
            "pred_shape": torch.tensor(np.tile(person.betas, (T, 1))).float(),
            "pred_trans": torch.tensor(person.camera.transl[:, None]).float(),
            "pred_cam": torch.zeros(T, 3), "frame": torch.arange(T),
        }  # fmt: skip
        np.save(folder / "hps" / f"hps_track_{i}.npy", track, allow_pickle=True)
    prediction = read(tmp_path)
    assert prediction.method == "TRAM"
    np.testing.assert_allclose(prediction.camera.K, truth.camera.K)
    assert_perfect(truth, prediction, models, (*CAMERA, *WORLD, *FILM))


def test_gvhmr(tmp_path, library, scenes, models):
    truth = make_truth("smplx", library, scenes)
    person = truth.people[1]

    def params(space):
        placement = getattr(person, space)
        arrays = {
            "body_pose": person.body_pose.reshape(T, 63), "betas": np.tile(person.betas, (T, 1)),
            "global_orient": placement.orient, "transl": placement.transl,
        }  # fmt: skip
        return {key: torch.tensor(array).float() for key, array in arrays.items()}

    result = {
        "smpl_params_global": params("world"), "smpl_params_incam": params("camera"),
        "K_fullimg": torch.tensor(truth.camera.K), "net_outputs": {"logits": torch.zeros(1, T, 6)},
    }  # fmt: skip
    (tmp_path / "seq").mkdir()
    torch.save(result, tmp_path / "seq" / "hmr4d_results.pt")
    prediction = read(tmp_path)
    assert prediction.method == "GVHMR"
    score = assert_perfect(truth, prediction, models, (*CAMERA, *WORLD), "gvhmr")
    assert score.counts["people_missing"] == 1
    assert score.matches[0][0] == 1


def test_slahmr(tmp_path, library, scenes, models):
    truth = make_truth("smplh", library, scenes)
    folder = tmp_path / "seq" / "motion_chunks"
    folder.mkdir(parents=True)
    T_camera_world = np.linalg.inv(truth.camera.T_world_camera)
    arrays = {
        "trans": np.stack([p.world.transl for p in truth.people]),
        "root_orient": np.stack([p.world.orient for p in truth.people]),
        "pose_body": np.stack([p.body_pose.reshape(T, 63) for p in truth.people]),
        "betas": np.stack([np.pad(p.betas, (0, 6)) for p in truth.people]),
        "cam_R": np.tile(T_camera_world[:, :3, :3], (2, 1, 1, 1)),
        "cam_t": np.tile(T_camera_world[:, :3, 3], (2, 1, 1)),
        "intrins": np.array([500.0, 500.0, 320.0, 180.0]),
    }
    for iteration, wrong in ((20, 1.0), (140, 0.0)):
        shifted = arrays | {"trans": arrays["trans"] + wrong}
        np.savez(folder / f"seq_{iteration:06d}_world_results.npz", **shifted)
    seen = [[False, False, *([True] * T)], [False, False, *([True] * (T - 4)), *([False] * 4)]]
    info = {
        "tracks": {str(7 + i): {"index": i, "vis_mask": mask} for i, mask in enumerate(seen)},
        "meta": {"seq_interval": [0, -1], "data_interval": [0, T + 2]},
    }
    (tmp_path / "seq" / "track_info.json").write_text(json.dumps(info), encoding="utf-8")
    prediction = read(tmp_path)
    assert prediction.method == "SLAHMR"
    assert prediction.frame_index[0] == 2
    late = replace(
        truth, frame_index=truth.frame_index + 2
    )  # by position the truth counts from 0: shift the rows
    prediction = replace(prediction, by_position=False)
    score = assert_perfect(late, prediction, models, (*CAMERA, *WORLD, *FILM))
    assert score.counts["person_frames_missing"] == 4
    assert {match[1] for match in score.matches} == {7, 8}


def test_prompthmr(tmp_path, library, scenes, models):
    truth = make_truth("smplx", library, scenes)
    world = truth.camera.T_world_camera
    people = {}
    for i, person in enumerate(truth.people):
        pose, betas = np.zeros((T, 165)), np.tile(person.betas, (T, 1))
        pose[:, :66] = full_pose(person, "world")
        seen = np.tile(np.eye(3), (T, 55, 1, 1))
        seen[:, 0] = Rotation.from_rotvec(person.camera.orient).as_matrix()
        people[i + 1] = {
            "frames": np.arange(T), "track_id": i + 1,
            "smplx_world": {"pose": pose, "shape": betas, "trans": person.world.transl},
            "smplx_cam": {"rotmat": seen, "trans": person.camera.transl, "shape": betas},
        }  # fmt: skip
    result = {
        "people": people, "has_slam": True, "timings": {},
        "camera_world": {
            "Rwc": world[:, :3, :3], "Twc": world[:, :3, 3], "img_focal": np.float32(500.0),
            "img_center": np.array([320.0, 180.0]),
        },
    }  # fmt: skip
    (tmp_path / "seq").mkdir()
    joblib.dump(result, tmp_path / "seq" / "results.pkl")
    prediction = read(tmp_path)
    assert prediction.method == "PromptHMR"
    assert_perfect(truth, prediction, models, (*CAMERA, *WORLD, *FILM))


@pytest.mark.parametrize("whole", [True, False])
def test_tum(tmp_path, library, scenes, whole):
    truth = make_truth("smplx", library, scenes)
    world = truth.camera.T_world_camera
    quaternions = Rotation.from_matrix(world[:, :3, :3]).as_quat()
    times = np.arange(T) if whole else np.arange(T) / 30.0
    lines = ["# time tx ty tz qx qy qz qw", ""]
    lines += [
        " ".join(f"{x:.9g}" for x in (t, *c, *q))
        for t, c, q in zip(times, world[:, :3, 3], quaternions, strict=True)
    ]
    (tmp_path / "seq.txt").write_text("\n".join(lines), encoding="utf-8")
    prediction = read(tmp_path)
    score = score_recording(truth, prediction, "whac", Bodies(vertices=False))
    assert value(score, "c_ate") == pytest.approx(0.0, abs=1e-4)
    assert value(score, "c_as") == pytest.approx(1.0, abs=1e-6)
    assert any(("frame numbers" if whole else "seconds") in note for note in score.notes)


def test_frames_are_counted_in_the_video_and_meet_any_numbering(wham, models):
    truth, folder = wham
    numbered = replace(truth, frame_index=np.arange(T) + 1888)
    assert_perfect(numbered, read(folder), models, CAMERA)


BROKEN = {
    "seq/wham_output.pkl": (lambda p: joblib.dump([1, 2], p), "holds no tracks"),
    "seq/hmr4d_results.pt": (lambda p: torch.save({"x": 1}, p), "smpl_params_global"),
    "seq/results.pkl": (lambda p: joblib.dump({"people": {}}, p), "camera_world"),
    "seq/camera.npy": (lambda p: np.save(p, np.zeros(3)), "no dictionary"),
    "seq/motion_chunks/a_000001_world_results.npz": (lambda p: np.savez(p, x=1), "'trans'"),
    "seq.txt": (lambda p: p.write_text("1 2 3\n"), "line 1 is not"),
    "seq.npz": (lambda p: p.write_bytes(b"PK\x03\x04garbage"), "damaged"),
}


@pytest.mark.parametrize("place", BROKEN)
def test_what_is_broken_is_said_in_one_line(tmp_path, place):
    write, said = BROKEN[place]
    path = tmp_path / place
    path.parent.mkdir(parents=True, exist_ok=True)
    write(path)
    with pytest.raises(EvaluationError, match=said) as excinfo:
        read(tmp_path)
    assert "\n" not in str(excinfo.value)
    assert str(tmp_path) in str(excinfo.value)


NATIVE = {
    "no frame_index": (lambda a: a.pop("frame_index"), "'frame_index'"),
    "frames in disorder": (lambda a: a.update(frame_index=np.arange(40)[::-1]), "ascend"),
    "betas of another size": (lambda a: a.update(betas=np.zeros((2, 9))), "expected 2×10 or 2×40×10"),
    "a pose of other frames": (lambda a: a.update(body_pose=np.zeros((2, 7, 21, 3))), "is 2×7×21×3"),
    "words": (lambda a: a.update(betas=np.array([["a"] * 10] * 2)), "holds no numbers"),
    "no placement": (
        lambda a: [a.pop(f"{n}_{s}") for n in ("transl", "global_orient") for s in ("world", "camera")],
        "no global_orient_world",
    ),
    "half a placement": (lambda a: a.pop("transl_world"), "'transl_world'"),
    "nothing": (lambda a: [a.pop(key) for key in ("body_pose", "T_world_camera")], "neither people"),
}  # fmt: skip


@pytest.mark.parametrize("what", NATIVE)
def test_native_files_with_a_fault(tmp_path, scenes, make, what):
    change, said = NATIVE[what]
    arrays = make["prediction"](scenes[0])
    change(arrays)
    make["predictions"](tmp_path, {"seq": arrays})
    with pytest.raises(EvaluationError, match=said) as excinfo:
        read(tmp_path)
    assert "\n" not in str(excinfo.value)


def test_pickles_inside_npz_are_refused(tmp_path):
    np.savez(tmp_path / "seq.npz", frame_index=np.array([{}], dtype=object))
    with pytest.raises(EvaluationError, match="Python objects"):
        read(tmp_path)


def test_a_missing_prediction_says_where_it_was_looked_for(tmp_path):
    with pytest.raises(
        EvaluationError, match=r"no prediction for seq \(looked for seq\.npz, seq/wham_output\.pkl"
    ):
        read(tmp_path)
    with pytest.raises(EvaluationError, match=r"looked for seq/hmr4d_results\.pt\)"):
        read(tmp_path, "gvhmr")
    with pytest.raises(EvaluationError, match="no prediction format"):
        read(tmp_path, "nobody")
    with pytest.raises(EvaluationError, match="not a folder"):
        read(tmp_path / "nowhere")


def test_betas_a_frame_are_taken_as_such(tmp_path, scenes, make):
    arrays = make["prediction"](scenes[0])
    arrays["betas"] = np.repeat(arrays["betas"][:, None], 40, axis=1)
    make["predictions"](tmp_path, {"seq": arrays})
    assert read(tmp_path).people[0].betas.shape == (40, 10)


def test_every_format_has_a_name_and_a_place():
    assert list(FORMATS) == ["native", "wham", "gvhmr", "prompthmr", "tram", "slahmr", "tum"]


FAULTS = {
    "nothing": lambda a: a[..., :0],
    "nan": lambda a: np.full(a.shape, np.nan),
    "zero": np.zeros_like,
    "huge": lambda a: np.full(a.shape, 1e300),
    "negative": lambda a: np.full(a.shape, -7.0),
    "words": lambda a: np.full(a.shape, "x"),
    "fewer rows": lambda a: a[:-1],
}


@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.filterwarnings("error")
def test_no_array_of_a_native_file_can_stop_the_rest(tmp_path, scenes, make, dataset, fault):
    good = make["prediction"](scenes[0], noise=0.01)
    for key, array in good.items():
        if np.ndim(array) and np.asarray(array).dtype.kind in "fiu":
            bad = {**good, key: FAULTS[fault](np.asarray(array))}
            folder = make["predictions"](tmp_path / key, {scenes[0].id: bad, scenes[1].id: good})
            result = evaluate(dataset, folder, bodies=Bodies(vertices=False))
            method = result.methods[0]
            assert scenes[1].id in method.sequences, key
            assert not any("\n" in line or " failed (" in line for line in method.failures.values()), (
                key, method.failures,
            )  # fmt: skip


def test_what_nobody_foresaw_costs_one_sequence(tmp_path, scenes, make, dataset, monkeypatch):
    folder = make["predictions"](tmp_path, {s.id: make["prediction"](s) for s in scenes})
    usual = PredictionFolder.read

    def read(self, sequence_id, fps):
        if sequence_id == scenes[0].id:
            raise AttributeError("no\nsuch thing")
        return usual(self, sequence_id, fps)

    monkeypatch.setattr(PredictionFolder, "read", read)
    method = evaluate(dataset, folder, bodies=Bodies(vertices=False)).methods[0]
    assert method.failures == {
        scenes[0].id: "prediction failed (AttributeError: no such thing); check the arrays of its files"
    }
    assert len(method.sequences) == len(scenes) - 1
