"""`direct`: the plan of a whole clip, from the people to a camera path that keeps the rules."""

from collections.abc import Sequence

import numpy as np

from camera_rigs.director import Director
from camera_rigs.drafting import Drafting
from camera_rigs.errors import PlanError
from camera_rigs.joins import compose, transition_half
from camera_rigs.lens import Lens
from camera_rigs.path import aimed_path
from camera_rigs.plan import Plan
from camera_rigs.rules import Evidence, Limits, judge
from camera_rigs.scene import Scene, Span
from camera_rigs.shake import Shake, shake_rand, shaken
from camera_rigs.shots.catalogue import KINDS, named_shots, resolve_shots
from camera_rigs.style import Style
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
    named = named_shots(shots)
    return cast, {name: reason for name, reason in reasons.items() if reason and name in named}


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
