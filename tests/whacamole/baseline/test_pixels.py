"""The parts that look at pixels with models of their own: MediaPipe and colmap."""

import os
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from whacamole.baseline.estimators.blazepose import NUM_LANDMARKS, Reading, Region, held_back_stderr
from whacamole.baseline.estimators.tracks import PATIENCE, follow

FRAMES, SIDE = 40, 100.0


class _FakePose:
    """Sees people where it is told they are: (x, first frame, last frame)."""

    def __init__(self, people: list[tuple[float, int, int]]) -> None:
        self.people = people

    def _here(self, image: np.ndarray) -> list[float]:
        frame = int(image[0, 0, 0])
        return [x for x, first, last in self.people if first <= frame <= last]

    def find(self, image: np.ndarray) -> list[Region]:
        return [Region(x, 100.0, SIDE, 0.0) for x in self._here(image)]

    def read(self, image: np.ndarray, region: Region) -> Reading | None:
        near = [x for x in self._here(image) if abs(x - region.x) < 20.0]
        if not near:
            return None
        spread = np.stack(
            [np.linspace(-20.0, 20.0, NUM_LANDMARKS), np.linspace(-40.0, 40.0, NUM_LANDMARKS)], 1
        )
        pixels = spread + np.array([near[0], 100.0])
        seen, metric = np.ones(NUM_LANDMARKS), np.zeros((NUM_LANDMARKS, 3))
        return Reading(pixels, seen, metric, Region(near[0], 100.0, SIDE, 0.0))


def _video() -> list[np.ndarray]:
    return [np.full((200, 600, 3), frame, dtype=np.uint8) for frame in range(FRAMES)]


def _tracks(people: list[tuple[float, int, int]]) -> list[list[int]]:
    found = follow(_video(), FRAMES, _FakePose(people))  # type: ignore[arg-type]
    return [np.flatnonzero(track.valid).tolist() for track in found]


def test_everybody_gets_a_track() -> None:
    assert _tracks([(100.0, 0, 39), (300.0, 0, 25)]) == [list(range(40)), list(range(26))]


def test_who_comes_later_is_found_at_the_next_look() -> None:
    assert _tracks([(100.0, 0, 39), (300.0, 13, 39)]) == [list(range(40)), list(range(15, 40))]


def test_who_comes_back_is_the_same_person() -> None:
    assert PATIENCE >= 8
    assert _tracks([(100.0, 0, 15), (105.0, 22, 39)]) == [[*range(16), *range(22, 40)]]


def test_who_comes_back_a_little_further_on_is_the_same_person() -> None:
    assert _tracks([(100.0, 0, 15), (135.0, 22, 39)]) == [[*range(16), *range(22, 40)]]


class _Misreading(_FakePose):
    """Reads a person wherever it is told to look; its first finding is beside the person."""

    def find(self, image: np.ndarray) -> list[Region]:
        beside = 30.0 if image[0, 0, 0] == 0 else 0.0
        return [Region(x + beside, 100.0, SIDE, 0.0) for x in self._here(image)]

    def read(self, image: np.ndarray, region: Region) -> Reading | None:
        return _FakePose([(region.x, 0, FRAMES)]).read(image, region)


def test_who_was_misread_is_read_again_where_he_is_found() -> None:
    [track] = follow(_video(), FRAMES, _Misreading([(300.0, 0, 39)]))  # type: ignore[arg-type]
    assert track.valid.all()
    assert track.pixels[:, :, 0].mean(axis=1)[[0, 4, 5, 39]] == pytest.approx([330.0, 330.0, 300.0, 300.0])


def test_a_glimpse_is_nobody() -> None:
    assert _tracks([(100.0, 0, 39), (300.0, 0, 4)]) == [list(range(40))]


def test_nobody_is_no_track() -> None:
    assert _tracks([]) == []


def test_mediapipe_finds_nobody_on_a_blank_wall_and_says_nothing(capfd: pytest.CaptureFixture[str]) -> None:
    """Its native code would warn of its own graphs, across the bar, at every start."""
    pytest.importorskip("mediapipe")
    from whacamole.baseline.estimators.blazepose import BlazePose

    with BlazePose() as pose:
        wall = np.full((120, 160, 3), 128, dtype=np.uint8)
        assert pose.find(wall) == []
        assert pose.read(wall, Region(80.0, 60.0, 100.0, 0.0)) is None
    assert capfd.readouterr() == ("", "")


def test_what_native_code_says_is_shown_if_it_fails(capfd: pytest.CaptureFixture[str]) -> None:
    @held_back_stderr()
    def start() -> None:
        os.write(2, b"no memory\n")
        raise RuntimeError

    with pytest.raises(RuntimeError):
        start()
    assert capfd.readouterr().err == "no memory\n"


@pytest.mark.slow
def test_mediapipe_finds_the_people_in_a_picture() -> None:
    pytest.importorskip("mediapipe")
    from whacamole.baseline.estimators.blazepose import BlazePose

    path = Path(__file__).parents[3] / "../shared/looks/people_plaza.jpg"
    if not path.exists():
        pytest.skip("no picture of people is beside this checkout")
    image = np.asarray(Image.open(path).convert("RGB"))
    with BlazePose() as pose:
        regions = pose.find(image)
        assert len(regions) >= 2
        reading = pose.read(image, regions[0])
    assert reading is not None
    head, ankles = reading.pixels[0], reading.pixels[[27, 28]]
    assert (ankles[:, 1] > head[1]).all()
    # Metric landmarks are of the size of a person.
    height = reading.metric[[27, 28], 1].mean() - reading.metric[0, 1]
    assert 1.0 < height < 2.0
