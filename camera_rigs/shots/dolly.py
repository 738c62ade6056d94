"""Dolly: the camera rolls along a straight level track laid in the world and looks at the people."""

import numpy as np

from camera_rigs.scene import Scene, Span, View
from camera_rigs.shot import Draft, Move, keyframe_at, record
from camera_rigs.shots.pace import RIG_SPEED, Range, draw
from camera_rigs.spherical import Array

DOLLY_DISTANCE: Range = (0.5, 3.0)
"""Range [m] of the way along the track: one to three lengths of common track."""

TRAVELLED = 0.5
"""People who cover more than this [m] get a track along their way; others one across the view."""


def plan_dolly(scene: Scene, span: Span, view: View, *, azimuth: float, distance: float) -> Draft:
    """A dolly from `view` by `distance` [m] along the world azimuth `azimuth` [rad]."""
    start = view.location(scene, span.start)
    along = distance * np.array([np.cos(azimuth), np.sin(azimuth), 0.0])

    def place(frames: Array) -> Array:
        return start + span.progress(frames)[..., None] * along

    times = span.times(np.linspace(0.0, 1.0, 3))
    keyframes = tuple(keyframe_at(scene, view.scale, t, place(t), view.focal) for t in times)
    parameters = {"azimuth": azimuth, "distance": distance, "radius": view.r}
    shot = record("dolly", view.scale, span, parameters, keyframes)
    move = Move.level(span, place(span.frames), scene.anchor(view.scale, span.frames), view.focal)
    return Draft(shot, move)


def plan_dolly_rand(
    rng: np.random.Generator,
    scene: Scene,
    span: Span,
    view: View,
    *,
    calm: float = 1.0,
    distance: Range = DOLLY_DISTANCE,
) -> Draft:
    """A dolly beside people who travel, as far as they do; else across the view, to either side."""
    way = scene.anchor(view.scale, span.end) - scene.anchor(view.scale, span.start)
    length = float(np.hypot(way[0], way[1]))
    if length > TRAVELLED:
        return plan_dolly(scene, span, view, azimuth=float(np.arctan2(way[1], way[0])), distance=length)
    offset = view.location(scene, span.start) - scene.anchor(view.scale, span.start)
    across = float(np.arctan2(offset[1], offset[0]) + rng.choice([-1.0, 1.0]) * np.pi / 2.0)
    reach = min(draw(rng, distance), span.within(RIG_SPEED, scene.fps)) * calm
    return plan_dolly(scene, span, view, azimuth=across, distance=float(reach))
