"""Push and pull: r falls or grows so that the people fill a wanted fraction of the view.

Random fractions in [frac_min, frac_max] at the keyframes give the continuous push-pull of dance films.
"""

from collections.abc import Sequence

import numpy as np

from camera_rigs.errors import PlanError
from camera_rigs.scene import Scene, Span, View
from camera_rigs.shot import Draft, Move, Parameter, keyframe_at, record
from camera_rigs.shots.pace import MIN_CHANGE, PULL_ROOM, RIG_SPEED, draw, radial, random_fracs, turning_times
from camera_rigs.smoothing import at
from camera_rigs.spherical import spherical_to_cartesian


def plan_push(scene: Scene, span: Span, view: View, *, frac: float) -> Draft:
    """A push to the fraction `frac` of the view, which must bring the camera nearer."""
    return _plan(scene, span, view, [frac], "push")


def plan_pull(scene: Scene, span: Span, view: View, *, frac: float) -> Draft:
    """A pull to the fraction `frac` of the view, which must take the camera away."""
    return _plan(scene, span, view, [frac], "pull")


def plan_push_pull(scene: Scene, span: Span, view: View, *, fracs: Sequence[float]) -> Draft:
    """A push and pull through `fracs` at equal parts of the span."""
    return _plan(scene, span, view, fracs, "push-pull")


def _plan(scene: Scene, span: Span, view: View, fracs: Sequence[float], kind: str) -> Draft:
    """The camera runs through the radii of `fracs`, its direction from the anchor fixed in the world."""
    heading = float(at(scene.subject.azimuth, span.start))
    times = turning_times(span, len(fracs))
    framed = [
        scene.framing(time, frac, view.theta, view.scale, view.focal)
        for time, frac in zip(times[1:], fracs, strict=True)
    ]
    radii = np.array([view.r] + [r for r, _ in framed])
    if kind == "push" and radii[-1] >= view.r:
        raise PlanError(f"a push to {fracs[0]:.2f} of the view would move away from the people: use a pull")
    if kind == "pull" and radii[-1] <= view.r:
        raise PlanError(f"a pull to {fracs[0]:.2f} of the view would move towards the people: use a push")
    direction = spherical_to_cartesian(1.0, view.theta, view.phi + heading)
    reached: list[float | None] = [None, *(frac for _, frac in framed)]
    keyframes = tuple(
        keyframe_at(
            scene,
            view.scale,
            t,
            scene.anchor(view.scale, t) + r * direction,
            view.focal,
            heading=heading,
            frac=f,
        )
        for t, r, f in zip(times, radii, reached, strict=True)
    )
    parameters: dict[str, Parameter] = {
        "radius": view.r,
        "fracs": [frac for _, frac in framed],
        "theta": view.theta,
        "phi": view.phi,
    }
    target = scene.anchor(view.scale, span.frames)
    eye = target + radial(span, radii, span.frames)[:, None] * direction
    shot = record(kind, view.scale, span, parameters, keyframes)
    return Draft(shot, Move.level(span, eye, target, view.focal))


def plan_push_rand(
    rng: np.random.Generator, scene: Scene, span: Span, view: View, *, calm: float = 1.0
) -> Draft:
    """A push to a random fraction between the present one and the scale's frac_max."""
    return plan_push(scene, span, view, frac=_other_frac(rng, scene, span, view, calm, nearer=True))


def plan_pull_rand(
    rng: np.random.Generator, scene: Scene, span: Span, view: View, *, calm: float = 1.0
) -> Draft:
    """A pull to a random fraction between the present one and the scale's frac_min."""
    return plan_pull(scene, span, view, frac=_other_frac(rng, scene, span, view, calm, nearer=False))


def plan_push_pull_rand(
    rng: np.random.Generator, scene: Scene, span: Span, view: View, *, calm: float = 1.0
) -> Draft:
    """A push and pull through random fractions in the scale's [frac_min, frac_max]."""
    return plan_push_pull(scene, span, view, fracs=random_fracs(rng, scene, span, view, calm))


def _other_frac(
    rng: np.random.Generator, scene: Scene, span: Span, view: View, calm: float, *, nearer: bool
) -> float:
    """A fraction that moves the camera by at least `MIN_CHANGE` of its distance, one way, and in time.

    Where the width of the people keeps the camera from filling the view, `PULL_ROOM` is the room of a pull.
    """
    bound = view.scale.frac_max if nearer else view.scale.frac_min
    limit, reached = scene.framing(span.end, bound, view.theta, view.scale, view.focal)
    if not nearer and reached < 0.99 * bound:
        limit = max(limit, PULL_ROOM * view.r)
    reach = span.within(RIG_SPEED, scene.fps) * calm
    least = min(MIN_CHANGE * view.r, 0.5 * reach)
    room = (view.r - limit) if nearer else (limit - view.r)
    if min(room, reach) < least:
        word = "nearer" if nearer else "further away"
        raise PlanError(f"no push or pull: the {view.scale.name} shot leaves no room to move {word}")
    change = draw(rng, (least, min(room, reach)))
    r = view.r - change if nearer else view.r + change
    return scene.fraction(span.end, r, view.theta, view.scale, view.focal)
