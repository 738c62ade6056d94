"""Boom (crane): the camera rises or sinks upright while it keeps its horizontal distance to the people."""

import numpy as np

from camera_rigs.errors import PlanError
from camera_rigs.scene import HEADROOM_OVER_GROUND, THETA_MAX, Scene, Span, View
from camera_rigs.shot import Draft, Move, keyframe_at, record
from camera_rigs.shots.pace import RIG_SPEED, Range, draw
from camera_rigs.spherical import Array

BOOM_HEIGHT: Range = (0.4, 2.0)
"""Range [m] of the rise or fall: from a jib to a small crane."""

MIN_BOOM = 0.1
"""Least change of height [m] worth the name."""


def plan_boom(scene: Scene, span: Span, view: View, *, height: float) -> Draft:
    """A boom from `view` up (positive) or down by `height` [m], looking at the anchor."""
    start = view.location(scene, span.start)
    offset = start - scene.anchor(view.scale, span.start)

    def place(frames: Array) -> Array:
        spot = scene.anchor(view.scale, frames) + offset
        spot[..., 2] = start[2] + height * span.progress(frames)
        return spot

    times = span.times(np.linspace(0.0, 1.0, 3))
    keyframes = tuple(keyframe_at(scene, view.scale, t, place(t), view.focal) for t in times)
    parameters = {"height": height, "radius": view.r}
    shot = record("boom", view.scale, span, parameters, keyframes)
    move = Move.level(span, place(span.frames), scene.anchor(view.scale, span.frames), view.focal)
    return Draft(shot, move)


def plan_boom_rand(
    rng: np.random.Generator,
    scene: Scene,
    span: Span,
    view: View,
    *,
    calm: float = 1.0,
    height: Range = BOOM_HEIGHT,
) -> Draft:
    """A boom up or down by a random height, within `RIG_SPEED` and between the steepest angles."""
    start = view.location(scene, span.start)
    anchor_z = scene.anchor(view.scale, span.frames)[:, 2]
    ring = view.r * np.sin(view.theta)
    lowest = max(
        scene.world.ground_z + HEADROOM_OVER_GROUND, float(anchor_z.max() + ring / np.tan(THETA_MAX))
    )
    highest = float(anchor_z.min() + ring / np.tan(view.scale.theta_min))
    reach = min(draw(rng, height), span.within(RIG_SPEED, scene.fps)) * calm
    up, down = min(reach, highest - start[2]), min(reach, start[2] - lowest)
    if max(up, down) < MIN_BOOM * calm:
        raise PlanError("no boom: the camera has no room to rise or sink")
    rises = up >= MIN_BOOM * calm and (down < MIN_BOOM * calm or rng.random() < 0.5)
    return plan_boom(scene, span, view, height=float(up if rises else -down))
