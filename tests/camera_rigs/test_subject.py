"""`SubjectTrack`: anchors, facing and boxes of one person and of several."""

import json

import numpy as np
import pytest

from camera_rigs import PlanError, SubjectTrack


def test_the_anchor_loses_the_bounce_and_keeps_the_walk(rig):
    subject = rig.walker(120, bounce=0.05)
    middle = slice(40, -40)
    assert np.ptp(subject.pelvis[middle, 2]) > 0.09
    assert np.ptp(subject.smooth_pelvis[middle, 2]) < 0.002
    np.testing.assert_allclose(subject.smooth_pelvis[:, 0], subject.pelvis[:, 0], atol=1e-9)
    assert subject.anchor("neck") is subject.smooth_neck


def test_several_people_are_their_mean(rig):
    subject = rig.subject_of(
        rig.person(np.tile([0.0, 0.0], (5, 1)), 0.0), rig.person(np.tile([2.0, 1.0], (5, 1)), 0.5)
    )
    np.testing.assert_allclose(subject.pelvis[0], [1.0, 0.5, 0.55 * rig.height])
    np.testing.assert_allclose(subject.box_min[0], [-0.3, -0.3, 0.0])
    np.testing.assert_allclose(subject.box_max[0], [2.3, 1.3, rig.height])
    np.testing.assert_allclose(subject.azimuth, 0.25, atol=1e-9)
    assert subject.spread[0] == pytest.approx(np.hypot(1.0, 0.5))


@pytest.mark.parametrize("facings", [(0.0, np.pi), (np.pi, 0.0)])
def test_two_who_face_each_other_or_turn_away_are_seen_side_by_side(rig, facings):
    subject = rig.subject_of(
        rig.person(np.tile([-0.7, 0.0], (60, 1)), facings[0]),
        rig.person(np.tile([0.7, 0.0], (60, 1)), facings[1]),
    )
    assert abs(np.sin(subject.azimuth[0])) == pytest.approx(1.0), "across the line between the two"
    assert np.ptp(subject.azimuth) < 1e-6


def test_a_pair_that_turns_about_itself_is_followed_without_a_flip(rig):
    angle = 0.6 * np.arange(240) / rig.fps
    spot = 0.7 * np.column_stack([np.cos(angle), np.sin(angle)])
    subject = rig.subject_of(rig.person(spot, angle + np.pi), rig.person(-spot, angle))
    assert np.abs(np.diff(subject.azimuth)).max() < 0.03
    assert subject.azimuth[-1] - subject.azimuth[0] == pytest.approx(0.6 * 239 / rig.fps, abs=0.5)


def test_the_height_is_that_of_the_box_and_splits_at_the_anchor(rig):
    subject = rig.stander()
    np.testing.assert_allclose(subject.height, rig.height)
    above, below = subject.extent("pelvis")
    np.testing.assert_allclose((above[0], below[0]), (0.45 * rig.height, 0.55 * rig.height))


def test_someone_who_lies_is_not_framed_as_a_small_object():
    low, high = np.tile([-0.9, -0.3, 0.0], (1, 30, 1)), np.tile([0.9, 0.3, 0.3], (1, 30, 1))
    joint, up = np.tile([0.0, 0.0, 0.15], (1, 30, 1)), np.tile([0.0, 0.0, 1.0], (1, 30, 1))
    subject = SubjectTrack.from_people(joint, joint + np.array([0.5, 0.0, 0.0]), up, low, high, 30.0)
    np.testing.assert_allclose(subject.height, 0.6 * 1.8)
    assert np.isfinite(subject.azimuth).all(), "lying on the back faces nowhere"


def test_the_width_is_the_widest_of_the_seconds_around(rig):
    wide = np.where(np.arange(300) == 150, 1.0, 0.3)[:, None]
    pelvis, neck, facing, low, high = rig.person(np.zeros((300, 2)), 0.0)
    low[:, :2], high[:, :2] = -wide, wide
    subject = rig.subject_of((pelvis, neck, facing, low, high))
    assert subject.span[150 - 80] == pytest.approx(2.0 * np.sqrt(2.0))
    assert subject.span[0] == pytest.approx(0.6 * np.sqrt(2.0))
    assert subject.reach("pelvis")[150] == pytest.approx(np.sqrt(2.0))


def test_the_way_that_people_go(rig):
    subject = rig.walker(90, speed=1.5)
    np.testing.assert_allclose(subject.velocity[:, 0], 1.5)
    np.testing.assert_allclose(subject.travel_azimuth, 0.0, atol=1e-9)
    assert subject.motion_bound(1) == pytest.approx(1.5)
    assert subject.motion_bound(2) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("frames", [1, 2, 5])
def test_the_shortest_clips(rig, frames):
    subject = rig.walker(frames)
    for signal in (subject.smooth_neck, subject.azimuth, subject.height, subject.velocity, subject.span):
        assert len(signal) == frames
        assert np.isfinite(signal).all()


def test_plain_data_and_back_to_the_millimetre(rig):
    subject = rig.dancer(20).rounded()
    back = SubjectTrack.from_json(json.loads(json.dumps(subject.to_json())))
    for name in ("people_pelvis", "people_neck", "people_facing", "people_box_min", "box_max", "facing"):
        np.testing.assert_array_equal(getattr(back, name), getattr(subject, name))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"neck": np.zeros((1, 4, 3))}, "shape"),
        ({"pelvis": np.zeros((0, 5, 3))}, "not empty"),
        ({"facing": np.full((1, 5, 3), np.nan)}, "not finite"),
        ({"fps": 0.0}, "fps is 0.0"),
        ({"box_max": np.full((1, 5, 3), -1.0)}, "exchange"),
    ],
)
def test_bad_arrays_are_refused_in_one_line(change, message):
    arrays = {name: np.zeros((1, 5, 3)) for name in ("pelvis", "neck", "facing", "box_min", "box_max")}
    with pytest.raises(PlanError, match=message) as caught:
        SubjectTrack.from_people(**{**arrays, "fps": 30.0, **change})
    assert "\n" not in str(caught.value)


def test_a_document_without_an_entry_is_refused(rig):
    document = rig.stander(3).to_json()
    del document["neck"]
    with pytest.raises(PlanError, match="neck"):
        SubjectTrack.from_json(document)
