"""Pan: the camera stays in its place and turns after the people; keyframes by the rule of tracking.

It turns horizontally only, as in the paper, unless the people would climb or sink out of the view.
"""

import numpy as np

from camera_rigs.scene import Scene, Span, View
from camera_rigs.shot import Draft, Move, keyframe_at, record
from camera_rigs.shots.tracking import LAMBDA_OVERLAP, overlap_keyframes
from camera_rigs.spherical import Array, cartesian_to_spherical

TILT_SHARE = 0.2
"""The camera tilts after the people where they would rise or sink by more than this share of the view."""


def plan_pan(
    scene: Scene,
    span: Span,
    view: View,
    *,
    lambda_overlap: float = LAMBDA_OVERLAP,
    tilt: bool | None = None,
) -> Draft:
    """A pan from the place of `view`.

    Args:
        scene, span, view: the scene, the frames and the view at the first frame.
        lambda_overlap: a new keyframe when the boxes overlap by less than this share of their union.
        tilt: whether the camera turns vertically too; None decides by `TILT_SHARE`.
    """
    eye = view.location(scene, span.start)
    anchor = scene.anchor(view.scale, span.frames)
    level = _at_fixed_elevation(eye, anchor, view.theta)
    if tilt is None:
        focal_share = view.focal / scene.lens.height
        _, theta, _ = cartesian_to_spherical(anchor - eye)
        tilt = bool(np.abs(np.tan(theta - (np.pi - view.theta))).max() * focal_share > TILT_SHARE)
    target = anchor if tilt else level
    frames = overlap_keyframes(scene.subject, span.start, span.end, lambda_overlap)
    keyframes = tuple(
        keyframe_at(scene, view.scale, frame, eye, view.focal, target=target[frame - span.lo])
        for frame in frames
    )
    parameters = {"lambda_overlap": lambda_overlap, "tilt": tilt, "radius": view.r}
    shot = record("pan", view.scale, span, parameters, keyframes)
    return Draft(shot, Move.level(span, eye, target, view.focal))


def plan_pan_rand(
    rng: np.random.Generator,
    scene: Scene,
    span: Span,
    view: View,
    *,
    calm: float = 1.0,
    lambda_overlap: tuple[float, float] = (0.4, 0.6),
) -> Draft:
    """A pan with λ_overlap drawn from a range; a calmer one tilts as well, which keeps the people centred."""
    overlap = float(rng.uniform(*lambda_overlap))
    return plan_pan(scene, span, view, lambda_overlap=overlap, tilt=None if calm >= 1.0 else True)


def _at_fixed_elevation(eye: Array, anchor: Array, theta: float) -> Array:
    """The points (N, 3) in the azimuth and distance of the anchor that a camera sees without tilting."""
    away = np.hypot(anchor[:, 0] - eye[0], anchor[:, 1] - eye[1])
    level = anchor.copy()
    level[:, 2] = eye[2] - away / np.tan(theta)
    return level
