"""Arc: the camera circles the people, keyframes equally spaced in φ (horizontal) or in θ (vertical).

The speed is set by Δφ or Δθ. The facing is that of the first frame: an arc is drawn around where the person looked,
not dragged along by every turn of a dance; its centre travels with the anchor.
"""

from collections.abc import Sequence

import numpy as np

from camera_rigs.shots.base import Keyframe, Move, Scene, Shot, Span, View, at, keyframe, through
from camera_rigs.spherical import Array, spherical_to_cartesian

KEYFRAMES_PER_SECOND = 2.0
"""Keyframes of an arc: the smooth path between them is a straight line in φ or θ, so the number only labels it."""


def plan_arc(
    scene: Scene,
    span: Span,
    view: View,
    *,
    delta_phi: float = 0.0,
    delta_theta: float = 0.0,
    fracs: Sequence[float] = (),
    kind: str = "arc-horizontal",
) -> Shot:
    """An arc from `view` by `delta_phi` or `delta_theta` [rad] over the span.

    Args:
        scene, span, view: the scene, the frames and the view at the first frame.
        delta_phi: angle of the whole horizontal arc, signed.
        delta_theta: angle of the whole vertical arc, signed; negative rises.
        fracs: fractions of the view to reach at times equally spaced after the first frame: push and pull while
            the arc goes on. Empty keeps the distance.
        kind: name under which the shot is listed.
    """
    count = max(2, round(span.length / scene.fps * KEYFRAMES_PER_SECOND) + 1)
    times = span.start + span.length * np.linspace(0.0, 1.0, count)
    r_times, radii = _radii(scene, span, view, fracs, delta_theta)
    heading = float(at(scene.subject.azimuth, span.start))

    def orbit(frames: Array) -> tuple[Array, Array]:
        progress = (frames - span.start) / span.length
        theta, phi = view.theta + delta_theta * progress, view.phi + heading + delta_phi * progress
        anchor = at(scene.subject.anchor(view.scale.anchor), frames)
        return anchor + spherical_to_cartesian(through(r_times, radii, frames), theta, phi), anchor

    eyes, targets = orbit(times)
    asked = dict(zip(r_times[1:], fracs, strict=True))
    keyframes = _keyframes(scene, view, times, eyes, targets, heading)
    extra_times = np.array(sorted(asked))
    if len(extra_times):
        eyes, targets = orbit(extra_times)
        keyframes += tuple(
            keyframe(scene, view.scale, t, e, a, view.focal, heading=heading, frac=asked[t])
            for t, e, a in zip(extra_times, eyes, targets, strict=True)
        )
        keyframes = tuple(sorted(keyframes, key=lambda k: k.frame))
    eye, target = orbit(span.frames)
    parameters = {"delta_phi": delta_phi, "delta_theta": delta_theta, "radius": view.r, "keyframes": count}
    move = Move(span.lo, eye, target, np.full(len(eye), view.focal), np.zeros(len(eye)))
    return Shot(kind, view.scale.name, span.start, span.end, parameters, keyframes, move)


def _radii(
    scene: Scene, span: Span, view: View, fracs: Sequence[float], delta_theta: float
) -> tuple[Array, Array]:
    """Times and radii (n,) of the push and pull along an arc."""
    shares = np.linspace(0.0, 1.0, len(fracs) + 1)
    times = span.start + span.length * shares
    radii = [view.r] + [
        scene.radius(t, frac, view.theta + delta_theta * share, view.scale, view.focal)
        for t, frac, share in zip(times[1:], fracs, shares[1:], strict=True)
    ]
    return times, np.array(radii)


def _keyframes(
    scene: Scene, view: View, times: Array, eyes: Array, targets: Array, heading: float
) -> tuple[Keyframe, ...]:
    return tuple(
        keyframe(scene, view.scale, t, e, a, view.focal, heading=heading)
        for t, e, a in zip(times, eyes, targets, strict=True)
    )
