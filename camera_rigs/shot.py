"""What a shot planner returns: the shot as a record, and its move, a camera per frame."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from camera_rigs.errors import PlanError
from camera_rigs.scene import Scale, Scene, Span
from camera_rigs.smoothing import at
from camera_rigs.spherical import Array, cartesian_to_spherical, wrap

Parameter = float | int | str | bool | list[float]
Point = tuple[float, float, float]


@dataclass(frozen=True)
class Keyframe:
    """A camera set by a planner: when and where, in the human-centric frame and in the world.

    Attributes:
        frame: time as a frame index; keyframes equally spaced in angle fall between frames.
        r, theta, phi: human-centric place [m, rad, rad], φ counted from the facing (φ_c).
        heading: azimuth φ_facing that φ is counted from [rad].
        location: place in the world [m].
        target: point looked at [m].
        focal: focal length [px].
        frac: fraction of the height of the view that the people fill here; None where the shot asks for none.
    """

    frame: float
    r: float
    theta: float
    phi: float
    heading: float
    location: Point
    target: Point
    focal: float
    frac: float | None = None


@dataclass(frozen=True)
class Shot:
    """One planned camera movement, as a record.

    Attributes:
        kind: name of the shot.
        scale: name of the shot scale.
        start, end: first and last frame; neighbouring shots share one.
        parameters: what the planner was told, plain numbers and words.
        keyframes: the keyframes it set.
    """

    kind: str
    scale: str
    start: int
    end: int
    parameters: Mapping[str, Parameter]
    keyframes: tuple[Keyframe, ...]

    def number(self, name: str) -> float:
        """The parameter `name`; `PlanError` where it is missing or no number."""
        value = self.parameters.get(name)
        if not isinstance(value, int | float):
            raise PlanError(f"{self.kind} from frame {self.start}: parameter {name!r} is missing, plan anew")
        return float(value)

    @classmethod
    def from_json(cls, document: Mapping[str, Any]) -> "Shot":
        """The shot of its entry in `Plan.to_json`."""
        try:
            keyframes = tuple(_keyframe_from_json(entry) for entry in document["keyframes"])
            start, end = int(document["start"]), int(document["end"])
            kind, scale = str(document["kind"]), str(document["scale"])
            return cls(kind, scale, start, end, dict(document["parameters"]), keyframes)
        except (KeyError, TypeError, ValueError) as error:
            raise PlanError(f"shot: {error!r}: an entry is missing or of a wrong type") from error


def _keyframe_from_json(entry: Mapping[str, Any]) -> Keyframe:
    frame, r, theta, phi, heading = (float(entry[n]) for n in ("frame", "r", "theta", "phi", "heading"))
    x, y, z = (float(value) for value in entry["location"])
    u, v, w = (float(value) for value in entry["target"])
    frac = entry.get("frac")
    fraction = None if frac is None else float(frac)
    focal = float(entry["focal"])
    return Keyframe(frame, r, theta, phi, heading, (x, y, z), (u, v, w), focal, fraction)


@dataclass(frozen=True)
class Move:
    """A camera from frame `lo` on: eye, target (N, 3) [m], focal length [px] and roll [rad] (N,)."""

    lo: int
    eye: Array
    target: Array
    focal: Array
    roll: Array

    @classmethod
    def level(cls, span: Span, eye: Array, target: Array, focal: float | Array) -> "Move":
        """A move over `span` with a level horizon and one focal length, or one a frame."""
        count = len(span.frames)
        shape = (count, 3)
        eye, target = np.broadcast_to(eye, shape), np.broadcast_to(target, shape)
        return cls(span.lo, eye, target, np.broadcast_to(np.asarray(focal, float), (count,)), np.zeros(count))

    def at(self, frame: int) -> tuple[Array, float]:
        """The location (3,) [m] and the focal length [px] at a frame."""
        return self.eye[frame - self.lo], float(self.focal[frame - self.lo])


@dataclass(frozen=True)
class Draft:
    """A shot together with its move: what every planner returns."""

    shot: Shot
    move: Move


def record(
    kind: str,
    scale: Scale,
    span: Span,
    parameters: Mapping[str, Parameter],
    keyframes: Iterable[Keyframe],
) -> Shot:
    """The shot over a span, without keyframes after it: in a clip of one frame no movement ends."""
    inside = tuple(keyframe for keyframe in keyframes if keyframe.frame <= span.end)
    return Shot(kind, scale.name, span.start, span.end, parameters, inside)


def keyframe_at(
    scene: Scene,
    scale: Scale,
    frame: float,
    location: Array,
    focal: float,
    *,
    target: Array | None = None,
    heading: float | None = None,
    frac: float | None = None,
) -> Keyframe:
    """The keyframe of a camera at `location` (3,) that looks at `target`, by default at the anchor.

    φ_c is counted from `heading` [rad], by default from the facing at the frame.
    """
    anchor = scene.anchor(scale, frame)
    target = anchor if target is None else target
    r, theta, phi = cartesian_to_spherical(location - anchor)
    facing = float(at(scene.subject.azimuth, frame)) if heading is None else heading
    x, y, z = (float(value) for value in location)
    u, v, w = (float(value) for value in target)
    place = (float(r), float(theta), float(wrap(phi - facing)))
    return Keyframe(float(frame), *place, facing, (x, y, z), (u, v, w), float(focal), frac)
