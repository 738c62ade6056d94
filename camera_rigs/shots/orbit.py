"""Orbit: a horizontal arc by a given angle, up to a full turn, at one distance."""

import numpy as np

from camera_rigs.scene import Scene, Span, View
from camera_rigs.shot import Draft
from camera_rigs.shots.arc import plan_arc
from camera_rigs.shots.pace import Range, draw

ORBIT_SPEED = 2.5
"""Fastest mean movement [m/s] on the circle: that of a camera car on a circular track, faster than a walk."""

ORBIT_ANGLE: Range = (np.radians(90.0), np.radians(360.0))
"""Range [rad] of the angle; what the speed does not allow in the time is cut off."""


def plan_orbit(scene: Scene, span: Span, view: View, *, angle: float) -> Draft:
    """An orbit from `view` by `angle` [rad], signed, over the span."""
    return plan_arc(scene, span, view, delta_phi=angle, kind="orbit")


def plan_orbit_rand(
    rng: np.random.Generator,
    scene: Scene,
    span: Span,
    view: View,
    *,
    calm: float = 1.0,
    angle: Range = ORBIT_ANGLE,
) -> Draft:
    """An orbit to either side by an angle drawn from a range, as far as `ORBIT_SPEED` lets it."""
    reach = span.within(ORBIT_SPEED, scene.fps) / (view.r * np.sin(view.theta))
    wanted = min(draw(rng, angle), float(reach)) * calm
    return plan_orbit(scene, span, view, angle=float(rng.choice([-1.0, 1.0])) * wanted)
