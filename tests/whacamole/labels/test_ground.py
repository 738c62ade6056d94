"""Ground contact of a toy ball on a plane, in closed form."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from whacamole.labels import BodyParts, ContactThresholds
from whacamole.labels.ground import PartRows, ground_vertices, still_speed

LIMITS = ContactThresholds(ground=0.03, velocity=0.5)


def test_a_resting_ball_touches_with_its_cap(ball):
    radius = 0.2
    vertices = radius * ball[0] + [0, 0, radius]
    touching = ground_vertices(vertices, vertices, vertices, 30.0, LIMITS)
    # z <= h on a sphere standing on the plane is the cap where 1 + cos(angle from the top) <= h / r.
    np.testing.assert_array_equal(touching, ball[0][:, 2] <= LIMITS.ground / radius - 1)
    assert 0 < touching.sum() < len(touching)


def test_a_sliding_ball_does_not_touch(ball):
    vertices = 0.2 * ball[0] + [0, 0, 0.2]
    for speed, expected in ((0.45, True), (0.55, False)):
        step = np.array([speed / 30.0, 0, 0])
        touching = ground_vertices(vertices - step, vertices, vertices + step, 30.0, LIMITS)
        assert touching.any() == expected


@given(fps=st.sampled_from([10.0, 24.0, 30.0, 60.0, 120.0]), speed=st.floats(0.0, 1.0))
def test_the_verdict_does_not_depend_on_the_frame_rate(fps: float, speed: float):
    now = np.zeros((1, 3))
    step = np.array([[speed / fps, 0, 0]])
    assert still_speed(now - step, now, now + step, fps) == pytest.approx(speed, abs=1e-12)


def test_a_rolling_ball_touches_where_it_rolls(ball):
    """Without slip the lowest point stands still while the ball moves on: contact is a matter of vertices."""
    radius, fps, speed = 0.5, 30.0, 1.0

    def rolled(time: float) -> np.ndarray:
        angle = speed * time / radius
        x, y, z = radius * ball[0].T
        cos, sin = np.cos(angle), np.sin(angle)
        return np.stack([x * cos + z * sin + speed * time, y, z * cos - x * sin + radius], axis=1)

    touching = ground_vertices(rolled(-1 / fps), rolled(0), rolled(1 / fps), fps, LIMITS)
    assert touching[ball[0][:, 2].argmin()]
    # A vertex at height z moves at about speed / radius times its distance from the point of contact.
    lever = np.linalg.norm(radius * ball[0] + [0, 0, radius], axis=1)
    assert not touching[lever * speed / radius > 0.6].any()


def test_landing_and_leaving_frames_count():
    heights = np.array([0.3, 0.0, 0.0, 0.3])
    points = np.stack([np.zeros(4), np.zeros(4), heights], axis=1)[:, None]
    seen = [
        bool(
            ground_vertices(
                points[t - 1] if t else None, points[t], points[t + 1] if t < 3 else None, 30.0, LIMITS
            )[0]
        )
        for t in range(4)
    ]
    assert seen == [False, True, True, False]


def test_a_single_frame_goes_by_height_alone():
    points = np.array([[0, 0, 0.02], [0, 0, 0.04]])
    np.testing.assert_array_equal(ground_vertices(None, points, None, 30.0, LIMITS), [True, False])


def test_part_rows():
    parts = BodyParts(("a", "empty", "b"), np.array([2, 0, -1, 2, 0], dtype=np.int32))
    rows = PartRows(parts, np.array([0, 1, 2, 3]))  # vertex 4 is not on the skin
    np.testing.assert_array_equal(rows.minimum(np.array([3.0, 5, -9, 1, -7])), [5, np.inf, 1])
    np.testing.assert_array_equal(rows.any(np.array([False, False, True, True, True])), [False, False, True])
