"""Tracking: the camera keeps its place (r, θ_c, φ_c) in the human-centric frame while the people travel.

A new keyframe is set when the overlap of the present box with the box at the last keyframe falls *below* λ_overlap.
The paper prints "greater than λ_overlap", which would set keyframes while a person stands still and never once the
person has walked away.
"""

import numpy as np

from camera_rigs.shots.base import Move, Scene, Shot, Span, View, at, keyframe, through
from camera_rigs.spherical import spherical_to_cartesian
from camera_rigs.subject import SubjectTrack

LAMBDA_OVERLAP = 0.5
"""λ_overlap: half of the box left behind is about a step of a walk, the rhythm at which a dolly grip corrects."""

MIN_KEYFRAME_SECONDS = 0.5
"""Keyframes of a runner would follow each other in a tenth of a second: no operator corrects faster than this."""

MAX_TURN = np.radians(60.0)
"""Fastest turn [rad/s] of the camera about the person while it follows the facing."""


def plan_tracking(scene: Scene, span: Span, view: View, *, lambda_overlap: float = LAMBDA_OVERLAP) -> Shot:
    """Tracking from `view` over the span: (r, θ_c, φ_c) is the same at every keyframe.

    Between keyframes the camera travels with the smoothed anchor and follows the facing from keyframe to keyframe.

    Args:
        scene, span, view: the scene, the frames and the view at the first frame.
        lambda_overlap: a new keyframe when the boxes overlap by less than this share of their union.
    """
    subject = scene.subject
    frames = overlap_keyframes(subject, span.start, span.end, lambda_overlap)
    headings = _followed_headings(subject, frames)
    anchors = subject.anchor(view.scale.anchor)
    heading = through(frames, headings, span.frames)
    target = at(anchors, span.frames)
    eye = target + spherical_to_cartesian(view.r, view.theta, view.phi + heading)
    keyframes = []
    for frame, facing in zip(frames, headings, strict=True):
        location = anchors[frame] + spherical_to_cartesian(view.r, view.theta, view.phi + facing)
        keyframes.append(
            keyframe(scene, view.scale, frame, location, anchors[frame], view.focal, heading=float(facing))
        )
    parameters = {"lambda_overlap": lambda_overlap, "radius": view.r, "theta": view.theta, "phi": view.phi}
    move = Move(span.lo, eye, target, np.full(len(eye), view.focal), np.zeros(len(eye)))
    return Shot("tracking", view.scale.name, span.start, span.end, parameters, tuple(keyframes), move)


def overlap_keyframes(subject: SubjectTrack, start: int, end: int, lambda_overlap: float) -> list[int]:
    """Frames of the keyframe rule from `start` to `end`, the first and the last included."""
    gap = max(1, round(MIN_KEYFRAME_SECONDS * subject.fps))
    frames = [start]
    while frames[-1] + gap < end:
        fresh = _first_departure(subject, frames[-1], frames[-1] + gap, end, lambda_overlap)
        if fresh is None or fresh > end - gap:
            break
        frames.append(fresh)
    return frames if end == start else [*frames, end]


def _first_departure(
    subject: SubjectTrack, last: int, begin: int, end: int, lambda_overlap: float
) -> int | None:
    """First frame from `begin` to `end` whose box overlaps that of `last` by less than λ, searched in doubling steps."""
    block = 16
    while begin <= end:
        stop = min(begin + block, end + 1)
        away = np.flatnonzero(box_overlap(subject, last, begin, stop) < lambda_overlap)
        if len(away):
            return begin + int(away[0])
        begin, block = stop, 2 * block
    return None


def box_overlap(subject: SubjectTrack, last: int, begin: int, stop: int) -> np.ndarray:
    """Intersection over union (n,) of the boxes of frames `begin` … `stop` − 1 with the box of frame `last`."""
    low = np.maximum(subject.box_min[begin:stop], subject.box_min[last])
    high = np.minimum(subject.box_max[begin:stop], subject.box_max[last])
    common = np.maximum(high - low, 0.0).prod(axis=-1)
    sizes = (subject.box_max[begin:stop] - subject.box_min[begin:stop]).prod(axis=-1)
    union = sizes + (subject.box_max[last] - subject.box_min[last]).prod() - common
    overlap: np.ndarray = np.where(union > 0.0, common / np.where(union > 0.0, union, 1.0), 1.0)
    return overlap


def _followed_headings(subject: SubjectTrack, frames: list[int]) -> np.ndarray:
    """Azimuths (n,) [rad] of the keyframes: the facing, as far as `MAX_TURN` lets the camera follow it."""
    headings = [float(subject.azimuth[frames[0]])]
    for before, now in zip(frames[:-1], frames[1:], strict=True):
        reach = MAX_TURN * (now - before) / subject.fps
        headings.append(headings[-1] + float(np.clip(subject.azimuth[now] - headings[-1], -reach, reach)))
    return np.array(headings)
