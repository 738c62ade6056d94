"""Cutting a clip into shots, and joining their moves."""

import itertools

import numpy as np
import pytest

from camera_rigs.joins import (
    MAX_SHOT_SECONDS,
    MIN_SHOT_SECONDS,
    compose,
    cut,
    join,
    spans_between,
    transition_half,
)
from camera_rigs.shot import Move


@pytest.mark.parametrize("fps", [1.0, 12.0, 30.0, 120.0])
@pytest.mark.parametrize("frames", [1, 2, 24, 45, 90, 91, 300, 3000])
def test_spans_cover_the_clip_and_keep_their_length(fps, frames):
    for seed in range(5):
        spans = cut(frames, fps, np.random.default_rng(seed))
        assert spans[0].start == 0
        assert spans[-1].end == frames - 1
        for before, after in itertools.pairwise(spans):
            assert before.end == after.start
        if len(spans) > 1:
            lengths = np.array([span.end - span.start for span in spans]) / fps
            assert lengths.min() >= MIN_SHOT_SECONDS - 1e-9
            assert lengths[:-1].max() <= MAX_SHOT_SECONDS + max(1.0, 2.0 * transition_half(fps)) / fps
            assert all(span.end - span.start >= 2 * transition_half(fps) for span in spans)


def test_a_clip_of_less_than_two_shortest_shots_is_one_shot():
    assert len(cut(90, 30.0, np.random.default_rng(0))) == 1
    assert len(cut(92, 30.0, np.random.default_rng(0))) == 2


def test_movements_gather_speed_at_joints_only():
    first, middle, last = spans_between([0, 60, 120, 200], 30.0)
    assert (first.ease_in, first.ease_out) == (0.0, 22.5)
    assert (middle.ease_in, middle.ease_out) == (22.5, 22.5)
    assert (last.ease_in, last.ease_out) == (22.5, 0.0)
    assert (first.lo, first.hi) == (0, 75)


def test_times_invert_progress():
    span = spans_between([0, 50, 120, 200], 30.0)[1]
    shares = np.linspace(0.0, 1.0, 7)
    np.testing.assert_allclose(span.progress(span.times(shares)), shares, atol=1e-6)


def test_a_transition_between_two_velocities_jumps_in_nothing():
    half, fps = 15, 30.0
    frames = np.arange(-60, 61, dtype=float)
    before = np.column_stack([0.05 * frames, 0.0 * frames])
    after = np.column_stack([0.0 * frames, 0.02 * frames])
    middle = slice(60 - half, 60 + half + 1)
    path = np.concatenate(
        [before[: 60 - half], join(before[middle], after[middle], half), after[60 + half + 1 :]]
    )
    velocity = np.diff(path, axis=0) * fps
    difference = np.linalg.norm([0.05 * fps, -0.02 * fps])
    acceleration = np.linalg.norm(np.diff(velocity, axis=0), axis=1) * fps
    assert acceleration.max() == pytest.approx(1.875 * difference / (2.0 * half / fps), rel=0.01)
    jerk = np.linalg.norm(np.diff(velocity, 2, axis=0), axis=1) * fps**2
    assert jerk.max() < 1.05 * 5.78 * difference / (2.0 * half / fps) ** 2


def test_moves_that_agree_are_joined_unchanged():
    state = np.random.default_rng(0).normal(size=(101, 8))
    moves = [
        Move(a, state[a:b, :3], state[a:b, 3:6], state[a:b, 6], state[a:b, 7])
        for a, b in ((0, 66), (35, 101))
    ]
    whole = compose(moves, [50], 0, 100, 15)
    np.testing.assert_allclose(np.column_stack([whole.eye, whole.target, whole.focal, whole.roll]), state)
    part = compose(moves, [50], 40, 70, 15)
    np.testing.assert_allclose(part.eye, state[40:71, :3])
