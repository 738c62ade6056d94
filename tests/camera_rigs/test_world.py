"""Obstacles, walls and lines of sight against a second, slower way."""

import json

import numpy as np
import pytest

from camera_rigs import Obstacle, PlanError, World

BOX = Obstacle((1.0, -0.5, 0.6), (1.2, 0.4, 1.2), 0.7, "bench")


def surface(obstacle, count=61):
    """Points all over the surface of a box."""
    grid = np.linspace(-0.5, 0.5, count)
    u, v = (a.ravel() for a in np.meshgrid(grid, grid))
    faces = []
    for axis in range(3):
        for side in (-0.5, 0.5):
            local = np.empty((len(u), 3))
            local[:, axis] = side
            local[:, (axis + 1) % 3], local[:, (axis + 2) % 3] = u, v
            faces.append(local * obstacle.size)
    cos, sin = np.cos(obstacle.yaw), np.sin(obstacle.yaw)
    R = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    return np.concatenate(faces) @ R.T + obstacle.center


def test_the_distance_is_that_to_the_nearest_point_of_the_surface():
    points = np.random.default_rng(0).uniform(-2.0, 3.0, (200, 3))
    nearest = np.linalg.norm(points[:, None] - surface(BOX)[None], axis=-1).min(axis=1)
    np.testing.assert_allclose(np.abs(BOX.distance(points)), nearest, atol=0.03)
    assert BOX.distance(BOX.center) < 0.0
    assert BOX.distance((4.0, 4.0, 4.0)) > 0.0


def test_a_line_is_cut_where_points_on_it_are_inside():
    rng = np.random.default_rng(1)
    start, end = rng.uniform((0.0, -1.5, 0.0), (2.0, 0.5, 1.2), (2, 500, 3))
    along = start[:, None] + np.linspace(0.0, 1.0, 2001)[None, :, None] * (end - start)[:, None]
    depth = BOX.distance(along).min(axis=1)
    clear = np.abs(depth) > 1e-3  # a line that only touches a corner may go either way
    np.testing.assert_array_equal(BOX.hides(start, end)[clear], (depth < 0.0)[clear])
    assert 0.1 < BOX.hides(start, end).mean() < 0.9


def test_walls_and_ceiling_but_not_the_floor():
    world = World(bounds=((-2.0, -3.0, 0.0), (2.0, 3.0, 2.5)))
    np.testing.assert_allclose(
        world.wall_distance([[1.5, 0.0, 0.01], [0.0, 0.0, 2.2], [0, 4, 1]]), [0.5, 0.3, -1]
    )
    assert World().wall_distance([0.0, 0.0, 0.0]) == np.inf


def test_the_nearest_of_several_obstacles_counts():
    world = World(obstacles=(BOX, Obstacle((5.0, 0.0, 1.0), (1.0, 1.0, 2.0))))
    assert world.obstacle_distance((6.0, 0.0, 1.0)) == pytest.approx(0.5)
    assert world.hides((7.0, 0.0, 1.0), (3.0, 0.0, 1.0))
    assert not world.hides((7.0, 2.0, 1.0), (3.0, 2.0, 1.0))
    assert World().obstacle_distance((0.0, 0.0, 0.0)) == np.inf


def test_plain_data_and_back():
    world = World(0.1, (BOX,), ((-2.0, -3.0, 0.0), (2.0, 3.0, 2.5)))
    assert World.from_json(json.loads(json.dumps(world.to_json()))) == world


def test_what_cannot_be_is_refused():
    with pytest.raises(PlanError, match="below its maximum"):
        World(bounds=((1.0, 0.0, 0.0), (0.0, 1.0, 1.0)))
    with pytest.raises(PlanError, match="every side"):
        World(obstacles=(Obstacle((0.0, 0.0, 0.0), (1.0, 0.0, 1.0)),))
    with pytest.raises(PlanError, match="obstacles"):
        World.from_json({"ground_z": 0.0})
