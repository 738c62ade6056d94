"""Looking at surfaces from all around."""

import numpy as np
import pytest
from seen import GRAZING, PIXEL_M, VIEWS, directions, inside_seen

from render_jobs.scene import Material, Mesh

CORNERS = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float) * 0.2
SIDES = np.array(
    [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]], np.int32
)


def box(sides):
    return {"box": Mesh(name="box", vertices=CORNERS[None], faces=SIDES[sides], material=Material(name="b"))}


def test_views_are_spread_evenly_over_the_sphere():
    views = directions()
    np.testing.assert_allclose(np.linalg.norm(views, axis=1), 1)
    np.testing.assert_allclose(views.mean(axis=0), 0, atol=0.05)
    apart = np.arccos(np.clip(views @ views.T, -1, 1)) + 4 * np.eye(VIEWS)
    assert apart.min() > 0.6


def test_a_closed_box_shows_no_inside_and_the_area_it_has():
    area = 0.2**2 * np.abs(directions()).sum(axis=1)
    for (pixels, backs), seen in zip(inside_seen(box(range(6)), 0), area, strict=True):
        assert pixels * PIXEL_M**2 == pytest.approx(seen, rel=0.08)
        assert sum(backs.values()) < 0.02 * pixels  # pixels on an edge


def test_through_a_missing_side_one_sees_the_inside_of_the_others():
    """Looking into the open side: all that is seen past it is inside; from behind none is."""
    for (pixels, backs), towards in zip(inside_seen(box(range(5)), 0), directions(), strict=True):
        if np.abs(towards).min() > GRAZING:
            expected = max(towards[2], 0) / np.abs(towards).sum()
            assert backs.get("box", 0) / pixels == pytest.approx(expected, abs=0.03), towards
    assert (np.abs(directions()).min(axis=1) > GRAZING).sum() >= 3
