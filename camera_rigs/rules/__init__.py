"""What a good plan satisfies. Every rule is a function from `Evidence` to findings; `judge` asks them all."""

from collections.abc import Callable
from dataclasses import dataclass

from camera_rigs.rules import framing, motion, shots, space
from camera_rigs.rules.evidence import Evidence, Finding, Limits

__all__ = ["RULES", "Evidence", "Finding", "Limits", "Rule", "judge"]


@dataclass(frozen=True)
class Rule:
    """A rule: its name in findings, what it demands, and the function that looks for breaches."""

    name: str
    demands: str
    check: Callable[[Evidence], list[Finding]]


def _rule(name: str, check: Callable[[Evidence], list[Finding]]) -> Rule:
    return Rule(name, (check.__doc__ or "").strip(), check)


RULES: tuple[Rule, ...] = (
    _rule("finite", motion.finite),
    _rule("coverage", shots.coverage),
    _rule("look-at", framing.look_at),
    _rule("in-frame", framing.in_frame),
    _rule("occlusion", framing.occlusion),
    _rule("fraction", framing.fraction),
    _rule("radius", shots.radius),
    _rule("equal-spacing", shots.equal_spacing),
    _rule("monotone-angle", shots.monotone),
    _rule("tracking-place", shots.tracking_place),
    _rule("overlap", shots.overlap),
    _rule("fixed-location", shots.fixed_location),
    _rule("horizon", motion.horizon),
    _rule("ground", space.ground),
    _rule("obstacle", space.obstacle),
    _rule("wall", space.wall),
    _rule("person", space.person),
    _rule("speed", motion.speed),
    _rule("acceleration", motion.acceleration),
    _rule("jerk", motion.jerk),
    _rule("turn", motion.turn),
    _rule("zoom", motion.zoom),
)


def judge(evidence: Evidence) -> tuple[Finding, ...]:
    """All findings, at most one a rule and shot. A camera that is not finite is judged by nothing else."""
    broken = motion.finite(evidence)
    if broken:
        return tuple(broken)
    return tuple(finding for rule in RULES[1:] for finding in rule.check(evidence))
