"""The director: which shot when, by the rule of the paper; and `direct`, which plans a whole clip.

Static motion (the longest edge of the box of the anchor's path is below λ_bbox) or interactive motion is
filmed with horizontal and vertical arcs with random push and pull; long-distance motion with tracking while
the facing has turned less than λ_angle since the last keyframe, else with a pan.
"""

from collections.abc import Sequence

import numpy as np

from camera_rigs.drafting import Drafting
from camera_rigs.errors import PlanError
from camera_rigs.joins import compose, cut, spans_between, transition_half
from camera_rigs.lens import Lens
from camera_rigs.path import aimed_path
from camera_rigs.plan import Plan
from camera_rigs.rules import Evidence, Limits, judge
from camera_rigs.scene import Scene, Span
from camera_rigs.shake import Shake, shake_rand, shaken
from camera_rigs.shots.catalogue import GROUPS, KINDS, resolve_shots
from camera_rigs.style import REPEAT, Style
from camera_rigs.subject import SubjectTrack
from camera_rigs.world import World

ATTEMPTS = 10
"""Openings that are tried before a plan with breaches is returned."""


def direct(
    subject: SubjectTrack,
    lens: Lens,
    world: World,
    shots: str | Sequence[str],
    rng: np.random.Generator,
    *,
    style: Style | None = None,
    limits: Limits | None = None,
    shake: Shake | None = None,
    interactive: bool | None = None,
) -> Plan:
    """Plan the camera of a whole clip: several movements joined into one path, judged and mended.

    Args:
        subject: the people; planned for to the millimetre.
        lens: the lens at the first frame; only a dolly zoom changes it.
        world: the surroundings.
        shots: "auto" (the movements of the paper), "all", or names of shots, see `resolve_shots`.
        rng: where all choices come from; equal generators give equal plans.
        style: λ, weights and ranges of the choices.
        limits: what the rules allow.
        shake: adds the shake of a hand-held camera.
        interactive: whether the people act on each other; by default whether there are several.

    Returns:
        The plan. `Plan.findings` is empty unless no plan without a breach was found.

    Raises:
        PlanError: a shot is unknown, or none of those asked for can apply to the motion.
    """
    style, limits = style or Style(), limits or Limits()
    scene = Scene(subject.rounded(), lens, world)
    cast, refusals = _cast(scene, shots)
    director = Director(scene, style, cast, subject.num_people > 1 if interactive is None else interactive)
    best: Plan | None = None
    for attempt in range(ATTEMPTS):
        spans = director.spans(rng)
        drafting = Drafting(rng, scene, director, limits, shake, attempt, last_chance=attempt == ATTEMPTS - 1)
        if not drafting.draft_all(spans):
            continue
        plan = _finish(drafting, spans, refusals)
        if best is None or len(plan.findings) < len(best.findings):
            best = plan
        if plan.ok:
            break
    if best is None:
        raise PlanError("no camera was found: give the camera more room or allow more shots")
    return best


def _cast(scene: Scene, shots: str | Sequence[str]) -> tuple[tuple[str, ...], dict[str, str]]:
    """The kinds that can apply to the scene, and the reasons why the others asked for by name cannot."""
    names = resolve_shots(shots)
    reasons = {name: KINDS[name].refusal(scene) for name in names}
    cast = tuple(name for name in names if reasons[name] is None)
    if not cast:
        told = "; ".join(reason for reason in reasons.values() if reason)
        raise PlanError(f"none of the shots asked for can apply: {told}")
    by_group = isinstance(shots, str) and shots in GROUPS
    return cast, {} if by_group else {name: reason for name, reason in reasons.items() if reason}


def _finish(drafting: Drafting, spans: list[Span], refusals: dict[str, str]) -> Plan:
    """Join the drafts, shake the camera, judge the whole."""
    scene, drafts, shake = drafting.scene, drafting.drafts, drafting.shake
    joints = [span.end for span in spans[:-1]]
    moves = [draft.move for draft in drafts]
    move = compose(moves, joints, 0, scene.last, transition_half(scene.fps))
    path = aimed_path(move.eye, move.target, move.focal, move.roll, scene.lens, scene.fps)
    if shake is not None:
        path = shaken(path, *shake_rand(drafting.rng, shake, path.num_frames, path.fps))
    shots = tuple(draft.shot for draft in drafts)
    findings = judge(Evidence(path, scene.subject, scene.world, shots, drafting.limits, shake))
    return Plan(
        path,
        shots,
        scene.subject,
        scene.world,
        drafting.limits,
        shake,
        findings,
        tuple(drafting.mends),
        refusals,
    )


class Director:
    """Chooses the shot for a span of frames.

    Args:
        scene: the scene.
        style: λ and weights.
        cast: kinds that may be used, first choice of the user.
        interactive: whether the people act on each other.
    """

    def __init__(self, scene: Scene, style: Style, cast: Sequence[str], interactive: bool) -> None:
        self.scene, self.style, self.cast, self.interactive = scene, style, tuple(cast), interactive

    def spans(self, rng: np.random.Generator) -> list[Span]:
        """The frames cut into shots; one shot where a single kind that is sustained was asked for."""
        subject = self.scene.subject
        if len(self.cast) == 1 and KINDS[self.cast[0]].sustained:
            return spans_between([0, self.scene.last], subject.fps)
        return cut(subject.num_frames, subject.fps, rng)

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
        weights = self.style.weights[self.situation(span)]
        fitting = {
            name: weights[name] * (REPEAT if name == previous else 1.0)
            for name in self.cast
            if name in weights
        }
        first = _draw_order(rng, fitting)
        others = _draw_order(rng, {name: 1.0 for name in self.cast if name not in fitting})
        substitutes = [name for name in ("arc-horizontal", "push-pull", "tracking") if name not in self.cast]
        return [*first, *others, *substitutes]


def _draw_order(rng: np.random.Generator, weights: dict[str, float]) -> list[str]:
    """The names in an order drawn without replacement, the heavy ones earlier."""
    if not weights:
        return []
    keys = rng.exponential(size=len(weights)) / np.array(list(weights.values()))
    names = list(weights)
    return [names[index] for index in np.argsort(keys)]
