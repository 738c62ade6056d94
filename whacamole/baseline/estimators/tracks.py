"""Following people through a video by their landmarks."""

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from whacamole.baseline.estimators.blazepose import NUM_LANDMARKS, BlazePose, Reading, Region
from whacamole.baseline.rigid import BoolArray, FloatArray

LOOK_EVERY = 5
"""Frames between looks for new people, while everybody known is in view."""

PATIENCE = 30
"""Frames for which somebody lost is still the same person when seen again near the place."""

SHORTEST = 10
"""Frames in which somebody must be read to count as a person."""


_MISREAD = 0.5
"""Sides of a region within which somebody found is somebody misread."""


@dataclass(frozen=True, eq=False)
class LandmarkTrack:
    """A person's landmarks over the T frames of a video, NaN where not found.

    Attributes:
        pixels: (T, 33, 2).
        seen: (T, 33).
        metric: (T, 33, 3) [m].
        valid: (T,).
    """

    pixels: FloatArray
    seen: FloatArray
    metric: FloatArray
    valid: BoolArray


@dataclass(eq=False)
class _Person:
    region: Region
    last: int
    readings: dict[int, Reading] = field(default_factory=dict)


def follow(images: Iterable[NDArray[np.uint8]], num_frames: int, pose: BlazePose) -> list[LandmarkTrack]:
    """The people of a video of T frames, longest first."""
    people: list[_Person] = []
    for frame, image in enumerate(images):
        for person in people:
            if person.last == frame - 1:
                _read(person, frame, image, pose)
        _drop_doubles(people, frame)
        everybody = all(person.last == frame for person in people)
        if frame % LOOK_EVERY == 0 or not everybody:
            _look(people, frame, image, pose)
    people = [person for person in people if len(person.readings) >= SHORTEST]
    people.sort(key=lambda person: -len(person.readings))
    return [_track(person, num_frames) for person in people]


def _read(person: _Person, frame: int, image: NDArray[np.uint8], pose: BlazePose) -> bool:
    reading = pose.read(image, person.region)
    if reading is None or not _sane(reading, image):
        return False
    person.readings[frame] = reading
    person.region, person.last = reading.next, frame
    return True


def _sane(reading: Reading, image: NDArray[np.uint8]) -> bool:
    """Whether the region that follows is one of a person in this image."""
    side, (height, width) = reading.next.side, image.shape[:2]
    inside = -0.2 * width < reading.next.x < 1.2 * width and -0.2 * height < reading.next.y < 1.2 * height
    return inside and 16.0 < side < 6.0 * max(width, height)


def _look(people: list[_Person], frame: int, image: NDArray[np.uint8], pose: BlazePose) -> None:
    """Find people; those near somebody lost are that person, those near nobody are new.

    Who is followed but not found, while somebody is found close by whom nobody follows, has been misread
    (hips taken for shoulders, or the like) and is read again where the finding is.
    """
    found = pose.find(image)
    here = [person for person in people if person.last == frame]
    misread = [person for person in here if not any(person.region.overlaps(region) for region in found)]
    for region in found:
        if any(person.region.overlaps(region) for person in people if person.last == frame):
            continue
        near = [person for person in misread if person.region.apart(region) < _MISREAD]
        lost = [p for p in people if p.last < frame and p.region.apart(region) < _reach(frame - p.last)]
        if near:
            person = min(near, key=lambda p: p.region.apart(region))
            misread.remove(person)
        else:
            person = min(lost, key=lambda p: p.region.apart(region), default=_Person(region, frame - 1))
        person.region = region
        if _read(person, frame, image, pose) and person not in people:
            people.append(person)
    _drop_doubles(people, frame)


def _reach(gap: int) -> float:
    """How far, in sides of a region, somebody may have got in the frames since he was lost."""
    return 0.25 + 0.02 * gap if gap <= PATIENCE else 0.0


def _drop_doubles(people: list[_Person], frame: int) -> None:
    """Where two tracks have come to read one person, the younger one loses this frame and ends."""
    here = [person for person in people if person.last == frame]
    here.sort(key=lambda person: -len(person.readings))
    for index, older in enumerate(here):
        for younger in here[index + 1 :]:
            if younger.last == frame and _same(older.readings[frame], younger.readings[frame]):
                del younger.readings[frame]
                younger.last = frame - PATIENCE - 1


def _same(one: Reading, other: Reading) -> bool:
    apart = np.linalg.norm(one.pixels - other.pixels, axis=-1).mean()
    return bool(apart < 0.08 * min(one.next.side, other.next.side))


def _track(person: _Person, num_frames: int) -> LandmarkTrack:
    pixels = np.full((num_frames, NUM_LANDMARKS, 2), np.nan)
    seen = np.full((num_frames, NUM_LANDMARKS), np.nan)
    metric = np.full((num_frames, NUM_LANDMARKS, 3), np.nan)
    frames = sorted(person.readings)
    for frame in frames:
        reading = person.readings[frame]
        pixels[frame], seen[frame], metric[frame] = reading.pixels, reading.seen, reading.metric
    valid = np.zeros(num_frames, dtype=bool)
    valid[frames] = True
    return LandmarkTrack(pixels, seen, metric, valid)
