import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from whacamole.body import BodyModel, facing, mesh_volume, vertex_normals

ANGLES = st.floats(-3.1, 3.1)
UPRIGHT = Rotation.from_euler("x", 90, degrees=True)  # y up, facing +z -> z up, facing −y


def _turned(rotations):
    """The standing body's joints under each rotation of the world (T, 55, 3)."""
    joints = BodyModel.embedded().rest_joints(np.zeros(10))
    return np.stack([(r * UPRIGHT).apply(joints) for r in rotations])


def _azimuth(direction):
    return np.arctan2(direction[..., 1], direction[..., 0])


@given(yaw=ANGLES)
@settings(max_examples=30, deadline=None, derandomize=True)
def test_a_standing_person_faces_the_chest_level_with_the_ground(yaw):
    turn = Rotation.from_euler("z", yaw)
    np.testing.assert_allclose(facing(_turned([turn]))[0], turn.apply([0, -1, 0]), atol=1e-3)


@given(yaw=ANGLES, axis=ANGLES, tilt=st.floats(0, 2.4))
@settings(max_examples=50, deadline=None, derandomize=True)
def test_tipping_over_any_level_axis_keeps_the_heading(yaw, axis, tilt):
    # Bending, lying on belly, back or side, half a cartwheel: all are tips over a level axis.
    tip = Rotation.from_rotvec(tilt * np.array([np.cos(axis), np.sin(axis), 0]))
    heading = facing(_turned([tip * Rotation.from_euler("z", yaw)]))[0]
    # The rest trunk leans by a few degrees, so the tip is not exactly about the trunk's own level axis.
    expected = Rotation.from_euler("z", yaw).apply([0, -1, 0])
    assert heading @ expected > np.cos(0.2)
    assert heading[2] == 0
    assert np.linalg.norm(heading) == pytest.approx(1)


@pytest.mark.parametrize("axis", [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0.6, 0.8, 0]])
def test_a_whole_somersault_or_cartwheel_keeps_the_heading(axis):
    turns = Rotation.from_rotvec(np.linspace(0, 2 * np.pi, 61)[:, None] * np.array(axis))
    azimuth = np.unwrap(_azimuth(facing(_turned(turns))))
    assert np.abs(azimuth - azimuth[0]).max() < 0.35
    assert np.abs(np.diff(azimuth)).max() < 0.2


def test_a_handstand_that_wobbles_takes_the_heading_around_it():
    # Straight down the heading has no meaning, and a wobble of 5° would send it once round.
    wobble = [
        Rotation.from_euler("xy", [180 + 5 * np.cos(a), 5 * np.sin(a)], degrees=True) for a in range(20)
    ]
    upright = [Rotation.identity()] * 3
    azimuth = _azimuth(facing(_turned([*upright, *wobble, *upright])))
    np.testing.assert_allclose(azimuth, azimuth[0], atol=0.05)


def test_facing_is_defined_when_all_frames_are_upside_down():
    down = [Rotation.from_euler("y", 180, degrees=True)] * 2
    np.testing.assert_allclose(facing(_turned(down)), [[0, -1, 0]] * 2, atol=0.05)


def test_facing_of_no_frames_is_empty():
    assert facing(np.zeros((0, 55, 3))).shape == (0, 3)


def test_normals_of_a_sphere_point_outward():
    sphere = trimesh.creation.icosphere(subdivisions=4)
    normals = vertex_normals(np.stack([sphere.vertices, 2 * sphere.vertices]), sphere.faces)
    assert normals.shape == (2, len(sphere.vertices), 3)
    np.testing.assert_allclose(normals, np.stack([sphere.vertices] * 2), atol=1e-2)


def test_normals_turn_with_the_body(model, make_params):
    vertices = model.pose(make_params(0, 1)).vertices[0]
    R = Rotation.random(random_state=np.random.default_rng(0)).as_matrix()
    turned = vertex_normals(vertices @ R.T, model.faces)
    np.testing.assert_allclose(turned, vertex_normals(vertices, model.faces) @ R.T, atol=2e-3)
    np.testing.assert_allclose(np.linalg.norm(turned, axis=-1), 1, atol=1e-5)


def test_a_vertex_of_no_face_has_no_normal():
    triangle = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5]])
    np.testing.assert_array_equal(vertex_normals(triangle, [[0, 1, 2]]), [[0, 0, 1]] * 3 + [[0, 0, 0]])


def test_volume_of_a_box_and_of_the_body(model):
    box = trimesh.creation.box((1, 2, 3))
    assert mesh_volume(box.vertices + 7, box.faces) == pytest.approx(6)
    rest = model.rest_vertices(np.zeros(10))
    expected = trimesh.Trimesh(rest, model.faces, process=False).volume
    # The rows of teeth are open at the back, so what a sum makes of them depends on its origin.
    assert model.volume(np.zeros(10)) == pytest.approx(expected, rel=1e-3)
    assert 0.05 < expected < 0.08  # a person of 50 to 80 kg
