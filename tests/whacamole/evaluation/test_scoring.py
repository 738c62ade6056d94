"""Whole sequences scored: identity, known changes, and everything that can be missing."""

from dataclasses import replace

import numpy as np
import pytest

from whacamole.evaluation import (
    METRICS,
    PROTOCOLS,
    Bodies,
    EvaluationError,
    GroundContact,
    Placement,
    Recording,
    pooled,
    score_recording,
)
from whacamole.evaluation.io.native import read_native
from whacamole.evaluation.truth.dataset import DatasetTruth

FEW = Bodies(vertices=300)
NONE = Bodies(vertices=False)


@pytest.fixture(scope="module")
def truth(dataset) -> Recording:
    return DatasetTruth(dataset).read("made-0")


@pytest.fixture(scope="module")
def source(scenes, make, tmp_path_factory):
    """Recordings of predictions of the first scene, made with the keywords given."""
    folder = tmp_path_factory.mktemp("predictions")

    def predict(**options) -> Recording:
        make["predictions"](folder, {"made-0": make["prediction"](scenes[0], **options)})
        return read_native(folder / "made-0.npz", "made-0", 30.0)

    return predict


def value(score, key):
    return pooled([score], key)


def changed(recording: Recording, i: int, **changes) -> Recording:
    people = list(recording.people)
    people[i] = replace(people[i], **changes)
    return replace(recording, people=tuple(people))


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_the_truth_is_a_perfect_prediction_in_every_protocol(truth, source, protocol):
    given = replace(PROTOCOLS[protocol], smooth_root=0.0)
    score = score_recording(truth, source(), given, FEW)
    descriptions = {"jitter", "foot_sliding"}
    for key in score.values:
        perfect = {"higher": 1.0, "one": 1.0, "lower": 0.0}[METRICS[key].better]
        if key not in descriptions and np.isfinite(value(score, key)):
            assert value(score, key) == pytest.approx(perfect, abs=2e-3), key
    expected = {
        "mpjpe", "pa_mpjpe", "t_mpjpe", "pve", "pa_pve", "t_pve", "pve_hands", "pve_face", "mpjae", "accel",
        "h_ate", "h_as", "rte", "erve", "c_ate", "c_as", "c_rpe_t", "c_rpe_r", "pair_pa_mpjpe", "sw_offset",
        "jitter", "foot_sliding", "foot_f1",
    }  # fmt: skip
    assert expected <= score.values.keys()
    assert score.counts["people_matched"] == 2
    assert score.counts["person_frames_scored"] == 80


def test_the_truth_against_itself_needs_no_prediction_file(truth):
    score = score_recording(truth, truth, "whac", NONE)
    assert value(score, "w_mpjpe") == pytest.approx(0.0, abs=1e-6)
    assert value(score, "ground_f1") == 1.0
    assert "pve" not in score.values


def test_a_wrong_scale_of_the_world_is_undone_where_it_should_be(truth, source):
    score = score_recording(truth, source(scale=1.25), "whac", NONE)
    assert value(score, "h_as") == pytest.approx(0.8, rel=1e-3)
    assert value(score, "c_as") == pytest.approx(0.8, rel=1e-6)
    assert value(score, "c_ate") == pytest.approx(0.0, abs=1e-4)
    assert value(score, "c_ate_rigid") > 50.0
    assert value(score, "sw_mpjpe") > 100.0
    assert value(score, "mpjpe") == pytest.approx(0.0, abs=1e-6)


def test_a_turned_and_shifted_world_changes_no_aligned_metric(truth, source):
    from scipy.spatial.transform import Rotation

    prediction = source(noise=0.02)
    R, t = Rotation.from_euler("xyz", [0.5, -1.0, 2.0]), np.array([3.0, -2.0, 7.0])
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R.as_matrix(), t
    people = []
    for person in prediction.people:
        j0 = _rest_pelvis(person.betas)
        transl = R.apply(person.world.transl + j0) + t - j0
        turned = (R * Rotation.from_rotvec(person.world.orient)).as_rotvec()
        people.append(replace(person, world=Placement(turned, transl)))
    camera = replace(prediction.camera, T_world_camera=T @ prediction.camera.T_world_camera)
    other = replace(prediction, people=tuple(people), camera=camera)
    a, b = (score_recording(truth, p, "whac", NONE) for p in (prediction, other))
    for key in a.values:
        assert value(b, key) == pytest.approx(value(a, key), rel=1e-6, abs=1e-6), key


def _rest_pelvis(betas):
    from whacamole.body import BodyModel

    return BodyModel.embedded().rest_joints(betas)[0]


def test_a_taller_body_is_seen_by_mpjpe_and_forgiven_by_pa(truth, source):
    prediction = source()
    tall = replace(prediction, people=tuple(replace(p, betas=p.betas + 1.0) for p in prediction.people))
    score = score_recording(truth, tall, "whac", NONE)
    assert value(score, "mpjpe") > value(score, "pa_mpjpe") > 0.0


def test_tracks_are_matched_whatever_their_order_and_names(truth, source):
    prediction = source(noise=0.01)
    swapped = replace(
        prediction, people=tuple(replace(p, track_id=50 + p.track_id) for p in prediction.people[::-1])
    )
    a, b = (score_recording(truth, p, "whac", NONE) for p in (prediction, swapped))
    assert value(a, "mpjpe") == pytest.approx(value(b, "mpjpe"))
    assert [(m[0], m[1]) for m in b.matches] == [(1, 51), (2, 52)]


def test_a_missing_person_is_counted_and_the_other_scored(truth, source):
    prediction = source()
    score = score_recording(truth, replace(prediction, people=prediction.people[1:]), "whac", NONE)
    assert score.counts["people_missing"] == 1
    assert score.counts["person_frames_missing"] == 40
    assert np.isfinite(score.values["mpjpe"]).sum(axis=1).tolist() == [0, 40]
    assert "pair_pa_mpjpe" not in score.values


def test_an_extra_track_is_counted_and_does_no_harm(truth, source):
    prediction = source()
    ghost = replace(
        prediction.people[0],
        track_id=9,
        camera=Placement(
            prediction.people[0].camera.orient, prediction.people[0].camera.transl + np.array([3.0, 0.0, 0.0])
        ),
    )
    score = score_recording(truth, replace(prediction, people=(ghost, *prediction.people)), "whac", NONE)
    assert score.counts["tracks_extra"] == 1
    assert value(score, "mpjpe") == pytest.approx(0.0, abs=1e-6)


def test_a_track_of_somebody_else_is_no_match(truth, source):
    prediction = source()
    far = prediction.people[0].camera.transl + np.array([4.0, 0.0, 0.0])
    alone = replace(prediction, people=prediction.people[:1])
    off = changed(alone, 0, camera=Placement(prediction.people[0].camera.orient, far))
    score = score_recording(truth, off, "whac", NONE)
    assert score.counts["people_matched"] == 0
    assert score.counts["tracks_extra"] == 1
    assert value(score, "c_ate") == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(("protocol", "accel"), [("whac", 36), ("gvhmr", 37)])
def test_missing_frames_leave_a_gap_or_close_up_as_the_protocol_says(truth, source, protocol, accel):
    prediction = source(noise=0.01)
    keep = np.ones(40, bool)
    keep[20] = False
    holed = changed(prediction, 0, valid=keep)
    score = score_recording(truth, holed, protocol, NONE)
    assert score.counts["person_frames_missing"] == 1
    assert np.isfinite(score.values["mpjpe"][0]).sum() == 39
    assert np.isfinite(score.values["accel"][0]).sum() == accel - (protocol == "whac")


def test_nan_rows_are_counted_and_left_out(truth, source):
    prediction = source()
    pose = np.array(prediction.people[1].body_pose)
    pose[3:6] = np.nan
    score = score_recording(truth, changed(prediction, 1, body_pose=pose), "whac", FEW)
    assert score.counts["person_frames_nan"] == 3
    assert score.counts["person_frames_missing"] == 3
    assert np.isnan(score.values["pve"][1, 3:6]).all()
    assert value(score, "pve") == pytest.approx(0.0, abs=1e-2)


def test_frames_of_the_truth_that_do_not_count_are_no_loss(truth, source):
    out_of_view = np.ones(40, bool)
    out_of_view[:10] = False
    score = score_recording(changed(truth, 0, valid=out_of_view), source(), "whac", NONE)
    assert score.counts["person_frames"] == 70
    assert score.counts["person_frames_missing"] == 0


def test_a_prediction_of_part_of_the_frames(truth, source, scenes, make, tmp_path):
    arrays = make["prediction"](scenes[0])
    short = {k: v[:, 5:25] if np.shape(v)[:2] == (2, 40) else v for k, v in arrays.items()}
    short |= {k: arrays[k][5:25] for k in ("frame_index", "T_world_camera", "K")}
    make["predictions"](tmp_path, {"made-0": short})
    score = score_recording(truth, read_native(tmp_path / "made-0.npz", "made-0", 30.0), "whac", NONE)
    assert score.counts["person_frames_scored"] == 40
    assert np.flatnonzero(np.isfinite(score.values["mpjpe"][0])).tolist() == list(range(5, 25))
    other = replace(read_native(tmp_path / "made-0.npz", "made-0", 30.0), frame_index=np.arange(100, 120))
    with pytest.raises(
        EvaluationError, match="no common frames: truth and prediction have 0 … 39 and 100 … 119"
    ):
        score_recording(truth, other, "whac", NONE)


def test_a_static_camera_and_static_people_have_no_scale_and_are_counted(make, tmp_path):
    scene = make["scene"]("still", frames=12, static_camera=True, still_people=True)
    root = make["dataset"](tmp_path / "d", [scene])
    make["predictions"](tmp_path / "p", {"still": make["prediction"](scene, noise=0.001)})
    still = DatasetTruth(root).read("still")
    score = score_recording(still, read_native(tmp_path / "p" / "still.npz", "still", 30.0), "whac", NONE)
    assert score.counts["cameras_static"] == 1
    assert score.counts["people_static"] == 2
    for key in ("c_ate", "c_as", "h_ate", "h_as", "rte"):
        assert key not in score.values
    for key in ("c_rpe_t", "w_mpjpe", "sw_mpjpe", "mpjpe"):
        assert np.isfinite(value(score, key)), key
    assert {"truth/camera", "prediction/camera", "prediction/person/0"} <= score.paths.keys()


def test_one_frame_is_scored_and_counted_short(make, tmp_path):
    scene = make["scene"]("blink", frames=1)
    root = make["dataset"](tmp_path / "d", [scene])
    make["predictions"](tmp_path / "p", {"blink": make["prediction"](scene, noise=0.01)})
    blink, guess = DatasetTruth(root).read("blink"), read_native(tmp_path / "p" / "blink.npz", "blink", 30.0)
    score = score_recording(blink, guess, "whac", FEW)
    assert score.counts["segments_short"] == 2
    assert value(score, "mpjpe") > 0
    assert np.isnan(value(score, "accel"))
    tram = score_recording(blink, guess, "tram", NONE)
    assert tram.counts["people_without_segment"] == 2
    assert np.isnan(value(tram, "w_mpjpe"))


def test_without_a_camera_the_scene_is_not_scored_and_said_so(truth, source):
    score = score_recording(truth, replace(source(), camera=None), "whac", NONE)
    assert score.counts["cameras_missing"] == 1
    assert "c_ate" not in score.values
    assert any("no shared-world metrics" in note for note in score.notes)


def test_a_prediction_in_the_world_alone_and_in_the_camera_alone(truth, source):
    prediction = source(noise=0.01)
    world = replace(prediction, people=tuple(replace(p, camera=None) for p in prediction.people), camera=None)
    camera = replace(prediction, people=tuple(replace(p, world=None) for p in prediction.people), camera=None)
    a, b = (score_recording(truth, p, "whac", FEW) for p in (world, camera))
    assert "w_mpjpe" in a.values
    assert "mpjpe" not in a.values
    assert any("no camera-frame metrics" in note for note in a.notes)
    assert "mpjpe" in b.values
    assert "w_mpjpe" not in b.values
    assert any("no world metrics" in note for note in b.notes)
    assert value(a, "pa_mpjpe") == pytest.approx(value(b, "pa_mpjpe"), rel=1e-6)
    assert value(a, "pa_pve") == pytest.approx(value(b, "pa_pve"), rel=1e-3)


def test_a_camera_alone_is_scored_as_a_camera(truth, source):
    score = score_recording(truth, replace(source(noise=0.01), people=()), "whac", NONE)
    assert value(score, "c_ate") > 0
    assert score.counts["people_missing"] == 2


def test_labelled_contact_is_compared_by_the_names_of_parts(truth, source):
    flipped = GroundContact(("right_foot", "left_foot"), truth.contact.touching[..., ::-1])
    score = score_recording(truth, replace(source(), contact=flipped), "whac", NONE)
    assert value(score, "ground_f1") == 1.0
    other = GroundContact(("hand",), truth.contact.touching[..., :1])
    score = score_recording(truth, replace(source(), contact=other), "whac", NONE)
    assert "ground_f1" not in score.values
    assert any("no part alike" in note for note in score.notes)


def test_smoothing_and_mean_shapes_are_of_the_prediction_only(truth, source):
    prediction = source(noise=0.02)
    rough = score_recording(truth, prediction, replace(PROTOCOLS["whac"], smooth_root=0.0), NONE)
    smooth = score_recording(truth, prediction, replace(PROTOCOLS["whac"], smooth_root=3.0), NONE)
    assert value(smooth, "erve") < 0.9 * value(rough, "erve")
    assert value(smooth, "mpjpe") == value(rough, "mpjpe")
