"""Arc: the camera circles the people; keyframes equally spaced in φ (horizontal) or in θ (vertical).

The speed is set by Δφ or Δθ. φ_facing is the facing at the first frame: an arc is drawn around where the
person looked and not dragged along by every turn of a dance. Its centre travels with the anchor.
"""

from collections.abc import Sequence

import numpy as np

from camera_rigs.errors import PlanError
from camera_rigs.scene import Scale, Scene, Span, View
from camera_rigs.shot import Draft, Move, Parameter, keyframe_at, record
from camera_rigs.shots.pace import ANGULAR_SPEED, RIG_SPEED, Range, draw, radial, random_fracs
from camera_rigs.smoothing import at
from camera_rigs.spherical import Array, spherical_to_cartesian

KEYFRAMES_PER_SECOND = 2.0
"""Keyframes of an arc. The path between them is even in angle, so that their number only labels it."""

ANGLES: dict[str, Range] = {
    "high": (np.radians(45.0), np.radians(70.0)),
    "eye": (np.radians(80.0), np.radians(92.0)),
    "low": (np.radians(96.0), np.radians(106.0)),
}
"""Polar angles [rad] of high, eye-level and low angles, between which vertical arcs pass."""

MIN_RISE = np.radians(8.0)
"""Least change of the polar angle [rad] that a vertical arc goes for."""


def plan_arc(
    scene: Scene,
    span: Span,
    view: View,
    *,
    delta_phi: float = 0.0,
    delta_theta: float = 0.0,
    fracs: Sequence[float] = (),
    kind: str = "arc-horizontal",
) -> Draft:
    """An arc from `view` by `delta_phi` or `delta_theta` [rad] over the span.

    Args:
        scene, span, view: the scene, the frames and the view at the first frame.
        delta_phi: angle of the whole horizontal arc, signed.
        delta_theta: angle of the whole vertical arc, signed; negative rises.
        fracs: fractions of the view reached one after the other, at equal parts of the arc: a push and pull
            along it. Without any the distance is kept.
        kind: name under which the shot is listed.

    Raises:
        PlanError: both angles are given; keyframes are equally spaced in one of the two.
    """
    if delta_phi and delta_theta:
        raise PlanError("an arc is horizontal or vertical: give delta_phi or delta_theta, not both")
    heading = float(at(scene.subject.azimuth, span.start))
    radii, reached = _radii(scene, span, view, fracs, delta_theta)

    def place(frames: Array) -> Array:
        progress = span.progress(frames)
        offset = spherical_to_cartesian(
            radial(span, radii, frames),
            view.theta + delta_theta * progress,
            view.phi + heading + delta_phi * progress,
        )
        return scene.anchor(view.scale, frames) + offset

    parts = max(1, round(span.length / scene.fps * KEYFRAMES_PER_SECOND))
    each = -(-parts // max(len(fracs), 1))  # every fraction falls on a keyframe
    times = span.times(np.linspace(0.0, 1.0, each * max(len(fracs), 1) + 1))
    asked = dict(zip(range(each, len(times), each), reached, strict=False))
    keyframes = [
        keyframe_at(scene, view.scale, time, place(time), view.focal, heading=heading, frac=asked.get(index))
        for index, time in enumerate(times)
    ]
    parameters: dict[str, Parameter] = {
        "delta_phi": delta_phi,
        "delta_theta": delta_theta,
        "radius": view.r,
        "fracs": reached,
    }
    move = Move.level(span, place(span.frames), scene.anchor(view.scale, span.frames), view.focal)
    return Draft(record(kind, view.scale, span, parameters, keyframes), move)


def _radii(
    scene: Scene, span: Span, view: View, fracs: Sequence[float], delta_theta: float
) -> tuple[Array, list[float]]:
    """Radii (n + 1,) and fractions (n,) of the push and pull along an arc."""
    radii, reached = [view.r], []
    for index, frac in enumerate(fracs, start=1):
        share = index / len(fracs)
        time, theta = float(span.times(np.asarray(share))), view.theta + delta_theta * share
        r, achieved = scene.framing(time, frac, theta, view.scale, view.focal)
        radii.append(r)
        reached.append(achieved)
    return np.array(radii), reached


def plan_arc_horizontal_rand(
    rng: np.random.Generator,
    scene: Scene,
    span: Span,
    view: View,
    *,
    calm: float = 1.0,
    angular_speed: Range = ANGULAR_SPEED,
    push_pull: float = 0.5,
) -> Draft:
    """A horizontal arc to either side.

    Args:
        rng: where the choices come from.
        scene, span, view: as for `plan_arc`.
        calm: share of the usual movement.
        angular_speed: range of the mean |Δφ| per second [rad/s]; a far camera is held to `RIG_SPEED`.
        push_pull: probability that the arc pushes and pulls at the same time.
    """
    ring = view.r * np.sin(view.theta)
    reach = span.within(RIG_SPEED, scene.fps) / ring
    angle = min(draw(rng, angular_speed) * span.length / scene.fps, reach) * calm
    fracs = random_fracs(rng, scene, span, view, calm) if rng.random() < push_pull else ()
    return plan_arc(scene, span, view, delta_phi=float(rng.choice([-1.0, 1.0]) * angle), fracs=fracs)


def polar_angle_rand(rng: np.random.Generator, scale: Scale, limits: Range) -> float:
    """A polar angle [rad] out of `limits` that is not steeper than `scale` allows."""
    low, high = (max(limit, scale.theta_min) for limit in limits)
    return draw(rng, (low, high))


def plan_arc_vertical_rand(
    rng: np.random.Generator,
    scene: Scene,
    span: Span,
    view: View,
    *,
    calm: float = 1.0,
    angles: dict[str, Range] | None = None,
    push_pull: float = 0.5,
) -> Draft:
    """A vertical arc towards a high, an eye-level or a low angle, whichever the camera is not at.

    Args:
        rng: where the choices come from.
        scene, span, view: as for `plan_arc`.
        calm: share of the usual movement.
        angles: ranges of the polar angle [rad] to go to, by name; the ground ends a low angle.
        push_pull: probability that the arc pushes and pulls at the same time.
    """
    lowest = scene.lowest_theta(span.lo, span.hi, view.r, view.scale)
    ranges = (angles or ANGLES).values()
    goals = [min(polar_angle_rand(rng, view.scale, limits), lowest) for limits in ranges]
    goals = [goal for goal in goals if abs(goal - view.theta) > MIN_RISE]
    if not goals:
        raise PlanError("no vertical arc: the ground leaves no other angle")
    theta = goals[int(rng.integers(len(goals)))]
    reach = span.within(RIG_SPEED, scene.fps) / view.r
    delta = float(np.clip(theta - view.theta, -reach, reach)) * calm
    fracs = random_fracs(rng, scene, span, view, calm) if rng.random() < push_pull else ()
    return plan_arc(scene, span, view, delta_theta=delta, fracs=fracs, kind="arc-vertical")
