"""Drafting: shot after shot, each tried against the rules; a breach is mended, or the shot is replaced.

A draft that breaks a rule is drawn again, calmer each time: a smaller angle, a smaller change of the
radius, the other side. If that does not help another kind of shot takes its place, then the shots before it
are drawn anew, and at last the plan opens from another angle and distance. `Plan.mends` tells all of it.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from camera_rigs.director import Director
from camera_rigs.errors import PlanError
from camera_rigs.joins import compose, transition_half
from camera_rigs.opening import opening_rand
from camera_rigs.path import aimed_path
from camera_rigs.plan import Mend
from camera_rigs.rules import Evidence, Finding, Limits, judge
from camera_rigs.scene import Scene, Span, View
from camera_rigs.shake import Shake
from camera_rigs.shot import Draft
from camera_rigs.shots.catalogue import KINDS

CALM = (1.0, 1.0, 0.6, 0.3)
"""Shares of the usual movement with which the first kind of shot is drawn and redrawn."""

CALM_SUBSTITUTE = (0.6, 0.2)
"""The same for the kinds that replace it."""

BACKTRACKS = 4
"""How often the shots before a dead end are drawn anew, one more each time, before the plan opens anew."""

_NO_ROOM = "no room: "
"""How the reason of a planner that could not plan begins."""

_CONTEXT = 3
"""Frames before a transition that its accelerations and jerks need."""


class Drafting:
    """One attempt at a plan.

    Args:
        rng: where all choices come from.
        scene: the scene.
        director: who chooses the kinds of shot.
        limits: what the rules allow.
        shake: the shake that will be added: the drafts keep clear of everything by as much.
        attempt: number of the attempt, 0 first; it varies the opening.
        last_chance: keep the draft with the fewest breaches where none is without.
    """

    def __init__(
        self,
        rng: np.random.Generator,
        scene: Scene,
        director: Director,
        limits: Limits,
        shake: Shake | None,
        attempt: int,
        *,
        last_chance: bool,
    ) -> None:
        self.rng, self.scene, self.director = rng, scene, director
        self.limits, self.shake, self.attempt, self.last_chance = limits, shake, attempt, last_chance
        self.drafts: list[Draft] = []
        self.mends: list[Mend] = []
        margin = 0.0 if shake is None else shake.bound(0) * float(np.sqrt(3.0))
        self._strict = replace(
            limits,
            ground=limits.ground + margin,
            obstacle=limits.obstacle + margin,
            wall=limits.wall + margin,
            person=limits.person + margin,
        )

    def draft_all(self, spans: list[Span]) -> bool:
        """Draft a shot for every span; False where the opening leads to a dead end."""
        order = self.director.preferences(self.rng, spans[0], None)
        opening = opening_rand(self.rng, self.scene, self.director.style, order[0], self.attempt)
        if self.attempt:
            self.mends.append(Mend(0, "", "opening moved", f"{self.attempt} openings led to a dead end"))
        furthest = stuck = 0
        while len(self.drafts) < len(spans):
            index = len(self.drafts)
            if index > furthest:
                furthest, stuck = index, 0
            if index:
                order = self.director.preferences(self.rng, spans[index], self.drafts[-1].shot.kind)
            draft = self._draft(spans[index], order, opening)
            if draft is not None:
                self.drafts.append(draft)
                continue
            stuck += 1
            if index == 0 or stuck > BACKTRACKS:
                return False
            self._drop(min(index, stuck), spans[index].start)
        return True

    def _drop(self, count: int, frame: int) -> None:
        """Drop the last drafts because no shot goes on from them at `frame`."""
        del self.drafts[-count:]
        index = len(self.drafts)
        self.mends = [mend for mend in self.mends if mend.shot < index]
        self.mends.append(
            Mend(index, "", "drawn anew", f"no shot from frame {frame} on was without a breach")
        )

    def _draft(self, span: Span, order: list[str], opening: View) -> Draft | None:
        """A draft for a span without a breach; None if there is none."""
        view = self._view(span, opening)
        fewest: tuple[int, Draft] | None = None
        dropped: dict[str, str] = {}
        for name, calm in _tries(order):
            if dropped.get(name, "").startswith(_NO_ROOM):
                continue
            try:
                options = self.director.style.options.get(name, {})
                draft = KINDS[name].plan_rand(self.rng, self.scene, span, view, calm=calm, **options)
            except PlanError as error:
                dropped[name] = f"{_NO_ROOM}{error}"
                continue
            findings = self._judge(draft, span)
            if not findings:
                self._record(name, dropped)
                return draft
            dropped.setdefault(name, findings[0].message)
            if fewest is None or len(findings) < fewest[0]:
                fewest = len(findings), draft
        return fewest[1] if self.last_chance and fewest is not None else None

    def _view(self, span: Span, opening: View) -> View:
        """The view that a shot starts from: the opening, or where the shot before has come to."""
        if not self.drafts:
            return opening
        eye, focal = self.drafts[-1].move.at(span.start)
        return View.from_location(self.scene, span.start, eye, opening.scale, focal)

    def _judge(self, draft: Draft, span: Span) -> tuple[Finding, ...]:
        """What the rules find in a draft and in its transition from the shot before."""
        scene, half = self.scene, transition_half(self.scene.fps)
        before = self.drafts[-1:]
        lo = max(span.start - half - _CONTEXT, before[0].move.lo) if before else span.start
        moves = [d.move for d in (*before, draft)]
        move = compose(moves, [span.start] * len(before), lo, span.end, half)
        path = aimed_path(move.eye, move.target, move.focal, move.roll, scene.lens, scene.fps)
        shots = tuple(d.shot for d in (*before, draft))
        return judge(Evidence(path, scene.subject, scene.world, shots, self._strict, first=lo))

    def _record(self, name: str, dropped: dict[str, str]) -> None:
        """Note what was dropped before the draft of kind `name` was found.

        That one kind had no room is nothing to tell while another one that was asked for takes its place.
        """
        for kind, reason in dropped.items():
            if reason.startswith(_NO_ROOM) and name in self.director.cast:
                continue
            action = "redrawn" if kind == name else f"replaced by {name}"
            self.mends.append(Mend(len(self.drafts), kind, action, reason))


def _tries(order: list[str]) -> Iterator[tuple[str, float]]:
    """The kinds of shot to try, each with the share of its usual movement."""
    for rank, name in enumerate(order):
        for calm in CALM if rank == 0 else CALM_SUBSTITUTE:
            yield name, calm
