"""The scene a shot is planned in; the shot scales; the view; the span of frames."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from camera_rigs.lens import Lens, achieved_fraction, framing_radius
from camera_rigs.smoothing import at, cushioned, heading_of, smooth
from camera_rigs.spherical import Array, cartesian_to_spherical, spherical_to_cartesian, wrap
from camera_rigs.subject import SubjectTrack
from camera_rigs.world import World

WIDTH_SHARE = 0.9
"""The people span at most this share of the width of the view, or the camera stands back."""

HEAD = 0.15
"""Half width [m] kept around every neck in medium shots and close-ups: no head is cut."""

STAND_OFF = 0.5
"""Nearest distance [m] of a planned camera to the furthest reach of the people."""

HEADROOM_OVER_GROUND = 0.25
"""Lowest planned camera [m] over the ground: the height of a camera on a low-angle plate."""

THETA_MIN = float(np.radians(35.0))
"""Steepest planned high angle: 55° over the horizon. Beyond it film speaks of a top shot."""

THETA_MIN_CLOSER = float(np.radians(62.0))
"""Steepest planned high angle of medium shots and close-ups: 28° over the horizon. Steeper ones show the top
of a head before bare ground."""

THETA_MAX = np.radians(112.0)
"""Steepest planned low angle: 22° under the horizon; the ground mostly ends it earlier."""


PAIR_DISTANCE = (0.4, 4.0)
"""Distances [m] between two people that make a pair: nearer they embrace, further away one is a spot."""

MAX_CIRCLING = np.radians(30.0)
"""Fastest turn [rad/s] of a camera about a pair while the two turn about each other."""


@dataclass(frozen=True)
class Scale:
    """A shot scale of the paper: the joint that is the anchor, and the range of the fraction of the view.

    The fraction is that of the whole height of the person. Above 1 a part is seen: at 1.4 a frame centred
    on the neck reaches from over the head to the thighs.

    Full and long shots fill it as projected, from any angle. Closer shots fill it as seen from eye level, and
    keep that distance at other angles: legs out of the view, foreshortened from above, would draw a camera
    at 40° to within 0.8 m of the neck, and a medium shot would be a close-up.
    """

    name: str
    anchor: str
    frac_min: float
    frac_max: float

    @property
    def theta_min(self) -> float:
        """The polar angle [rad] of the steepest planned high angle."""
        return THETA_MIN if self.anchor == "pelvis" else THETA_MIN_CLOSER

    def measured_from(self, theta: Array | float) -> Array | float:
        """The polar angle [rad] at which the fraction holds for a camera at `theta`."""
        return theta if self.anchor == "pelvis" else np.pi / 2.0


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

    @cached_property
    def last(self) -> int:
        """Index of the last frame."""
        return self.subject.num_frames - 1

    def anchor(self, scale: Scale, frames: Array | float) -> Array:
        """The anchor (…, 3) [m] of `scale` at `frames` (…)."""
        return at(self.subject.anchor(scale.anchor), frames)

    @cached_property
    def pair_azimuth(self) -> Array:
        """Azimuth (T,) [rad] from the second person to the first, no faster than `MAX_CIRCLING`."""
        first, second = self.subject.smooth_people_neck[:2, :, :2]
        length = np.linalg.norm(first - second, axis=-1, keepdims=True)
        azimuth = heading_of((first - second) / np.maximum(length, PAIR_DISTANCE[0]), 0.5, self.fps)
        rate = np.clip(np.diff(azimuth), -MAX_CIRCLING / self.fps, MAX_CIRCLING / self.fps)
        return smooth(np.concatenate([azimuth[:1], azimuth[0] + np.cumsum(rate)]), 0.5, self.fps)

    def framing(
        self, frame: float, frac: float, theta: float, scale: Scale, focal: float
    ) -> tuple[float, float]:
        """The distance [m] at which the people fill `frac` of the height of the view, and the fraction they
        do fill.

        The fraction comes out smaller than asked where the width binds (the whole box in full and long
        shots, the heads in closer ones must lie within `WIDTH_SHARE` of it) or where the camera
        must `STAND_OFF`.
        """
        subject, lens = self.subject, self.lens
        above, below = (float(at(signal, frame)) for signal in subject.extent(scale.anchor))
        polar = scale.measured_from(theta)
        wide = (
            at(subject.span, frame) if scale.anchor == "pelvis" else 2.0 * (at(subject.spread, frame) + HEAD)
        )
        r = max(
            float(framing_radius(above, below, frac, polar, focal, lens.height)),
            focal * float(wide) / (WIDTH_SHARE * lens.width),
            float(at(subject.reach(scale.anchor), frame)) + STAND_OFF,
        )
        return r, float(achieved_fraction(above, below, r, polar, focal, lens.height))

    def fraction(self, frame: float, r: float, theta: float, scale: Scale, focal: float) -> float:
        """The fraction of the height of the view that the people fill from (r, θ)."""
        above, below = (at(signal, frame) for signal in self.subject.extent(scale.anchor))
        polar = scale.measured_from(theta)
        return float(achieved_fraction(above, below, r, polar, focal, self.lens.height))

    def lowest_theta(self, lo: int, hi: int, r: float, scale: Scale) -> float:
        """The largest polar angle [rad] that keeps a camera at `r` over the ground from `lo` to `hi`."""
        anchor_z = float(self.subject.anchor(scale.anchor)[lo : hi + 1, 2].min())
        room = anchor_z - self.world.ground_z - HEADROOM_OVER_GROUND
        return float(np.clip(np.arccos(np.clip(-room / r, -1.0, 1.0)), scale.theta_min, THETA_MAX))


@dataclass(frozen=True)
class View:
    """A camera at one moment in the human-centric frame: scale, (r, θ_c, φ_c), focal length [px]."""

    scale: Scale
    r: float
    theta: float
    phi: float
    focal: float

    def location(self, scene: Scene, frame: float) -> Array:
        """The camera's place (3,) in the world at `frame` [m]."""
        phi = self.phi + at(scene.subject.azimuth, frame)
        return scene.anchor(self.scale, frame) + spherical_to_cartesian(self.r, self.theta, phi)

    @classmethod
    def from_location(cls, scene: Scene, frame: float, eye: Array, scale: Scale, focal: float) -> "View":
        """The view that a camera at `eye` (3,) [m] has of the people at `frame`."""
        r, theta, phi = cartesian_to_spherical(eye - scene.anchor(scale, frame))
        phi_c = wrap(phi - at(scene.subject.azimuth, frame))
        return cls(scale, float(r), float(theta), float(phi_c), float(focal))


@dataclass(frozen=True)
class Span:
    """The frames of a shot, and those around it over which its move is laid out for the transitions.

    Attributes:
        start, end: first and last frame of the shot; neighbouring shots share one.
        lo, hi: first and last frame of the move.
        ease_in, ease_out: frames in which a movement gathers and loses its speed.
    """

    start: int
    end: int
    lo: int
    hi: int
    ease_in: float = 0.0
    ease_out: float = 0.0

    @property
    def frames(self) -> Array:
        """Frames lo … hi of the move."""
        return np.arange(self.lo, self.hi + 1, dtype=float)

    @property
    def length(self) -> int:
        """Number of steps between the frames, at least 1: a clip of one frame divides by it too."""
        return max(self.end - self.start, 1)

    def progress(self, frames: Array) -> Array:
        """How far a movement has come at `frames`: 0 up to the first, 1 from the last."""
        return cushioned(frames - self.start, self.length, self.ease_in, self.ease_out)

    def times(self, progress: Array) -> Array:
        """The (fractional) frames at which a movement has come as far as `progress`."""
        grid = np.linspace(self.start, self.start + self.length, 64 * self.length + 1)
        found: Array = np.interp(progress, self.progress(grid), grid)
        return np.where(
            progress <= 0.0, self.start, np.where(progress >= 1.0, self.start + self.length, found)
        )

    def within(self, top_speed: float, fps: float) -> float:
        """The longest way [m] that a movement over the span covers without exceeding `top_speed` [m/s]."""
        return top_speed * (self.length - 0.5 * (self.ease_in + self.ease_out)) / fps
