"""Static: a camera on a tripod, neither moved nor turned."""

import numpy as np

from camera_rigs.scene import Scene, Span, View
from camera_rigs.shot import Draft, Move, keyframe_at, record


def plan_static(scene: Scene, span: Span, view: View, *, drift: float = 1.0) -> Draft:
    """A static camera at the place of `view`.

    Args:
        scene, span, view: the scene, the frames and the view at the first frame.
        drift: where the camera looks between the anchor at the first frame (0) and the middle of the anchor's
            path over the span (1).
    """
    eye = view.location(scene, span.start)
    path = scene.anchor(view.scale, np.arange(span.start, span.end + 1, dtype=float))
    middle = 0.5 * (path.min(axis=0) + path.max(axis=0))
    target = (1.0 - drift) * path[0] + drift * middle
    frames = [span.start] if span.start == span.end else [span.start, span.end]
    keyframes = tuple(
        keyframe_at(scene, view.scale, frame, eye, view.focal, target=target) for frame in frames
    )
    parameters = {"radius": view.r, "theta": view.theta, "phi": view.phi, "drift": drift}
    shot = record("static", view.scale, span, parameters, keyframes)
    return Draft(shot, Move.level(span, eye, target, view.focal))


def plan_static_rand(
    rng: np.random.Generator, scene: Scene, span: Span, view: View, *, calm: float = 1.0
) -> Draft:
    """A static camera that looks anywhere between where the people start and the middle of their path."""
    return plan_static(scene, span, view, drift=float(rng.uniform(1.0 - calm, 1.0)))
