"""The one list of shots: name, planner, and how each relates to the people."""

import inspect
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from camera_rigs.errors import PlanError
from camera_rigs.scene import Scene, Span, View
from camera_rigs.shot import Draft
from camera_rigs.shots import (
    arc,
    boom,
    dolly,
    dolly_zoom,
    follow,
    orbit,
    over_shoulder,
    pan,
    push_pull,
    static,
    tracking,
)


class PlannerRand(Protocol):
    """A `_rand` twin: draws its parameters and plans; raises `PlanError` where the shot has no room."""

    def __call__(
        self, rng: np.random.Generator, scene: Scene, span: Span, view: View, *, calm: float
    ) -> Draft: ...


@dataclass(frozen=True)
class Kind:
    """A kind of shot.

    Attributes:
        name: as users type it and `shot.json` holds it.
        plan_rand: the planner's `_rand` twin.
        aim: what the camera looks at: the anchor, its azimuth only, or a point of its own.
        travels: whether the camera travels with the people, or stands or runs in the world.
        from_paper: whether the paper names the movement.
        sustained: a clip that is to show this kind alone is one long shot: a second push finds no way to
            go, and a second tripod is a cut.
        min_travel: the people must cover this much [m] for the shot to make sense.
        refuse: further reasons why the shot cannot apply to a scene.
        summary: one line for help texts and tables.
    """

    name: str
    plan_rand: PlannerRand
    summary: str
    aim: Literal["anchor", "azimuth", "own"] = "anchor"
    travels: bool = True
    from_paper: bool = False
    sustained: bool = False
    min_travel: float = 0.0
    refuse: Callable[[Scene], str | None] = lambda scene: None

    @property
    def settles(self) -> bool:
        """Whether a transition to another shot of this sort passes exactly through their common keyframe."""
        return self.travels and self.aim == "anchor"

    def refusal(self, scene: Scene) -> str | None:
        """Why the shot cannot apply to the people, or None."""
        covered = float(np.ptp(scene.subject.smooth_pelvis[:, :2], axis=0).max())
        if covered < self.min_travel:
            return f"{self.name} needs people who cover {self.min_travel} m, these cover {covered:.2f} m"
        return self.refuse(scene)


MIN_TRAVEL = 0.5
"""Way [m] that people must cover for a shot that goes after them: less is swaying on the spot."""

KINDS: Mapping[str, Kind] = {
    kind.name: kind
    for kind in (
        Kind("arc-horizontal", arc.plan_arc_horizontal_rand, "circles the people", from_paper=True),
        Kind("arc-vertical", arc.plan_arc_vertical_rand, "rises or sinks on a circle", from_paper=True),
        Kind("push", push_pull.plan_push_rand, "moves in", from_paper=True, sustained=True),
        Kind("pull", push_pull.plan_pull_rand, "moves out", from_paper=True, sustained=True),
        Kind("push-pull", push_pull.plan_push_pull_rand, "moves in and out", from_paper=True),
        Kind(
            "tracking",
            tracking.plan_tracking_rand,
            "keeps its place beside people who travel",
            from_paper=True,
            min_travel=MIN_TRAVEL,
        ),
        Kind(
            "pan",
            pan.plan_pan_rand,
            "stays and turns after people who travel",
            aim="azimuth",
            travels=False,
            from_paper=True,
            min_travel=MIN_TRAVEL,
        ),
        Kind("static", static.plan_static_rand, "on a tripod", aim="own", travels=False, sustained=True),
        Kind("orbit", orbit.plan_orbit_rand, "circles by a given angle, up to a full turn"),
        Kind("boom", boom.plan_boom_rand, "rises or sinks upright on a crane"),
        Kind("dolly", dolly.plan_dolly_rand, "rolls along a straight track", travels=False),
        Kind("dolly-zoom", dolly_zoom.plan_dolly_zoom_rand, "moves while the lens holds the size"),
        Kind(
            "follow",
            follow.plan_follow_rand,
            "travels along and looks ahead",
            aim="own",
            min_travel=MIN_TRAVEL,
        ),
        Kind(
            "over-shoulder",
            over_shoulder.plan_over_shoulder_rand,
            "past the shoulder of one of a pair",
            aim="own",
            refuse=over_shoulder.refuse_over_shoulder,
        ),
    )
}

PAPER = tuple(name for name, kind in KINDS.items() if kind.from_paper)
"""The movements of the paper, in its order: what `auto` chooses from."""

GROUPS: Mapping[str, Sequence[str]] = {
    "auto": PAPER,
    "all": tuple(KINDS),
    "arc": ("arc-horizontal", "arc-vertical"),
}
"""Names that stand for several shots."""


def check_options(options: Mapping[str, Mapping[str, object]]) -> None:
    """Raise `PlanError` unless every option names a kind of shot and a range of its `_rand` twin."""
    for name, ranges in options.items():
        if name not in KINDS:
            raise PlanError(f"options for shot {name!r}: choose from {', '.join(KINDS)}")
        known = [p for p in inspect.signature(KINDS[name].plan_rand).parameters if p not in _COMMON]
        for option in ranges:
            if option not in known:
                raise PlanError(f"option {option!r} of shot {name!r}: it has {', '.join(known) or 'none'}")


_COMMON = ("rng", "scene", "span", "view", "calm")
"""Arguments that every `_rand` twin takes."""


def named_shots(shots: str | Iterable[str]) -> tuple[str, ...]:
    """The words of `shots`, a comma list or a sequence of names."""
    return tuple(word.strip() for word in (shots.split(",") if isinstance(shots, str) else shots))


def resolve_shots(shots: str | Iterable[str]) -> tuple[str, ...]:
    """The kinds that `shots` names: kinds and `GROUPS`, in a comma list or a sequence.

    Raises:
        PlanError: a name is unknown, or none is given.
    """
    names: dict[str, None] = {}
    for word in named_shots(shots):
        if word not in GROUPS and word not in KINDS:
            raise PlanError(f"shot {word!r} is unknown: choose from {', '.join((*GROUPS, *KINDS))}")
        names.update(dict.fromkeys(GROUPS.get(word, (word,))))
    if not names:
        raise PlanError(f"no shot is named: choose from {', '.join((*GROUPS, *KINDS))}")
    return tuple(names)
