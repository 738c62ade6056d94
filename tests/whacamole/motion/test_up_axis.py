"""The up axis: convention, content, and which of them wins."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from whacamole.errors import MotionError
from whacamole.motion import embedded_motions, read_motion
from whacamole.motion.skeleton import REST_JOINTS, forward, touch_points
from whacamole.motion.up_axis import AXES, choose, evidence, to_z_up

UPRIGHT = ["walk", "run", "dance_a", "dance_b", "jump", "punch", "spinkick", "stroll_00", "duet_00"]


def posed(people: list[tuple[np.ndarray, np.ndarray, np.ndarray]]) -> tuple[np.ndarray, np.ndarray]:
    """Joints and touch points of people given as (orientation, body pose, pelvis)."""
    poses = [forward(*person) for person in people]
    return np.stack([joints for joints, _ in poses]), np.stack([touch_points(*pose) for pose in poses])


def embedded_in(axis: str, name: str) -> tuple[np.ndarray, np.ndarray]:
    """An embedded motion in a world whose ``axis`` is up."""
    turn = to_z_up(axis).inv()
    motion = read_motion(embedded_motions() / f"{name}.npz")
    return posed(
        [
            ((turn * Rotation.from_rotvec(p.global_orient)).as_rotvec(), p.body_pose, turn.apply(p.pelvis))
            for p in motion.people
        ]
    )


@pytest.mark.parametrize("axis", AXES)
def test_the_axis_becomes_z_by_a_proper_rotation(axis):
    turn = to_z_up(axis)
    np.testing.assert_allclose(turn.apply(AXES[axis]), [0.0, 0.0, 1.0], atol=1e-15)
    assert np.linalg.det(turn.as_matrix()) == pytest.approx(1.0)


@pytest.mark.parametrize("name", UPRIGHT)
@pytest.mark.parametrize("axis", AXES)
def test_people_on_their_feet_are_recognised_in_any_axes(axis, name):
    joints, points = embedded_in(axis, name)
    for convention in ("+z", "+y", "-y"):
        assert choose(convention, joints, points) == axis
        assert choose(convention, joints, points, stated=False) == axis


@pytest.mark.parametrize("path", sorted(embedded_motions().glob("*.npz")), ids=lambda path: path.stem)
def test_a_right_convention_is_never_overruled(path: Path):
    joints, points = embedded_in("+y", path.stem)
    assert choose("+y", joints, points) == "+y"
    assert choose("+y", joints, points, stated=False) == "+y"


def lying(frames: int = 60) -> tuple[np.ndarray, np.ndarray]:
    """Someone who lies on the back, on z = 0, and breathes."""
    pose = np.zeros((frames, 21, 3))
    pose[:, 2, 0] = 0.02 * np.sin(np.arange(frames) / 10.0)
    orient = np.zeros((frames, 3))  # the rest pose: spine along y, face towards z
    return posed([(orient, pose, np.tile([0.0, 0.0, 0.12], (frames, 1)))])


def test_a_sleeper_stays_lying_where_the_convention_is_stated():
    joints, points = lying()
    assert evidence(joints, points)["+z"].support == 1.0
    assert choose("+z", joints, points) == "+z"
    # Without documents the spine decides: more people stand than sleep.
    assert choose("+z", joints, points, stated=False) == "+y"


def test_upright_is_the_cosine_of_the_spine():
    lean = Rotation.from_euler("x", 90 - 25, degrees=True).as_rotvec()
    joints, points = posed([(np.tile(lean, (10, 1)), np.zeros((10, 21, 3)), np.zeros((10, 3)))])
    spine = REST_JOINTS[12] - REST_JOINTS[0]
    tilt = np.arctan2(spine[2], spine[1])
    # The rest spine itself leans back a little; the turn about x adds to it.
    assert evidence(joints, points)["+z"].upright == pytest.approx(np.cos(np.radians(25) - tilt), abs=1e-9)


def test_a_file_in_wrong_axes_is_turned_upright(tmp_path):
    walk = embedded_motions() / "walk.npz"
    with np.load(walk) as data:
        values = dict(data)
    turn = Rotation.from_euler("x", -90, degrees=True)
    values["poses"][:, :3] = (turn * Rotation.from_rotvec(values["poses"][:, :3])).as_rotvec()
    j0 = np.array([0.0031, -0.3514, 0.0120])
    values["trans"] = turn.apply(values["trans"] + j0) - j0
    np.savez(tmp_path / "walk_y_up.npz", **values)
    found, expected = read_motion(tmp_path / "walk_y_up.npz"), read_motion(walk)
    assert (found.up, expected.up) == ("+y", "+z")
    np.testing.assert_allclose(found.people[0].pelvis, expected.people[0].pelvis, atol=1e-5)


def test_the_axis_can_be_named(tmp_path):
    walk = embedded_motions() / "walk.npz"
    assert read_motion(walk, up="-y").up == "-y"
    with pytest.raises(MotionError, match="choose one of them"):
        read_motion(walk, up="z")
