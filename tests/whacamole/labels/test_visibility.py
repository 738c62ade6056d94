"""What is seen of a person: joints, boxes, truncation."""

import numpy as np
import pytest

from whacamole.body import JOINT_INDEX
from whacamole.labels.visibility import (
    OCCLUDED,
    OUTSIDE,
    VISIBLE,
    flesh_thickness,
    joint_visibility,
    seen_box,
    truncation,
    whole_box,
)

K = np.array([[100.0, 0, 50], [0, 100, 40], [0, 0, 1]])
SHAPE = (80, 100)


def state_of(joint, own, depth, thickness=0.1):
    joint = np.array([joint], dtype=float)
    pixel = (joint @ K.T)[:, :2] / joint[:, 2:]
    return joint_visibility(joint, pixel, np.array([thickness]), own, depth)[0]


def test_a_joint_in_the_flesh_is_seen_and_behind_another_is_not():
    own, depth = np.ones(SHAPE, dtype=bool), np.full(SHAPE, 2.0)
    assert state_of([0, 0, 2.09], own, depth) == VISIBLE
    # The person's own arm, 30 cm in front.
    assert state_of([0, 0, 2.3], own, depth) == OCCLUDED
    # Somebody else's pixel, whatever its depth.
    assert state_of([0, 0, 2.05], ~own, depth) == OCCLUDED


@pytest.mark.parametrize(
    "joint", [[0, 0, -1.0], [0, 0, 0], [-1.001, 0, 2], [0.999 + 0.002, 0, 2], [0, 0.81, 2], [0, -0.81, 2]]
)
def test_outside_the_image_or_behind(joint):
    with np.errstate(divide="ignore", invalid="ignore"):
        assert state_of(joint, np.ones(SHAPE, bool), np.full(SHAPE, 2.0)) == OUTSIDE


def test_a_thin_finger_counts_at_any_of_four_pixels():
    own, depth = np.zeros(SHAPE, dtype=bool), np.full(SHAPE, np.inf)
    own[40, 50], depth[40, 50] = True, 2.0
    # Pixel (50, 40) has its centre at (50.5, 40.5).
    for dx, dy, expected in ((0.4, 0.4, VISIBLE), (-0.4, 0.9, VISIBLE), (-0.6, 0.5, OCCLUDED)):
        joint = [(dx) * 2 / 100, (dy) * 2 / 100, 2.0]
        assert state_of(joint, own, depth) == expected


def test_thickness_is_half_the_limb_and_something(model):
    thickness = flesh_thickness(model.rest_vertices(np.zeros(10)), model.rest_joints(np.zeros(10)))
    by_name = {
        name: thickness[JOINT_INDEX[name]] for name in ("pelvis", "left_knee", "left_wrist", "left_index2")
    }
    assert 0.15 < by_name["pelvis"] < 0.35
    assert 0.07 < by_name["left_knee"] < 0.16
    assert 0.05 < by_name["left_wrist"] < 0.1
    assert 0.035 < by_name["left_index2"] < 0.06


def test_boxes():
    surface = np.array([[-1.0, 0, 2], [1, 0.5, 2], [0, 0, -5]])
    np.testing.assert_allclose(whole_box([surface], K), [0, 40, 100, 65])
    np.testing.assert_array_equal(whole_box([surface[2:]], K), np.zeros(4))
    own = np.zeros(SHAPE, dtype=bool)
    np.testing.assert_array_equal(seen_box(own), np.zeros(4))
    own[10:20, 30:31] = True
    np.testing.assert_array_equal(seen_box(own), [30, 10, 31, 20])


def test_truncation_is_a_share_of_the_surface():
    points = np.array([[0, 0, 2.0], [5, 0, 2], [0, 0, -2], [0, 0.3, 2]])
    areas = np.array([1.0, 2, 3, 4])
    assert truncation(points, areas, K, (100, 80)) == pytest.approx(0.5)
    assert truncation(points[[0, 3]], areas[[0, 3]], K, (100, 80)) == 0
    assert truncation(points[[1, 2]], areas[[1, 2]], K, (100, 80)) == 1
