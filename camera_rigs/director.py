"""The director: which shot when, by the rule of the paper.

Static motion (the longest edge of the box of the anchor's path is below λ_bbox) or interactive motion is
filmed with horizontal and vertical arcs with random push and pull; long-distance motion with tracking while
the facing has turned less than λ_angle since the last keyframe, else with a pan.
"""

from dataclasses import dataclass

import numpy as np

from camera_rigs.joins import cut, spans_between
from camera_rigs.scene import Scene, Span
from camera_rigs.shots.catalogue import KINDS
from camera_rigs.style import REPEAT, Style

SUBSTITUTES = ("arc-horizontal", "push-pull", "tracking")
"""Movements that replace those asked for where none of these keeps the rules; all can hold still."""


@dataclass(frozen=True)
class Director:
    """Chooses the shot for a span of frames.

    Attributes:
        scene: the scene.
        style: λ and weights.
        cast: the kinds of shot that were asked for and can apply.
        interactive: whether the people act on each other.
    """

    scene: Scene
    style: Style
    cast: tuple[str, ...]
    interactive: bool

    def spans(self, rng: np.random.Generator) -> list[Span]:
        """The frames cut into shots; one shot where a single kind that is sustained was asked for."""
        subject, style = self.scene.subject, self.style
        if len(self.cast) == 1 and KINDS[self.cast[0]].sustained:
            return spans_between([0, self.scene.last], subject.fps)
        return cut(
            subject.num_frames,
            subject.fps,
            rng,
            shot_seconds=style.shot_seconds,
            ease_seconds=style.ease_seconds,
        )

    def situation(self, span: Span) -> str:
        """What the paper's rule says of the motion in a span: "static", "travelling" or "turning"."""
        if self.interactive or self.travel(span) < self.style.lambda_bbox:
            return "static"
        return "travelling" if self.turned(span) < self.style.lambda_angle else "turning"

    def travel(self, span: Span) -> float:
        """The longest edge [m] of the box of the anchor's path over the span and the time around it."""
        subject = self.scene.subject
        margin = max(0, round(0.5 * (self.style.window_seconds * subject.fps - span.length)))
        path = subject.smooth_pelvis[max(span.start - margin, 0) : span.end + margin + 1]
        return float(np.ptp(path, axis=0).max())

    def turned(self, span: Span) -> float:
        """How far [rad] the facing turns over the span from where it is at the keyframe that begins it."""
        azimuth = self.scene.subject.azimuth[span.start : span.end + 1]
        return float(np.abs(azimuth - azimuth[0]).max())

    def preferences(self, rng: np.random.Generator, span: Span, previous: str | None) -> list[str]:
        """The kinds to try for a span, best first.

        The kinds that the rule names for the situation come first, drawn by their weights; then the others
        of the cast; and last, as substitutes, the movements of the paper that nobody asked for.
        """
        situation = self.situation(span)
        weights = self.style.weights[situation]
        fitting = {
            name: weights[name] * (REPEAT if (name, situation) == (previous, "static") else 1.0)
            for name in self.cast
            if name in weights
        }
        first = _draw_order(rng, fitting)
        others = _draw_order(rng, {name: 1.0 for name in self.cast if name not in fitting})
        substitutes = [name for name in SUBSTITUTES if name not in self.cast]
        return [*first, *others, *substitutes]


def _draw_order(rng: np.random.Generator, weights: dict[str, float]) -> list[str]:
    """The names in an order drawn without replacement, the heavy ones earlier."""
    if not weights:
        return []
    keys = rng.exponential(size=len(weights)) / np.array(list(weights.values()))
    names = list(weights)
    return [names[index] for index in np.argsort(keys)]
