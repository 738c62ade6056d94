"""The audit of people measures what it says, and the shipped people pass it."""

from collections import Counter

import numpy as np
from hard_poses import HARD_POSES, hard_pose
from people_audit import OUT_M, Cover, audit

from whacamole.body import JOINT_INDEX


def test_points_under_a_sheet_are_covered_and_come_through_as_far_as_they_are_moved():
    """A level sheet; points below it, above it, far below it and beside it."""
    x, y = np.meshgrid(np.linspace(0, 0.3, 16), np.linspace(0, 0.3, 16))
    sheet = np.stack([x.ravel(), y.ravel(), np.zeros(256)], axis=1)
    corner = np.array([16 * j + i for j in range(15) for i in range(15)])
    faces = np.stack([corner, corner + 1, corner + 17, corner + 16], axis=1).astype(np.int32)
    points = np.array([[0.15, 0.15, -0.01], [0.1, 0.2, 0.01], [0.15, 0.1, -0.2], [0.5, 0.15, -0.01]])
    cover = Cover(points, sheet, faces)
    np.testing.assert_array_equal(cover.covered, [True, False, False, False])
    np.testing.assert_allclose(cover.outside(points, sheet), [-0.01], atol=1e-9)
    np.testing.assert_allclose(cover.outside(np.add(points, (0, 0, 0.015)), sheet), [0.005], atol=1e-9)


def test_hard_poses_are_mirrored_where_no_side_is_named():
    pose = hard_pose("sit")
    left, right = (pose[JOINT_INDEX[f"{side}_shoulder"] - 1] for side in ("left", "right"))
    np.testing.assert_array_equal(left * [1, -1, -1], right)
    assert all(np.isfinite(hard_pose(name)).all() for name in HARD_POSES)


def test_hardly_any_skin_comes_through_the_clothes():
    covered, through = Counter(), Counter()
    for pair, pose, outside, _ in audit(3):
        covered[pair, pose] += len(outside)
        through[pair, pose] += int((outside > OUT_M).sum())
    skin = {pose: through["skin", pose] / covered["skin", pose] for pose in HARD_POSES}
    assert max(skin.values()) < 0.015, skin
    assert min(covered["skin", pose] for pose in HARD_POSES) > 300
