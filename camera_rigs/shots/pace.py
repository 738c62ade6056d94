"""How fast and how far shots move: the ranges that their `_rand` twins draw from."""

import numpy as np

from camera_rigs.scene import Scene, Span, View

Range = tuple[float, float]

RIG_SPEED = 1.5
"""Fastest own movement [m/s] that a planner asks of the camera: a brisk walk with a Steadicam or on a
dolly."""

ANGULAR_SPEED: Range = (np.radians(8.0), np.radians(20.0))
"""Mean |Δφ| per second [rad/s] of arcs: 0.4 to 1.1 m/s at 3 m, a visible but unhurried movement."""

PUSH_PULL_SECONDS = 2.0
"""Time [s] between two keyframes of a random push and pull: shorter ones look like pumping."""

MIN_FRAC_CHANGE = 0.1
"""Least relative change of the radius that is worth a push or a pull."""


def draw(rng: np.random.Generator, limits: Range) -> float:
    """A uniform draw from a range."""
    return float(rng.uniform(*limits))


def radial_reach(span_frames: float, fps: float) -> float:
    """The largest change of radius [m] by a smootherstep over `span_frames` within `RIG_SPEED`.

    The step's top speed is 15/8 of its mean.
    """
    return RIG_SPEED * span_frames / fps / 1.875


def random_fracs(
    rng: np.random.Generator, scene: Scene, span: Span, view: View, calm: float = 1.0
) -> tuple[float, ...]:
    """Fractions in the scale's [frac_min, frac_max] for keyframes about `PUSH_PULL_SECONDS` apart.

    Each is held to what the camera reaches in the time from the one before.
    """
    count = max(1, round(span.length / scene.fps / PUSH_PULL_SECONDS))
    step = span.length / count
    reach = radial_reach(step, scene.fps) * calm
    r, fracs = view.r, []
    for index in range(count):
        time = span.start + (index + 1) * step
        wanted = draw(rng, (view.scale.frac_min, view.scale.frac_max))
        goal, _ = scene.framing(time, wanted, view.theta, view.scale, view.focal)
        r = float(np.clip(goal, r - reach, r + reach))
        fracs.append(scene.fraction(time, r, view.theta, view.scale, view.focal))
    return tuple(fracs)
