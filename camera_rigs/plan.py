"""`Plan`: the shots, the camera path and what the rules found; as plain data for `shot.json`."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from camera_rigs.path import CameraPath
from camera_rigs.rules import Finding
from camera_rigs.shots.base import Keyframe, Shot


@dataclass(frozen=True)
class Mend:
    """What the director changed because a first draft broke a rule."""

    shot: int
    kind: str
    action: str
    finding: Finding


@dataclass(frozen=True)
class Plan:
    """A finished plan.

    Attributes:
        path: the camera per frame.
        shots: the shots in order; neighbours share a frame.
        findings: breaches that are left; empty for a plan that may be rendered.
        mends: what was changed on the way, and why.
        refusals: shots that were asked for and cannot apply to this motion, with the reason.
    """

    path: CameraPath
    shots: tuple[Shot, ...]
    findings: tuple[Finding, ...] = ()
    mends: tuple[Mend, ...] = ()
    refusals: Mapping[str, str] | None = None

    @property
    def ok(self) -> bool:
        """Whether no rule is broken."""
        return not self.findings

    @property
    def keyframes(self) -> tuple[Keyframe, ...]:
        """All keyframes in order of time."""
        return tuple(k for shot in self.shots for k in shot.keyframes)

    def to_json(self) -> dict[str, Any]:
        """The plan as plain numbers, words, lists and dictionaries; angles in radians, lengths in metres."""
        return {
            "shots": [
                {
                    "kind": shot.kind,
                    "scale": shot.scale,
                    "start": shot.start,
                    "end": shot.end,
                    "parameters": dict(shot.parameters),
                    "keyframes": [asdict(k) for k in shot.keyframes],
                }
                for shot in self.shots
            ],
            "findings": [asdict(finding) for finding in self.findings],
            "mends": [asdict(mend) for mend in self.mends],
            "refusals": dict(self.refusals or {}),
        }
