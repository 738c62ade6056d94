"""How fast and how far shots move: the ranges that their `_rand` twins draw from."""

import numpy as np

from camera_rigs.scene import Scene, Span, View
from camera_rigs.smoothing import through
from camera_rigs.spherical import Array

Range = tuple[float, float]

RIG_SPEED = 1.5
"""Fastest own movement [m/s] that a planner asks of the camera: a brisk walk with a Steadicam or a dolly."""

ANGULAR_SPEED: Range = (np.radians(8.0), np.radians(20.0))
"""Mean |Δφ| per second [rad/s] of arcs: 0.4 to 1.1 m/s at 3 m, a visible but unhurried movement."""

PUSH_PULL_SECONDS = 2.0
"""Time [s] between two keyframes of a random push and pull: shorter ones look like pumping."""

MIN_CHANGE = 0.1
"""Least relative change of the radius that is worth a push or a pull, unless the clip is too short for it."""

PULL_ROOM = 1.4
"""How far a pull goes, as a factor on the radius, from people too wide for the fractions of the scale."""


def draw(rng: np.random.Generator, limits: Range) -> float:
    """A uniform draw from a range."""
    return float(rng.uniform(*limits))


def turning_times(span: Span, count: int) -> Array:
    """The times (count + 1,) of keyframes that divide a movement over the span into equal parts."""
    return span.times(np.linspace(0.0, 1.0, count + 1))


def radial(span: Span, radii: Array, frames: Array) -> Array:
    """The radius [m] at `frames` of a camera that runs through `radii` (n + 1,) at `turning_times`.

    From one radius to another it runs evenly, with the cushions of the span; at each of several it turns.
    """
    if len(radii) == 2:
        even: Array = radii[0] + (radii[1] - radii[0]) * span.progress(frames)
        return even
    return through(turning_times(span, len(radii) - 1), radii, frames)


def radial_reach(span: Span, count: int, fps: float) -> float:
    """The largest change of radius [m] between neighbours of `count` + 1 keyframes within `RIG_SPEED`.

    The smootherstep between several keyframes has a top speed of 15/8 of its mean.
    """
    if count == 1:
        return span.within(RIG_SPEED, fps)
    return RIG_SPEED * float(np.diff(turning_times(span, count)).min()) / fps / 1.875


def random_fracs(
    rng: np.random.Generator, scene: Scene, span: Span, view: View, calm: float = 1.0
) -> tuple[float, ...]:
    """Fractions in the scale's [frac_min, frac_max] for keyframes about `PUSH_PULL_SECONDS` apart.

    Each is held to what the camera reaches in the time from the one before.
    """
    count = max(1, round(span.length / scene.fps / PUSH_PULL_SECONDS))
    reach = radial_reach(span, count, scene.fps) * calm
    r, fracs = view.r, []
    for time in turning_times(span, count)[1:]:
        wanted = draw(rng, (view.scale.frac_min, view.scale.frac_max))
        goal, _ = scene.framing(time, wanted, view.theta, view.scale, view.focal)
        r = float(np.clip(goal, r - reach, r + reach))
        fracs.append(scene.fraction(time, r, view.theta, view.scale, view.focal))
    return tuple(fracs)
