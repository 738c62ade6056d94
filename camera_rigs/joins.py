"""From shots to one path: how long shots and transitions are, and how neighbouring moves are joined.

Two moves overlap around the frame that their shots share. Over that transition the path goes from the one
to the other so that position, velocity and acceleration are continuous: the difference of the two moves is
blended by a smootherstep, and the difference of their velocities at the joint, which a plain blend would
double in acceleration, follows the integral of that step instead.
"""

import itertools
from collections.abc import Sequence

import numpy as np

from camera_rigs.scene import Span
from camera_rigs.shot import Move
from camera_rigs.smoothing import smootherstep, smootherstep_integral
from camera_rigs.spherical import Array

MIN_SHOT_SECONDS = 1.5
"""Shortest shot [s]: below it a movement is over before it is read. A shorter clip is one shot."""

MAX_SHOT_SECONDS = 5.0
"""Longest shot [s]: by then another movement is due."""

TRANSITION_SECONDS = 1.0
"""Length [s] of the change from one move to the next, half before and half after the shared frame."""

EASE_SECONDS = 0.75
"""Time [s] in which a movement gathers or loses its speed at a joint: that of a dolly grip."""

_STATE = 8
"""Numbers of a camera at one frame: location 3, target 3, focal length, roll."""


def cut(
    num_frames: int,
    fps: float,
    rng: np.random.Generator,
    *,
    shot_seconds: tuple[float, float] = (MIN_SHOT_SECONDS, MAX_SHOT_SECONDS),
    ease_seconds: float = EASE_SECONDS,
) -> list[Span]:
    """Spans of random length in `shot_seconds` that cover the frames; neighbours share one.

    A clip shorter than two shortest shots is one span.
    """
    shortest = max(shot_seconds[0] * fps, 2.0 * transition_half(fps))
    joints = [0]
    while (left := num_frames - 1 - joints[-1]) >= 2.0 * shortest:
        longest = max(min(shot_seconds[1] * fps, left - shortest), shortest)
        joints.append(joints[-1] + int(np.ceil(rng.uniform(shortest, longest))))
    return spans_between([*joints, num_frames - 1], fps, ease_seconds)


def spans_between(joints: Sequence[int], fps: float, ease_seconds: float = EASE_SECONDS) -> list[Span]:
    """Spans between `joints`, the first frame 0 and the last frame included; they ease at inner joints."""
    half, last = transition_half(fps), joints[-1]
    spans = []
    for start, end in itertools.pairwise(joints):
        ease = min(ease_seconds * fps, 0.5 * max(end - start, 1))
        lo, hi = max(start - half, 0), min(end + half, last)
        spans.append(Span(start, end, lo, hi, ease if start > 0 else 0.0, ease if end < last else 0.0))
    return spans


def transition_half(fps: float) -> int:
    """Half of `TRANSITION_SECONDS` in frames, at least one."""
    return max(1, round(0.5 * TRANSITION_SECONDS * fps))


def join(before: Array, after: Array, half: int) -> Array:
    """The transition (2·half + 1, n) between two moves over the same frames, the joint in the middle."""
    tau = np.arange(-half, half + 1, dtype=float)[:, None]
    u = (tau + half) / (2.0 * half)
    step = smootherstep(u)
    difference = after - before
    velocity = 0.5 * (difference[half + 1] - difference[half - 1])
    ramp = 2.0 * half * smootherstep_integral(u)
    joined: Array = before + step * (difference - tau * velocity) + ramp * velocity
    return joined


def compose(moves: Sequence[Move], joints: Sequence[int], lo: int, hi: int, half: int) -> Move:
    """The moves as one, over the frames `lo` to `hi`.

    Args:
        moves: in order of time; together they cover lo … hi.
        joints: the frames that neighbouring moves share, one fewer than moves.
        lo, hi: first and last frame wanted.
        half: half length of a transition [frames].
    """
    state = np.empty((hi - lo + 1, _STATE))
    starts, ends = [lo, *joints], [*joints, hi]
    for move, start, end in zip(moves, starts, ends, strict=True):
        first, stop = max(start, lo), min(end, hi) + 1
        state[first - lo : stop - lo] = _state(move, first, stop)
    for (before, after), joint in zip(itertools.pairwise(moves), joints, strict=True):
        first, stop = joint - half, joint + half + 1
        blend = join(_state(before, first, stop), _state(after, first, stop), half)
        inside = slice(max(first, lo), min(stop, hi + 1))
        state[inside.start - lo : inside.stop - lo] = blend[inside.start - first : inside.stop - first]
    return Move(lo, state[:, :3], state[:, 3:6], state[:, 6], state[:, 7])


def _state(move: Move, first: int, stop: int) -> Array:
    """The camera (n, 8) of a move from `first` up to `stop`, exclusive."""
    part = slice(first - move.lo, stop - move.lo)
    columns = (move.eye[part], move.target[part], move.focal[part, None], move.roll[part, None])
    return np.concatenate(columns, axis=1)
