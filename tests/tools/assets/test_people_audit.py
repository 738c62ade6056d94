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


def test_the_other_sheet_of_a_folded_cloth_does_not_count():
    """A collar: a sheet, and 2 mm below it the same sheet turned over; a point slides under it by a face."""
    x, y = np.meshgrid(np.linspace(0, 0.3, 16), np.linspace(0, 0.3, 16))
    upper = np.stack([x.ravel(), y.ravel(), np.zeros(256)], axis=1)
    corner = np.array([16 * j + i for j in range(15) for i in range(15)])
    faces = np.stack([corner, corner + 1, corner + 17, corner + 16], axis=1).astype(np.int32)
    both = np.concatenate([upper, upper - [0, 0, 0.002]])
    turned = np.concatenate([faces, 256 + faces[:, ::-1]])
    point = np.array([[0.15, 0.15, 0.0 - 1e-4]])
    cover = Cover(point, both, turned)
    assert cover.covered.all()
    np.testing.assert_allclose(cover.outside(point - [0, 0, 0.01], both), [-0.0101], atol=1e-9)


def test_hardly_anything_comes_through_the_clothes():
    covered, through = Counter(), Counter()
    for pair, pose, outside, _ in audit(3):
        covered[pair, pose] += len(outside)
        through[pair, pose] += int((outside > OUT_M).sum())
    share = {key: through[key] / covered[key] for key in covered}
    assert max(share.values()) < 0.01, share
    assert min(covered["skin", pose] for pose in HARD_POSES) > 300
    assert min(covered["cloth", pose] for pose in HARD_POSES) > 300
