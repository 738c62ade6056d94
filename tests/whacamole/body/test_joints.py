from itertools import chain

import smplx.joint_names

from whacamole.body import JOINT_GROUPS, JOINT_INDEX, JOINT_NAMES, MIRROR_JOINTS, NUM_JOINTS, PARENTS
from whacamole.body.joints import tree_levels


def test_names_are_those_of_smplx_in_its_order():
    # The package spells the eyes 'left_eye_smplhf'.
    theirs = [name.removesuffix("_smplhf") for name in smplx.joint_names.JOINT_NAMES[:NUM_JOINTS]]
    assert list(JOINT_NAMES) == theirs


def test_groups_cover_every_joint_once_in_the_order_of_the_pose():
    pose_order = ("root", "body", "face", "left_hand", "right_hand")
    assert list(chain.from_iterable(JOINT_GROUPS[name] for name in pose_order)) == list(range(NUM_JOINTS))
    parts = [name for name in JOINT_GROUPS if name not in ("root", "body", "face")]
    assert sorted(chain.from_iterable(JOINT_GROUPS[name] for name in parts)) == list(range(NUM_JOINTS))


def test_mirror_swaps_sides_and_keeps_the_tree():
    assert [MIRROR_JOINTS[MIRROR_JOINTS[j]] for j in range(NUM_JOINTS)] == list(range(NUM_JOINTS))
    assert MIRROR_JOINTS[JOINT_INDEX["left_ring2"]] == JOINT_INDEX["right_ring2"]
    assert MIRROR_JOINTS[JOINT_INDEX["jaw"]] == JOINT_INDEX["jaw"]
    assert all(MIRROR_JOINTS[PARENTS[j]] == PARENTS[MIRROR_JOINTS[j]] for j in range(1, NUM_JOINTS))


def test_levels_visit_each_joint_once_after_its_parent():
    seen = {0}
    for joints, parents in tree_levels():
        assert set(parents) <= seen
        assert [PARENTS[j] for j in joints] == list(parents)
        assert not seen & set(joints)
        seen |= set(joints)
    assert len(seen) == NUM_JOINTS
