"""Tracking: the camera keeps its place (r, θ_c, φ_c) in the human-centric frame while the people travel.

A new keyframe is set when the overlap of the present box with the box at the last keyframe falls *below*
λ_overlap. The paper prints "greater than λ_overlap", which would set keyframes while a person stands still
and none once the person has walked away.
"""

import itertools

import numpy as np

from camera_rigs.scene import Scene, Span, View
from camera_rigs.shot import Draft, Move, keyframe_at, record
from camera_rigs.shots.pace import RIG_SPEED
from camera_rigs.smoothing import at, smooth
from camera_rigs.spherical import Array, spherical_to_cartesian
from camera_rigs.subject import SubjectTrack

LAMBDA_OVERLAP = 0.5
"""λ_overlap: half of the box is left behind about once a step, as often as an operator corrects."""

MIN_KEYFRAME_SECONDS = 0.5
"""Least time [s] between keyframes: a runner leaves the box faster than an operator corrects."""

MAX_TURN = np.radians(30.0)
"""Fastest turn [rad/s] of the camera about the people while it follows the facing."""

TURN_SMOOTHING = 0.5
"""Standard deviation [s] over which the turns at the keyframes are rounded off."""


def plan_tracking(
    scene: Scene,
    span: Span,
    view: View,
    *,
    lambda_overlap: float = LAMBDA_OVERLAP,
    max_turn: float = MAX_TURN,
) -> Draft:
    """Tracking from `view` over the span: (r, θ_c, φ_c) is the same at every keyframe.

    Between keyframes the camera travels with the smoothed anchor, and turns with the facing from one to the
    next.

    Args:
        scene, span, view: the scene, the frames and the view at the first frame.
        lambda_overlap: a new keyframe when the boxes overlap by less than this share of their union.
        max_turn: fastest turn about the people [rad/s]; 0 keeps the direction in the world.
    """
    subject = scene.subject
    frames = overlap_keyframes(subject, span.start, span.end, lambda_overlap)
    turn = min(max_turn, RIG_SPEED / view.r)
    followed = _followed_heading(subject, frames, span, turn)
    phi = view.phi + float(at(subject.azimuth, span.start)) - float(followed[span.start - span.lo])
    target = scene.anchor(view.scale, span.frames)
    eye = target + spherical_to_cartesian(view.r, view.theta, phi + followed)
    keyframes = tuple(
        keyframe_at(
            scene,
            view.scale,
            frame,
            eye[frame - span.lo],
            view.focal,
            heading=float(followed[frame - span.lo]),
        )
        for frame in frames
    )
    parameters = {
        "lambda_overlap": lambda_overlap,
        "max_turn": turn,
        "radius": view.r,
        "theta": view.theta,
        "phi": phi,
    }
    shot = record("tracking", view.scale, span, parameters, keyframes)
    return Draft(shot, Move.level(span, eye, target, view.focal))


def plan_tracking_rand(
    rng: np.random.Generator,
    scene: Scene,
    span: Span,
    view: View,
    *,
    calm: float = 1.0,
    lambda_overlap: tuple[float, float] = (0.4, 0.6),
) -> Draft:
    """Tracking with λ_overlap drawn from a range; `calm` is the share of the usual turn with the facing."""
    overlap = float(rng.uniform(*lambda_overlap))
    return plan_tracking(scene, span, view, lambda_overlap=overlap, max_turn=MAX_TURN * calm)


def overlap_keyframes(subject: SubjectTrack, start: int, end: int, lambda_overlap: float) -> list[int]:
    """Frames of the keyframe rule from `start` to `end`; the first and the last are always keyframes."""
    gap = min_keyframe_gap(subject.fps)
    frames = [start]
    while (fresh := departure(subject, frames[-1], frames[-1] + gap, end, lambda_overlap)) is not None:
        frames.append(fresh)
    return frames if frames[-1] == end else [*frames, end]


def min_keyframe_gap(fps: float) -> int:
    """`MIN_KEYFRAME_SECONDS` in frames, at least one."""
    return max(1, round(MIN_KEYFRAME_SECONDS * fps))


def departure(subject: SubjectTrack, last: int, begin: int, end: int, lambda_overlap: float) -> int | None:
    """First frame from `begin` to `end` whose box overlaps that of `last` by less than λ, or None."""
    block = 16
    while begin <= end:
        stop = min(begin + block, end + 1)
        away = np.flatnonzero(box_overlap(subject, last, begin, stop) < lambda_overlap)
        if len(away):
            return begin + int(away[0])
        begin, block = stop, 2 * block
    return None


def box_overlap(subject: SubjectTrack, last: int, begin: int, stop: int) -> Array:
    """Intersection over union (n,) of the boxes of frames `begin` … `stop` − 1 with that of `last`."""
    low = np.maximum(subject.box_min[begin:stop], subject.box_min[last])
    high = np.minimum(subject.box_max[begin:stop], subject.box_max[last])
    common = np.maximum(high - low, 0.0).prod(axis=-1)
    sizes = (subject.box_max[begin:stop] - subject.box_min[begin:stop]).prod(axis=-1)
    union = sizes + (subject.box_max[last] - subject.box_min[last]).prod() - common
    return np.where(union > 0.0, common / np.where(union > 0.0, union, 1.0), 1.0)


def _followed_heading(subject: SubjectTrack, frames: list[int], span: Span, turn: float) -> Array:
    """The azimuth (N,) [rad] that the camera turns with: the facing at the keyframes, as far as `turn` lets
    it.

    Mirrored at both ends of the shot, it is at rest there: a transition takes over without a change of
    direction.
    """
    headings = [float(subject.azimuth[frames[0]])]
    for before, now in itertools.pairwise(frames):
        reach = turn * (now - before) / subject.fps
        headings.append(headings[-1] + float(np.clip(subject.azimuth[now] - headings[-1], -reach, reach)))
    inside = np.arange(span.start, span.end + 1, dtype=float)
    turned = smooth(np.interp(inside, frames, headings), TURN_SMOOTHING, subject.fps, travels=False)
    mirrored = np.abs(span.frames - span.start)
    mirrored = (span.end - span.start) - np.abs(span.end - span.start - mirrored)
    return at(turned, mirrored)
