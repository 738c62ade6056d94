"""A crowd: nobody walks through anybody at any time."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from whacamole.body import Posed
from whacamole.take.crowd import PERSONAL_SPACE, Footprint, Placement, gap_over_time, place_crowd


def _walker(rng: np.random.Generator, frames: int = 40) -> NDArray[np.float64]:
    """Return points (T, V, 3) of a body-sized cloud that walks a curved path."""
    heading = np.cumsum(rng.normal(0.0, 0.1, frames)) + rng.uniform(0.0, 6.28)
    path = np.cumsum(0.04 * np.stack([np.cos(heading), np.sin(heading)], axis=1), axis=0) + rng.normal(
        0, 9, 2
    )
    cloud = rng.uniform(-0.4, 0.4, (12, 3)) + np.array([0.0, 0.0, 1.0])
    points = np.repeat(cloud[None], frames, axis=0)
    points[..., :2] += path[:, None]
    return points


def _posed(points: NDArray[np.float64]) -> Posed:
    return Posed(points.astype(np.float32), np.zeros((len(points), 55, 3)))


@settings(max_examples=30, deadline=None, derandomize=True)
@given(st.integers(0, 2**32))
def test_points_of_two_people_keep_their_distance_in_every_frame(seed: int) -> None:
    rng = np.random.default_rng(seed)
    clouds = [_walker(rng) for _ in range(6)]
    footprints = [Footprint.of(_posed(cloud)) for cloud in clouds]
    placements = place_crowd(footprints[:1], footprints[1:], rng)
    placed = [clouds[0]]
    for cloud, placement in zip(clouds[1:], placements, strict=True):
        assert placement is not None
        transform = placement.as_transform()
        placed.append(cloud @ transform[:3, :3].T + transform[:3, 3])
    for index, one in enumerate(placed):
        for other in placed[:index]:
            # Every point against every point: the discs are only a means to this.
            apart = np.linalg.norm(one[:, :, None, :2] - other[:, None, :, :2], axis=-1)
            assert apart.min() > PERSONAL_SPACE - 1e-5


def test_paths_may_cross_at_different_times() -> None:
    time = np.linspace(-3.0, 3.0, 61)
    radius = np.full(61, 0.4)
    along_x = Footprint(np.stack([time, 0.0 * time], axis=1), radius)
    at_once = Footprint(np.stack([0.0 * time, time], axis=1), radius)
    later = Footprint(np.stack([0.0 * time, time - 2.5], axis=1), radius)
    assert gap_over_time(along_x, at_once) < 0.0
    assert gap_over_time(along_x, later) > 0.5


def test_a_placement_moves_a_footprint_as_its_transform_moves_points() -> None:
    rng = np.random.default_rng(0)
    points = _walker(rng)
    placement = Placement(0.7, (2.0, -1.0))
    transform = placement.as_transform()
    moved = points @ transform[:3, :3].T + transform[:3, 3]
    footprint = Footprint.of(_posed(points)).moved(placement)
    reach = np.linalg.norm(moved[..., :2] - footprint.center[:, None], axis=2).max(axis=1)
    np.testing.assert_allclose(reach, footprint.radius, atol=1e-5)


def test_no_place_is_said_and_not_forced() -> None:
    everywhere = Footprint(np.zeros((3, 2)), np.full(3, 500.0))
    small = Footprint(np.zeros((3, 2)), np.full(3, 0.3))
    assert place_crowd([everywhere], [small], np.random.default_rng(0)) == [None]
