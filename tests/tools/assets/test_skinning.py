"""Skinning of the asset build: two bones, a tube round them."""

import numpy as np
import pytest
from open_people.rig import Rig, skin, skin_rigidly
from scipy import sparse
from scipy.spatial.transform import Rotation

RADIUS = 0.05


@pytest.fixture
def tube():
    """A tube along x, its weights going over from the first bone to the second about the origin."""
    angle = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    x = np.linspace(-0.3, 0.3, 61)
    points = np.stack(
        [
            np.repeat(x, 16),
            RADIUS * np.tile(np.cos(angle), 61),
            RADIUS * np.tile(np.sin(angle), 61),
        ],
        axis=1,
    )
    second = np.clip(0.5 + points[:, 0] / 0.2, 0, 1)
    weights = sparse.csr_matrix(np.stack([1 - second, second], axis=1))
    empty = sparse.csr_matrix((2, len(points)))
    return Rig(("upper", "lower"), np.array([-1, 0]), empty, empty, weights), points


HEADS = np.array([[-0.3, 0, 0], [0, 0, 0]])


def test_what_hangs_on_one_bone_moves_rigidly_with_it(tube):
    rig, points = tube
    turn = Rotation.from_rotvec([[0.3, 1.0, -0.4], [-1.2, 0.7, 2.9]]).as_matrix()
    placed = np.array([[1.0, 2.0, 3.0], [1.5, 2.2, 2.9]])
    moved = skin_rigidly(rig, points, rig.weights, turn, HEADS, placed)
    for bone in (0, 1):
        whole = rig.weights[:, bone].toarray().ravel() == 1
        expected = (points[whole] - HEADS[bone]) @ turn[bone].T + placed[bone]
        np.testing.assert_allclose(moved[whole], expected, atol=1e-12)


def test_both_ways_agree_where_all_bones_move_alike(tube):
    rig, points = tube
    turn = np.repeat(Rotation.from_rotvec([[0.2, -2.0, 0.9]]).as_matrix(), 2, axis=0)
    placed = HEADS @ turn[0].T + [0.1, 0.2, 0.3]
    arguments = (rig.weights, turn, HEADS, placed)
    np.testing.assert_allclose(skin_rigidly(rig, points, *arguments), skin(points, *arguments), atol=1e-12)


@pytest.mark.parametrize("degrees", [60, 120, 170])
def test_a_twisted_tube_keeps_its_girth_where_plain_blending_pinches_it(tube, degrees):
    rig, points = tube
    turn = Rotation.from_euler("x", [[0], [degrees]], degrees=True).as_matrix()
    middle = np.abs(points[:, 0]) < 1e-9
    arguments = (rig.weights, turn, HEADS, HEADS)
    girth = np.linalg.norm(skin_rigidly(rig, points, *arguments)[middle, 1:], axis=1)
    np.testing.assert_allclose(girth, RADIUS, atol=1e-12)
    pinched = np.linalg.norm(skin(points, *arguments)[middle, 1:], axis=1)
    np.testing.assert_allclose(pinched, RADIUS * np.cos(np.deg2rad(degrees) / 2), atol=1e-12)


def test_the_sign_of_a_quaternion_does_not_matter(tube):
    """Just short of and just past half a turn, where the quaternion of a matrix changes its sign."""
    rig, points = tube
    out = []
    for degrees in (179.99, 180.01):
        turn = Rotation.from_euler("z", [[degrees - 20], [degrees]], degrees=True).as_matrix()
        out.append(skin_rigidly(rig, points, rig.weights, turn, HEADS, np.array([[0.3, 0, 0], [0, 0, 0.0]])))
    np.testing.assert_allclose(out[0], out[1], atol=1e-3)
