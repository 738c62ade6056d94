"""What every shot is made of: the scene it films, the view it starts from, its keyframes and its move."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from camera_rigs.lens import Lens, framing_radius
from camera_rigs.smoothing import smootherstep
from camera_rigs.spherical import Array, cartesian_to_spherical, spherical_to_cartesian, wrap
from camera_rigs.subject import SubjectTrack
from camera_rigs.world import World

Parameter = float | int | str | bool

WIDTH_SHARE = 0.9
"""The people span at most this share of the width of the view; the camera stands back where the height asks less."""

SHOULDER = 0.3
"""Half width [m] kept around every neck in medium shots and close-ups."""


@dataclass(frozen=True)
class Scale:
    """A shot scale of the paper: which joint is the anchor and which fraction of the view the person's height fills.

    A fraction above 1 shows a part of the person: at 1.4 of the view the neck-centred frame reaches the thighs.
    """

    name: str
    anchor: str
    frac_min: float
    frac_max: float


SCALES: Mapping[str, Scale] = {
    scale.name: scale
    for scale in (
        Scale("long", "pelvis", 0.25, 0.45),
        Scale("full", "pelvis", 0.55, 0.8),
        Scale("medium", "neck", 1.1, 1.6),
        Scale("close-up", "neck", 2.0, 3.0),
    )
}


@dataclass(frozen=True)
class Scene:
    """Everything a shot planner knows: the people, the lens and the surroundings."""

    subject: SubjectTrack
    lens: Lens
    world: World = field(default_factory=World)

    @property
    def fps(self) -> float:
        """Frames per second."""
        return self.subject.fps

    def radius(
        self, frame: float, frac: float, theta: float, scale: Scale, focal: float | None = None
    ) -> float:
        """The distance [m] at which the people fill `frac` of the height of the view at `frame`.

        The extent `SubjectTrack.height` is laid around the anchor as the box lies around it, and `WIDTH_SHARE` of the
        width must hold everybody: the whole box in full and long shots, necks and shoulders in the closer ones.
        """
        subject = self.subject
        lens = self.lens if focal is None else Lens(self.lens.width, self.lens.height, focal)
        above, below = self.extent(frame, scale)
        width = at(subject.span, frame)
        if scale.anchor == "neck":
            width = 2.0 * (at(subject.spread, frame) + SHOULDER)
        by_height = framing_radius(above, below, frac, theta, lens)
        by_width = lens.focal * float(width) / (WIDTH_SHARE * lens.width)
        return float(np.maximum(by_height, by_width))

    def extent(self, frame: ArrayLike, scale: Scale) -> tuple[Array, Array]:
        """How far [m] the framed extent reaches above and below the anchor of `scale` at `frame`."""
        height = at(self.subject.height, frame)
        share = ANCHOR_HEIGHT[scale.anchor]
        return (1.0 - share) * height, share * height


ANCHOR_HEIGHT: Mapping[str, float] = {"pelvis": 0.55, "neck": 0.86}
"""Height of the anchor as a share of the stature of a standing person."""


def at(signal: Array, frame: ArrayLike) -> Array:
    """`signal` (T, …) at frames between and beyond its own: linear inside, held outside."""
    frame = np.clip(np.asarray(frame, float), 0.0, len(signal) - 1.0)
    before = np.minimum(frame.astype(int), max(len(signal) - 2, 0))
    after = np.minimum(before + 1, len(signal) - 1)
    part = (frame - before).reshape(frame.shape + (1,) * (signal.ndim - 1))
    value: Array = (1.0 - part) * signal[before] + part * signal[after]
    return value


@dataclass(frozen=True)
class View:
    """A camera at one moment in the human-centric frame: the scale, (r, θ_c, φ_c) and the focal length [px]."""

    scale: Scale
    r: float
    theta: float
    phi: float
    focal: float

    def location(self, scene: Scene, frame: float) -> Array:
        """The camera's place (3,) in the world at `frame` [m]."""
        heading = at(scene.subject.azimuth, frame)
        return at(scene.subject.anchor(self.scale.anchor), frame) + spherical_to_cartesian(
            self.r, self.theta, self.phi + heading
        )

    @classmethod
    def from_location(cls, scene: Scene, frame: float, eye: Array, scale: Scale, focal: float) -> "View":
        """The view that a camera at `eye` (3,) [m] has of the people at `frame`."""
        anchor = at(scene.subject.anchor(scale.anchor), frame)
        r, theta, phi = cartesian_to_spherical(eye - anchor)
        return cls(scale, float(r), float(theta), float(wrap(phi - at(scene.subject.azimuth, frame))), focal)


@dataclass(frozen=True)
class Span:
    """The frames of a shot, first and last, and those around it over which its move is needed for the transitions."""

    start: int
    end: int
    lo: int
    hi: int

    @property
    def frames(self) -> Array:
        """Frames lo … hi over which a move is laid out."""
        return np.arange(self.lo, self.hi + 1, dtype=float)

    @property
    def length(self) -> int:
        """Number of frame steps, at least 1 so that a one-frame clip divides by something."""
        return max(self.end - self.start, 1)

    @property
    def progress(self) -> Array:
        """0 at the first frame, 1 at the last, below and above in the transitions."""
        return (self.frames - self.start) / self.length


@dataclass(frozen=True)
class Keyframe:
    """A camera set by a planner: where and when, in the human-centric frame and in the world.

    Attributes:
        frame: time as a frame index; equally spaced keyframes fall between frames.
        r, theta, phi: human-centric place [m, rad, rad], φ counted from the facing (φ_c).
        heading: azimuth of the facing φ_facing that the keyframe was set with [rad].
        location: place in the world (3,) [m].
        target: point looked at (3,) [m].
        focal: focal length [px].
        frac: fraction of the view asked for, None where the shot asks for none.
    """

    frame: float
    r: float
    theta: float
    phi: float
    heading: float
    location: tuple[float, float, float]
    target: tuple[float, float, float]
    focal: float
    frac: float | None = None


@dataclass(frozen=True)
class Move:
    """A camera from frame `lo` on: location and target (N, 3) [m], focal length (N,) [px], roll (N,) [rad]."""

    lo: int
    eye: Array
    target: Array
    focal: Array
    roll: Array


@dataclass(frozen=True)
class Shot:
    """One planned camera movement.

    Attributes:
        kind: name of the shot.
        scale: name of the shot scale.
        start, end: first and last frame; neighbouring shots share a frame.
        parameters: what the planner was told, plain numbers and words.
        keyframes: the keyframes it set.
        move: the camera over the frames of the shot and its transitions.
    """

    kind: str
    scale: str
    start: int
    end: int
    parameters: Mapping[str, Parameter]
    keyframes: tuple[Keyframe, ...]
    move: Move


def keyframe(
    scene: Scene,
    scale: Scale,
    frame: float,
    location: Array,
    target: Array,
    focal: float,
    *,
    heading: float | None = None,
    frac: float | None = None,
) -> Keyframe:
    """The keyframe of a camera at `location` that looks at `target`; `heading` is the facing at the frame by default."""
    r, theta, phi = cartesian_to_spherical(location - at(scene.subject.anchor(scale.anchor), frame))
    facing = float(at(scene.subject.azimuth, frame)) if heading is None else heading
    x, y, z = (float(v) for v in location)
    u, v, w = (float(v) for v in target)
    return Keyframe(
        float(frame),
        float(r),
        float(theta),
        float(wrap(phi - facing)),
        facing,
        (x, y, z),
        (u, v, w),
        focal,
        frac,
    )


def through(times: ArrayLike, values: ArrayLike, frames: Array) -> Array:
    """`values` at `times` joined by smoothersteps: no overshoot, at rest at every keyframe, held outside.

    Velocity and acceleration are continuous, and every value is met exactly.
    """
    times, values = np.asarray(times, float), np.asarray(values, float)
    if len(times) == 1:
        return np.broadcast_to(values[0], (len(frames), *values.shape[1:])).copy()
    index = np.clip(np.searchsorted(times, frames, side="right") - 1, 0, len(times) - 2)
    u = smootherstep((frames - times[index]) / np.maximum(times[index + 1] - times[index], 1e-9))
    u = u.reshape(u.shape + (1,) * (values.ndim - 1))
    joined: Array = (1.0 - u) * values[index] + u * values[index + 1]
    return joined
