"""What counts against a label and what does not, on bodies of a few triangles."""

import numpy as np
import pytest

from whacamole.check.limits import Limits
from whacamole.check.order import correlation
from whacamole.check.pixels import Hands, Shown, draw, person_pixels

SIZE = (40, 30)
K = np.array([[40.0, 0, 20], [0, 40, 15], [0, 0, 1]])
CORNERS = np.stack(np.meshgrid(np.linspace(-0.4, 0.4, 33), np.linspace(-0.3, 0.3, 25)), axis=-1)


def sheet(x: float, depth: float) -> np.ndarray:
    """A body: a fine grid that faces the camera."""
    points = CORNERS.reshape(-1, 2) + np.array([x, 0.0])
    return np.column_stack([points, np.full(len(points), depth)])


def faces() -> np.ndarray:
    at = np.arange(33 * 25).reshape(25, 33)
    a, b, c, d = (part.ravel() for part in (at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]))
    return np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])


NO_HANDS = Hands(np.zeros(33 * 25, dtype=bool), np.zeros(len(faces()), dtype=bool))


@pytest.mark.parametrize(
    ("beside", "nearer", "fault"),
    [
        (0.0, 0.01, False),  # hair of the second lies on the first's face
        (0.0, -0.01, True),  # what lies under the first's skin cannot hide it
        (1.0, 0.01, True),  # the second is nowhere near: a wrong id
    ],
)
def test_the_hair_of_another_may_lie_on_a_body_if_they_touch(beside, nearer, fault):
    drawn = draw([sheet(0.0, 1.0), sheet(beside, 1.03)], faces(), np.array([1, 2]), K, np.eye(4), SIZE)
    body = drawn.raster.mesh == 0
    shown = Shown(np.where(body, 2, 0), np.where(body, 1.0 - nearer, np.inf))
    found = person_pixels(drawn, shown, 0, [1, 2], K, NO_HANDS, Limits())
    assert found.area > 500
    assert found.stray == (found.area if fault else 0)


@pytest.mark.parametrize("all_hand", [False, True])
def test_clothes_of_the_hip_may_hide_a_hand_but_a_hand_may_not_be_elsewhere(all_hand):
    """The picture is 4 cm before the hand: clothes, unless no part that wears any is near."""
    vertex = np.ones(33 * 25, dtype=bool) if all_hand else np.arange(33 * 25) >= 33 * 13
    hands = Hands(vertex, vertex[faces()].all(axis=1))
    drawn = draw([sheet(0.0, 1.0)], faces(), np.array([1]), K, np.eye(4), SIZE)
    body = drawn.raster.mesh == 0
    shown = Shown(np.where(body, 1, 0), np.where(body, 0.96, np.inf))
    found = person_pixels(drawn, shown, 0, [1], K, hands, Limits())
    assert found.hands_off == found.hands
    drawn_hand = np.count_nonzero(hands.triangle[drawn.raster.triangle] & body)
    assert (found.hands == drawn_hand) == all_hand
    assert found.hands > 0


def test_edges_of_a_person_of_a_few_pixels_say_nothing_of_the_order() -> None:
    rng = np.random.default_rng(0)
    edges, colours = rng.random((2, 60, 60))
    mask = np.zeros((60, 60), np.int64)
    mask[10:25, 10:25] = 1  # 225 pixels
    assert np.isnan(correlation(edges, colours, mask))
    mask[10:30, 10:30] = 1
    assert np.isfinite(correlation(edges, colours, mask))
