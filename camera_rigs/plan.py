"""`Plan`: the shots, the camera path and what the rules found; as plain data for `shot.json` and back."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from camera_rigs.errors import PlanError
from camera_rigs.path import CameraPath
from camera_rigs.rules import Evidence, Finding, Limits, judge
from camera_rigs.scene import SCALES
from camera_rigs.shake import Shake
from camera_rigs.shot import Keyframe, Shot
from camera_rigs.shots.catalogue import KINDS
from camera_rigs.subject import SubjectTrack
from camera_rigs.world import World

FORMAT = 1
"""Version of the document that `Plan.to_json` returns."""


@dataclass(frozen=True)
class Mend:
    """What the director changed because a draft broke a rule.

    Attributes:
        shot: index of the shot in the plan.
        kind: the kind of the draft that was dropped.
        action: what was done instead: "redrawn", "replaced by …", "drawn anew" (with the shots after it),
            "opening moved".
        reason: the finding's message, or why the planner had no room.
    """

    shot: int
    kind: str
    action: str
    reason: str


@dataclass(frozen=True)
class Plan:
    """A finished plan.

    Attributes:
        path: the camera per frame.
        shots: the shots in order; neighbours share a frame.
        subject, world, limits, shake: what the plan was made for and is judged with.
        findings: breaches that are left; none in a plan that may be rendered.
        mends: what was changed on the way, and why.
        refusals: shots that were asked for and cannot apply to this motion, with the reason.
    """

    path: CameraPath
    shots: tuple[Shot, ...]
    subject: SubjectTrack
    world: World = field(default_factory=World)
    limits: Limits = field(default_factory=Limits)
    shake: Shake | None = None
    findings: tuple[Finding, ...] = ()
    mends: tuple[Mend, ...] = ()
    refusals: Mapping[str, str] = field(default_factory=dict)

    @property
    def ok(self) -> bool:
        """Whether no rule is broken."""
        return not self.findings

    @property
    def keyframes(self) -> tuple[Keyframe, ...]:
        """All keyframes in order of time; shots that share a frame both set one there."""
        return tuple(keyframe for shot in self.shots for keyframe in shot.keyframes)

    def to_json(self) -> dict[str, Any]:
        """The plan as plain numbers, words, lists and dictionaries; angles [rad], lengths [m], the path
        excluded.

        With the arrays of the path this is all that `judge_document` needs.
        """
        return {
            "format": FORMAT,
            "shots": [asdict(shot) for shot in self.shots],
            "findings": [asdict(finding) for finding in self.findings],
            "mends": [asdict(mend) for mend in self.mends],
            "refusals": dict(self.refusals),
            "limits": self.limits.to_json(),
            "shake": None if self.shake is None else asdict(self.shake),
            "world": self.world.to_json(),
            "subject": self.subject.to_json(),
        }


def evidence_from_document(
    document: Mapping[str, Any],
    K: ArrayLike,
    T_world_camera: ArrayLike,
    width: int,
    height: int,
    *,
    limits: Limits | None = None,
) -> Evidence:
    """What the rules judge, from the dictionary of a `shot.json` and the arrays of a `camera.npz`.

    Args:
        document: what `Plan.to_json` returned.
        K: intrinsics (T, 3, 3) [px].
        T_world_camera: camera to world (T, 4, 4) [m].
        width, height: image size [px].
        limits: limits of one's own; by default those of the document.

    Raises:
        PlanError: an entry is missing or of a wrong type, or the lengths differ.
    """
    if document.get("format") != FORMAT:
        raise PlanError(f"plan of format {document.get('format')!r}: this version reads format {FORMAT}")
    try:
        subject = SubjectTrack.from_json(document["subject"])
        world = World.from_json(document["world"])
        shots = tuple(Shot.from_json(entry) for entry in document["shots"])
        shake = None if document["shake"] is None else Shake(**document["shake"])
        limits = Limits(**document["limits"]) if limits is None else limits
    except (KeyError, TypeError) as error:
        raise PlanError(f"plan: {error!r}: an entry is missing or of a wrong type, plan anew") from error
    if not shots:
        raise PlanError("plan: it holds no shots, plan anew")
    for shot in shots:
        if shot.kind not in KINDS or shot.scale not in SCALES:
            raise PlanError(f"plan: shot {shot.kind!r} of scale {shot.scale!r} is unknown, plan anew")
    path = CameraPath(
        np.asarray(K, float), np.asarray(T_world_camera, float), subject.fps, int(width), int(height)
    )
    if path.num_frames != subject.num_frames:
        raise PlanError(
            f"the camera has {path.num_frames} frames, its plan {subject.num_frames}: they do not belong"
        )
    return Evidence(path, subject, world, shots, limits, shake)


def judge_document(
    document: Mapping[str, Any],
    K: ArrayLike,
    T_world_camera: ArrayLike,
    width: int,
    height: int,
    *,
    limits: Limits | None = None,
) -> tuple[Finding, ...]:
    """The findings of `judge` on a stored plan; arguments and errors as in `evidence_from_document`."""
    return judge(evidence_from_document(document, K, T_world_camera, width, height, limits=limits))
