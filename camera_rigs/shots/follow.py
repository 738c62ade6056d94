"""Follow: the camera travels with the people at a fixed place relative to their way, and looks ahead of them.

It turns with the direction of travel, not with the facing, heavily smoothed, so that it swings into a new
direction instead of whipping round.
"""

import numpy as np

from camera_rigs.scene import Scene, Span, View
from camera_rigs.shot import Draft, Move, keyframe_at, record
from camera_rigs.shots.pace import RIG_SPEED, Range, draw
from camera_rigs.smoothing import at, smooth
from camera_rigs.spherical import Array, spherical_to_cartesian

LOOK_AHEAD: Range = (0.2, 0.5)
"""Range [s] of the look-ahead: operators leave a walker a quarter of a metre of room in front, or more."""

MAX_LEAD = 0.5
"""Furthest lead [m] before the anchor, so that a runner stays in the view."""

MAX_SWING = np.radians(30.0)
"""Fastest swing [rad/s] about the people into a new direction."""

SWING_SMOOTHING = 0.5
"""Standard deviation [s] of the low-pass of the swing and of the look-ahead."""


def plan_follow(scene: Scene, span: Span, view: View, *, look_ahead: float = 0.35) -> Draft:
    """A follow from the place of `view`, aimed where the people will be in `look_ahead` [s]."""
    anchor = scene.anchor(view.scale, span.frames)
    heading = _followed_way(scene, span, min(MAX_SWING, RIG_SPEED / view.r))
    here = float(heading[span.start - span.lo])
    phi = view.phi + float(at(scene.subject.azimuth, span.start)) - here
    eye = anchor + spherical_to_cartesian(view.r, view.theta, phi + heading)
    target = anchor + _lead(scene, span, look_ahead)
    frames = [span.start] if span.start == span.end else [span.start, span.end]
    keyframes = tuple(
        keyframe_at(
            scene,
            view.scale,
            frame,
            eye[frame - span.lo],
            view.focal,
            target=target[frame - span.lo],
            heading=float(heading[frame - span.lo]),
        )
        for frame in frames
    )
    parameters = {"look_ahead": look_ahead, "radius": view.r, "theta": view.theta, "phi": phi}
    shot = record("follow", view.scale, span, parameters, keyframes)
    return Draft(shot, Move.level(span, eye, target, view.focal))


def plan_follow_rand(
    rng: np.random.Generator,
    scene: Scene,
    span: Span,
    view: View,
    *,
    calm: float = 1.0,
    look_ahead: Range = LOOK_AHEAD,
) -> Draft:
    """A follow with the look-ahead drawn from a range."""
    return plan_follow(scene, span, view, look_ahead=draw(rng, look_ahead) * calm)


def _followed_way(scene: Scene, span: Span, swing: float) -> Array:
    """Azimuth (N,) [rad] of the way that the people go, no faster than `swing` [rad/s]."""
    way = scene.subject.travel_azimuth[span.lo : span.hi + 1]
    rate = np.clip(np.diff(way), -swing / scene.fps, swing / scene.fps)
    return smooth(np.concatenate([way[:1], way[0] + np.cumsum(rate)]), SWING_SMOOTHING, scene.fps)


def _lead(scene: Scene, span: Span, look_ahead: float) -> Array:
    """How far (N, 3) [m] the camera aims before the anchor, level and softly limited to `MAX_LEAD`."""
    lead = look_ahead * scene.subject.velocity[span.lo : span.hi + 1]
    lead[:, 2] = 0.0
    length = np.linalg.norm(lead, axis=-1, keepdims=True)
    limited: Array = lead / np.sqrt(1.0 + (length / MAX_LEAD) ** 2)
    return smooth(limited, SWING_SMOOTHING, scene.fps)
