"""Dolly zoom: the camera moves in or out while the lens keeps the people as large as they were; K changes."""

import numpy as np

from camera_rigs.errors import PlanError
from camera_rigs.scene import STAND_OFF, Scene, Span, View
from camera_rigs.shot import Draft, Move, keyframe_at, record
from camera_rigs.shots.pace import RIG_SPEED, Range, draw
from camera_rigs.smoothing import at
from camera_rigs.spherical import Array, spherical_to_cartesian

ZOOM_RATIO: Range = (1.25, 1.8)
"""Range of the ratio of the distances, far over near: below it the background does not visibly breathe."""

FOCAL_RATIO: Range = (0.5, 2.0)
"""The focal length stays between these multiples of the lens's own: the range of a 4× zoom."""


def plan_dolly_zoom(scene: Scene, span: Span, view: View, *, radius: float) -> Draft:
    """A dolly zoom from `view` to the distance `radius` [m].

    The focal length follows from the distance so that an upright extent fills one fraction throughout; the
    extent is that of the people, taken evenly from the first to the last frame of the span.
    """
    heading = float(at(scene.subject.azimuth, span.start))
    frac = scene.fraction(span.start, view.r, view.theta, view.scale, view.focal)
    above, below = scene.subject.extent(view.scale.anchor)
    direction = spherical_to_cartesian(1.0, view.theta, view.phi + heading)
    polar = view.scale.measured_from(view.theta)
    sin_e, cos_e = np.cos(polar), np.sin(polar)

    def zoom(frames: Array) -> tuple[Array, Array]:
        progress = span.progress(frames)
        r = view.r + (radius - view.r) * progress
        a, b = ((1.0 - progress) * side[span.start] + progress * side[span.end] for side in (above, below))
        focal = frac * scene.lens.height * (r - a * sin_e) * (r + b * sin_e) / (cos_e * r * (a + b))
        return scene.anchor(view.scale, frames) + r[..., None] * direction, focal

    keyframes = []
    for index, time in enumerate(span.times(np.linspace(0.0, 1.0, 3))):
        location, focal = zoom(np.asarray(time))
        keyframes.append(
            keyframe_at(
                scene,
                view.scale,
                time,
                location,
                float(focal),
                heading=heading,
                frac=None if index == 1 else frac,
            )
        )
    eye, focals = zoom(span.frames)
    parameters = {"radius": view.r, "end_radius": radius, "frac": frac}
    shot = record("dolly-zoom", view.scale, span, parameters, keyframes)
    return Draft(shot, Move.level(span, eye, scene.anchor(view.scale, span.frames), focals))


def plan_dolly_zoom_rand(
    rng: np.random.Generator,
    scene: Scene,
    span: Span,
    view: View,
    *,
    calm: float = 1.0,
    ratio: Range = ZOOM_RATIO,
) -> Draft:
    """A dolly zoom in or out by a ratio drawn from a range, within `RIG_SPEED` and `FOCAL_RATIO`."""
    reach = span.within(RIG_SPEED, scene.fps) * calm
    wanted = 1.0 + (draw(rng, ratio) - 1.0) * calm
    nearest = float(at(scene.subject.reach(view.scale.anchor), span.start)) + STAND_OFF
    zoomed = view.focal / scene.lens.focal
    near = max(view.r / wanted, view.r - reach, nearest, view.r * FOCAL_RATIO[0] / zoomed)
    far = min(view.r * wanted, view.r + reach, view.r * FOCAL_RATIO[1] / zoomed)
    goals = [goal for goal in (near, far) if max(goal / view.r, view.r / goal) > 1.0 + 0.1 * calm]
    if not goals:
        raise PlanError("no dolly zoom: the camera has no room to move in or out")
    return plan_dolly_zoom(scene, span, view, radius=float(goals[int(rng.integers(len(goals)))]))
