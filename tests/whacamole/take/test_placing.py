"""Which part of a motion is filmed, and where it stands."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from whacamole.body import Posed
from whacamole.errors import TakeError
from whacamole.take.placing import choose_window, ground_shift, scene_transform


@given(st.integers(3, 500), st.integers(0, 600), st.integers(0, 2**32))
def test_a_window_lies_in_the_motion_and_has_its_neighbours(total: int, frames: int, seed: int) -> None:
    window = choose_window(total, frames, np.random.default_rng(seed))
    assert 0 <= window.start < window.stop <= total
    filmed = window.stop - window.start - 2
    assert filmed == (min(frames, total - 2) if frames else total - 2)


@pytest.mark.parametrize("total", [0, 1, 2])
def test_a_motion_without_neighbours_is_refused(total: int) -> None:
    with pytest.raises(TakeError, match="at least 3"):
        choose_window(total, 10, np.random.default_rng(0))


@given(st.integers(0, 2**32), st.floats(0.0, 6.28))
def test_a_scene_is_centred_and_keeps_its_distances(seed: int, yaw: float) -> None:
    pelvis = np.random.default_rng(seed).normal(0.0, 5.0, (2, 7, 3))
    transform = scene_transform(pelvis, yaw)
    moved = pelvis @ transform[:3, :3].T + transform[:3, 3]
    np.testing.assert_allclose(moved[..., 2], pelvis[..., 2])
    np.testing.assert_allclose(
        np.linalg.norm(moved[0] - moved[1], axis=1), np.linalg.norm(pelvis[0] - pelvis[1], axis=1)
    )
    flat = pelvis[..., :2].reshape(-1, 2)
    middle = np.append((flat.min(axis=0) + flat.max(axis=0)) / 2.0, 0.0)
    np.testing.assert_allclose(transform[:3, :3] @ middle + transform[:3, 3], 0.0, atol=1e-9)


def test_one_shift_grounds_a_pair_and_keeps_who_is_higher() -> None:
    low, high = np.zeros((20, 4, 3), np.float32), np.zeros((20, 4, 3), np.float32)
    low[..., 2], high[..., 2] = 0.3, 0.8
    low[0, :, 2] = 0.1  # one noisy frame does not lift the scene
    people = [Posed(vertices, np.zeros((20, 55, 3))) for vertices in (low, high)]
    assert ground_shift(people) == pytest.approx(-0.3)
