"""What the director decides by: the λ of the paper, the weights of the shots, and how a plan opens."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from camera_rigs.errors import PlanError
from camera_rigs.joins import EASE_SECONDS, MAX_SHOT_SECONDS, MIN_SHOT_SECONDS
from camera_rigs.scene import SCALES
from camera_rigs.shots.catalogue import check_options

STATIC: Mapping[str, float] = {
    "arc-horizontal": 4.0,
    "arc-vertical": 4.0,
    "push-pull": 1.0,
    "push": 0.5,
    "pull": 0.5,
    "orbit": 1.0,
    "boom": 1.0,
    "dolly": 1.0,
    "dolly-zoom": 1.0,
    "static": 1.0,
    "over-shoulder": 2.0,
}
"""Static or interactive motion: horizontal and vertical arcs with random push and pull, as the paper says."""

TRAVELLING: Mapping[str, float] = {
    "tracking": 6.0,
    "arc-vertical": 1.0,
    "push-pull": 1.0,
    "follow": 2.0,
    "dolly": 1.0,
    "boom": 1.0,
}
"""Long-distance motion whose facing is stable: tracking, as the paper says, and one shot in four that
changes the angle or the distance on the way. Without them a tracked walk would be seen from one angle
only."""

TURNING: Mapping[str, float] = {"pan": 6.0, "follow": 2.0, "static": 1.0, "dolly": 1.0}
"""Long-distance motion whose facing turns: pan, as the paper says."""

REPEAT = 0.1
"""Factor on the weight of the kind that static motion was just shown with: arcs mostly alternate."""


@dataclass(frozen=True)
class Style:
    """The choices that the paper leaves open; docs/cameras.md argues for every default.

    Attributes:
        lambda_bbox: a motion is static if the longest edge of the box of the anchor's path is shorter [m].
        lambda_angle: the facing is stable if it has turned less since the last keyframe [rad].
        scales: names of the shot scales that plans open with; each is as likely as the others.
        opening_phi: largest |φ_c| that a plan opens with [rad].
        shot_seconds: shortest and longest shot [s].
        ease_seconds: time in which a movement gathers and loses its speed at a joint [s]; 0 is linear.
        window_seconds: λ_bbox is asked of the anchor's path over the shot and the time around it [s].
        weights: weights of the kinds of shot by situation: "static", "travelling", "turning".
        options: ranges that replace a planner's own, by kind of shot: {"orbit": {"angle": (1.0, 2.0)}}.
    """

    lambda_bbox: float = 1.5
    lambda_angle: float = float(np.radians(45.0))
    scales: tuple[str, ...] = ("full", "medium")
    opening_phi: float = float(np.radians(135.0))
    shot_seconds: tuple[float, float] = (MIN_SHOT_SECONDS, MAX_SHOT_SECONDS)
    ease_seconds: float = EASE_SECONDS
    window_seconds: float = 6.0
    weights: Mapping[str, Mapping[str, float]] = field(
        default_factory=lambda: {"static": STATIC, "travelling": TRAVELLING, "turning": TURNING}
    )
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        unknown = [name for name in self.scales if name not in SCALES]
        check_options(self.options)
        if unknown or not self.scales:
            raise PlanError(f"shot scales {list(self.scales)}: choose from {', '.join(SCALES)}")
        if not MIN_SHOT_SECONDS <= self.shot_seconds[0] <= self.shot_seconds[1]:
            raise PlanError(
                f"shot_seconds {self.shot_seconds}: give at least {MIN_SHOT_SECONDS} s, then no less"
            )
        if not self.ease_seconds >= 0.0:
            raise PlanError(f"ease_seconds {self.ease_seconds}: must not be negative")
