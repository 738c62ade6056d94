"""What a rule sees: the camera, the people, the world and the shots, over all frames or a window of them."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from camera_rigs.joins import transition_half
from camera_rigs.path import CameraPath
from camera_rigs.scene import SCALES
from camera_rigs.shake import Shake
from camera_rigs.shot import Keyframe, Shot
from camera_rigs.shots.catalogue import KINDS
from camera_rigs.smoothing import at
from camera_rigs.spherical import Array
from camera_rigs.subject import SubjectTrack
from camera_rigs.world import World


@dataclass(frozen=True)
class Limits:
    """The limits of all rules. Speeds and clearances are those of a film crew, see docs/cameras.md.

    Attributes:
        look_at: largest angle between the view and what the shot looks at [°].
        radius: largest relative difference of a kept radius.
        spacing: largest relative difference between the steps of equally spaced keyframes.
        backward: largest angle by which an arc runs backward [°].
        fraction: largest relative difference of an achieved fraction of the view.
        place: largest difference of a tracking keyframe from its place in the human-centric frame [m].
        overlap: how far an overlap at or between keyframes may be on the wrong side of λ_overlap.
        drift: largest movement of a camera that stays in its place [m].
        horizon: largest tilt of the horizon [°].
        ground, obstacle, wall, person: least distances of the camera [m].
        speed, acceleration, jerk: of the camera [m/s, m/s², m/s³], on top of the people's own.
        turn: fastest turn of the camera [°/s].
        zoom: fastest relative change of the focal length [1/s].
        out_seconds: longest time [s] in which somebody's anchor may be out of the view.
        hidden_seconds: longest time [s] in which an obstacle may hide the people.
    """

    look_at: float = 1.0
    radius: float = 0.02
    spacing: float = 0.02
    backward: float = 0.2
    fraction: float = 0.02
    place: float = 0.03
    overlap: float = 0.02
    drift: float = 0.01
    horizon: float = 0.5
    ground: float = 0.1
    obstacle: float = 0.15
    wall: float = 0.15
    person: float = 0.2
    speed: float = 3.0
    acceleration: float = 6.0
    jerk: float = 30.0
    turn: float = 90.0
    zoom: float = 1.0
    out_seconds: float = 0.3
    hidden_seconds: float = 0.5

    def to_json(self) -> dict[str, Any]:
        """The limits by name."""
        return asdict(self)


@dataclass(frozen=True)
class Finding:
    """One breach of one rule.

    Attributes:
        rule: name of the rule.
        frame: the frame where it is worst.
        value: what was found there.
        limit: what the rule allows.
        message: one line that tells all of it, with units.
    """

    rule: str
    frame: int
    value: float
    limit: float
    message: str


@dataclass(frozen=True)
class Evidence:
    """A camera to be judged.

    Attributes:
        path: the camera over N frames.
        subject: the people, over the whole clip.
        world: the surroundings.
        shots: the shots that lie in the frames, in order.
        limits: what the rules allow.
        shake: the shake that was added to the planned camera, if any.
        first: index of the first frame of `path` in the clip.
    """

    path: CameraPath
    subject: SubjectTrack
    world: World
    shots: tuple[Shot, ...]
    limits: Limits
    shake: Shake | None = None
    first: int = 0

    @property
    def last(self) -> int:
        """Index of the last frame of `path` in the clip."""
        return self.first + self.path.num_frames - 1

    def of_people(self, signal: Array) -> Array:
        """The part of a signal (…, T, 3) of the people that lies in the frames of `path`."""
        return signal[..., self.first : self.last + 1, :]

    def location_at(self, frame: float) -> Array:
        """The camera's place (3,) [m] at a frame of the clip, which may lie between two."""
        return at(self.path.location, frame - self.first)

    @cached_property
    def offsets(self) -> dict[str, Array]:
        """Place of the camera (N, 3) [m] relative to each anchor, by the anchor's name."""
        return {
            name: self.path.location - self.of_people(self.subject.anchor(name))
            for name in ("pelvis", "neck")
        }

    def settled(self) -> Iterator[tuple[Shot, int, int]]:
        """The shots with the first and last frame (inclusive) in which each holds undisturbed.

        Between two shots that travel with the people the transition keeps to both. Where a camera that
        travels meets one that stands, the frames of the transition belong to neither.
        """
        half = transition_half(self.subject.fps)
        for index, shot in enumerate(self.shots):
            begin, end = shot.start, shot.end
            if index == 0:
                begin += half if shot.start > 0 else 0
            elif not (KINDS[self.shots[index - 1].kind].settles and KINDS[shot.kind].settles):
                begin += half
            if index + 1 < len(self.shots) and not (
                KINDS[self.shots[index + 1].kind].settles and KINDS[shot.kind].settles
            ):
                end -= half
            begin, end = max(begin, self.first), min(end, self.last)
            if begin <= end:
                yield shot, begin, end

    def settled_keyframes(self) -> Iterator[tuple[Shot, list[Keyframe]]]:
        """The shots with those of their keyframes that fall into frames in which the shot holds."""
        for shot, begin, end in self.settled():
            keyframes = [k for k in shot.keyframes if begin <= k.frame <= end]
            if keyframes:
                yield shot, keyframes

    def per_scale(self) -> Iterator[tuple[str, int, int]]:
        """Name of the anchor, first and last frame of every shot in the window; together they cover it."""
        for index, shot in enumerate(self.shots):
            begin = max(shot.start + (1 if index else 0), self.first)
            end = min(shot.end, self.last)
            if begin <= end:
                yield SCALES[shot.scale].anchor, begin, end


def worst(
    rule: str, unit: str, frames: ArrayLike, values: ArrayLike, limit: float, *, least: bool = False
) -> list[Finding]:
    """The finding at the worst of `values` (n,) if it breaks the limit; `least` for limits from below."""
    frames, values = np.asarray(frames, float), np.asarray(values, float)
    if not len(values):
        return []
    index = int(np.argmin(values) if least else np.argmax(values))
    value, frame = float(values[index]), round(float(frames[index]))
    if value >= limit if least else value <= limit:
        return []
    sign = "least" if least else "most"
    message = f"{rule}: {value:.4g} {unit} at frame {frame}, {sign} {limit:.4g} {unit} is allowed"
    return [Finding(rule, frame, value, limit, message)]
