"""Where a plan opens: the shot scale, the angle, the side and the distance of its first camera."""

from collections.abc import Mapping

import numpy as np

from camera_rigs.scene import SCALES, STAND_OFF, Scene, View
from camera_rigs.shots.arc import ANGLES, polar_angle_rand
from camera_rigs.shots.over_shoulder import over_shoulder_view_rand
from camera_rigs.shots.pace import Range, draw
from camera_rigs.smoothing import at
from camera_rigs.style import Style

ANGLE_WEIGHTS = {"high": 0.25, "eye": 0.5, "low": 0.25}
"""How often a plan opens at a high, an eye-level and a low angle."""

PLACES = 12
"""Places that are drawn before one is taken that is not clear."""

RADIUS_FACTORS = (1.0, 1.0, 0.75, 1.3, 0.55, 1.8)
"""Factors on the distance, by the number of the attempt: a room may be too small or a view too narrow."""

FRAC_SHARES: Mapping[str, Range] = {"push": (0.0, 0.3), "pull": (0.7, 1.0)}
"""The part of [frac_min, frac_max] in which a shot opens: a push from afar, a pull from near."""

CLEARANCE = 0.25
"""Least distance [m] of the first camera to obstacles and walls."""


def opening_rand(rng: np.random.Generator, scene: Scene, style: Style, kind: str, attempt: int) -> View:
    """A view to open a plan with, clear of obstacles and walls, the people not hidden.

    Args:
        rng: where the choices come from.
        scene: the scene.
        style: shot scales and the range of φ_c.
        kind: the shot that is to follow; one over a shoulder opens there.
        attempt: number of the attempt, 0 first; later ones come nearer or stand back.
    """
    if kind == "over-shoulder":
        return over_shoulder_view_rand(rng, scene, scene.lens.focal)
    factor = RADIUS_FACTORS[attempt % len(RADIUS_FACTORS)]
    view = _draw(rng, scene, style, kind, factor)
    for _ in range(PLACES):
        if _clear(scene, view):
            return view
        view = _draw(rng, scene, style, kind, factor)
    return view


def _draw(rng: np.random.Generator, scene: Scene, style: Style, kind: str, factor: float) -> View:
    scale = SCALES[style.scales[int(rng.integers(len(style.scales)))]]
    name = str(rng.choice(list(ANGLE_WEIGHTS), p=list(ANGLE_WEIGHTS.values())))
    theta, focal = polar_angle_rand(rng, scale, ANGLES[name]), scene.lens.focal
    low, high = FRAC_SHARES.get(kind, (0.0, 1.0))
    frac = scale.frac_min + draw(rng, (low, high)) * (scale.frac_max - scale.frac_min)
    r, _ = scene.framing(0, frac, theta, scale, focal)
    r = max(r * factor, float(at(scene.subject.reach(scale.anchor), 0)) + STAND_OFF)
    theta = min(theta, scene.lowest_theta(0, min(round(2.0 * scene.fps), scene.last), r, scale))
    phi = draw(rng, (-style.opening_phi, style.opening_phi))
    return View(scale, r, theta, phi, focal)


def _clear(scene: Scene, view: View) -> bool:
    eye = view.location(scene, 0)
    gap = min(float(scene.world.obstacle_distance(eye)), float(scene.world.wall_distance(eye)))
    hidden = scene.world.hides(eye, scene.anchor(view.scale, 0))
    return gap >= CLEARANCE and not bool(hidden)
