"""The shared-world metric: what it must forgive, and what it alone sees."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from whacamole.evaluation.core.shared import shared_world_error
from whacamole.evaluation.core.world import segment_error

ALL = [np.arange(20)]


def scene(seed, people=2, frames=20, joints=15):
    rng = np.random.default_rng(seed)
    bodies = rng.normal(size=(people, 1, joints, 3)) + np.cumsum(
        0.1 * rng.normal(size=(people, frames, 1, 3)), 1
    )
    return bodies + 3 * rng.normal(size=(people, 1, 1, 3)), np.cumsum(
        0.1 * rng.normal(size=(frames, 3)), axis=0
    )


def score(prediction, truth, rows=ALL, present=None, **options):
    (bodies, camera), (true_bodies, true_camera) = prediction, truth
    here = present or (np.ones(true_bodies.shape[:2], bool), np.ones(len(true_camera), bool))
    return shared_world_error(
        (bodies, true_bodies),
        (bodies[:, :, 0], true_bodies[:, :, 0]),
        (camera, true_camera),
        here,
        rows,
        **options,
    )


def motion(seed, scale=1.0):
    rng = np.random.default_rng(seed)
    R, t = Rotation.random(random_state=rng).as_matrix(), rng.normal(size=3)
    return lambda x: scale * x @ R.T + t


@settings(max_examples=25, deadline=None, derandomize=True)
@given(st.integers(0, 2**32 - 1))
def test_one_rigid_motion_of_everything_is_forgiven_but_no_scale(seed):
    truth = scene(seed)
    move, grow = motion(seed), motion(seed, 1.2)
    same = score((move(truth[0]), move(truth[1])), truth)
    np.testing.assert_allclose(same.people, 0.0, atol=1e-8)
    np.testing.assert_allclose(same.camera, 0.0, atol=1e-8)
    np.testing.assert_allclose(same.offset, 0.0, atol=1e-8)
    grown = (grow(truth[0]), grow(truth[1]))
    assert score(grown, truth).people.mean() > 10.0
    np.testing.assert_allclose(score(grown, truth, with_scale=True).people, 0.0, atol=1e-7)


def test_two_people_in_different_rooms_look_perfect_alone_and_wrong_together():
    bodies, camera = scene(0)
    apart = bodies.copy()
    apart[1] += [2.0, 0.0, 0.0]
    for person in range(2):
        alone = segment_error(apart[person], bodies[person], ALL, fit_frames=None, with_scale=False)
        np.testing.assert_allclose(alone, 0.0, atol=1e-9)
    assert score((apart, camera), (bodies, camera)).people.mean() > 300.0


def test_an_offset_along_the_line_they_all_stand_on_is_shared_by_thirds():
    """On a line no turn can help: the fit is the mean shift, a third of the second person's."""
    rng = np.random.default_rng(1)
    bodies, camera = np.zeros((2, 20, 15, 3)), np.zeros((20, 3))
    bodies[..., 0] = rng.normal(size=(2, 20, 15)) + np.array([-3.0, 3.0])[:, None, None]
    camera[:, 0] = rng.normal(size=20)
    shifted = bodies.copy()
    shifted[1, ..., 0] += 0.9
    found = score((shifted, camera), (bodies, camera))
    np.testing.assert_allclose(found.people[0], 300.0)
    np.testing.assert_allclose(found.people[1], 600.0)
    np.testing.assert_allclose(found.camera, 300.0)
    np.testing.assert_allclose(found.offset, (900.0 + 0.0 + 900.0) / 3)


def test_the_number_of_joints_does_not_decide_who_weighs_more():
    bodies, camera = scene(2, joints=10)
    shifted = bodies.copy()
    shifted[0] += [0.3, 0.0, 0.0]
    few = score((shifted, camera), (bodies, camera))
    doubled = np.repeat(bodies, 2, axis=2), np.repeat(shifted, 2, axis=2)
    many = score((doubled[1], camera), (doubled[0], camera))
    np.testing.assert_allclose(many.people, few.people, rtol=1e-9)
    np.testing.assert_allclose(many.camera, few.camera, rtol=1e-9)


def test_whoever_is_absent_is_left_out_even_as_nan():
    bodies, camera = scene(3)
    holed = bodies.copy()
    holed[1, 5:10] = np.nan
    gone = camera.copy()
    gone[3] = np.nan
    here = np.ones((2, 20), bool), np.ones(20, bool)
    here[0][1, 5:10] = False
    here[1][3] = False
    found = score((holed, gone), (bodies, camera), present=here)
    np.testing.assert_array_equal(np.isfinite(found.people), here[0])
    np.testing.assert_array_equal(np.isfinite(found.camera), here[1])
    assert np.nanmax(found.people) == pytest.approx(0.0, abs=1e-9)


def test_segments_are_aligned_apart():
    truth = scene(4)
    bodies, camera = truth[0].copy(), truth[1].copy()
    move = motion(9)
    bodies[:, 10:], camera[10:] = move(bodies[:, 10:]), move(camera[10:])
    two = score((bodies, camera), truth, rows=[np.arange(10), np.arange(10, 20)])
    np.testing.assert_allclose(two.people, 0.0, atol=1e-8)
    assert score((bodies, camera), truth).people.mean() > 1.0


def test_one_person_without_a_camera_has_no_offset():
    bodies, camera = scene(5, people=1)
    here = np.ones((1, 20), bool), np.zeros(20, bool)
    found = score((bodies, camera), (bodies, camera), present=here)
    assert np.isnan(found.offset).all()
    np.testing.assert_allclose(found.people, 0.0, atol=1e-9)
    nobody = score((bodies, camera), (bodies, camera), present=(here[0] & False, here[1]))
    assert np.isnan(nobody.people).all()
