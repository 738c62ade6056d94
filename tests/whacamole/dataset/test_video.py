"""A video as the place of colour frames: each under its number, at its time, and like its source."""

import pickle
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest
from numpy.typing import NDArray

from whacamole.dataset.video import VideoFrames, write_video

FRAMES, WIDTH, HEIGHT = 70, 65, 38
"""Odd, so that a column is added and taken off again; long enough for more than one key frame or seek."""


def picture(number: int) -> NDArray[np.uint8]:
    """Smooth colours, and the number in binary as blocks of black and white."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    image = np.stack([60 + x * 2, 200 - y * 3, 90 + 0 * x], axis=-1).astype(np.uint8)
    for bit in range(7):
        image[:8, 8 * bit : 8 * bit + 8] = 230 if number >> bit & 1 else 20
    return image


def number_in(image: NDArray[np.uint8]) -> int:
    return sum(int(image[2:6, 8 * bit + 2 : 8 * bit + 6].mean() > 125) << bit for bit in range(7))


@pytest.fixture(scope="module", params=[30.0, 30000 / 1001, 12.5])
def video(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, float]:
    path = tmp_path_factory.mktemp("video") / "rgb.mp4"
    write_video(path, (picture(number) for number in range(FRAMES)), request.param, quality=12)
    return path, request.param


def test_frame_times_are_exact(video: tuple[Path, float]) -> None:
    path, fps = video
    rate = Fraction(fps).limit_denominator(1001)
    with av.open(str(path)) as container:
        times = [frame.pts * frame.time_base for frame in container.decode(video=0)]
        coded = container.streams.video[0].codec_context
        assert (coded.color_range, coded.colorspace) == (1, 5), "limited range, ITU-R BT.601"
    assert times == [number / rate for number in range(FRAMES)]


def test_every_frame_is_found_under_its_number_in_any_order(video: tuple[Path, float]) -> None:
    frames = VideoFrames(video[0], WIDTH, HEIGHT)
    order = [0, 1, 2, 69, 3, 40, 41, 45, 44, 0, *np.random.default_rng(0).permutation(FRAMES)[:20].tolist()]
    for number in order:
        image = frames[number]
        assert image.shape == (HEIGHT, WIDTH, 3)
        assert number_in(image) == number
    with pytest.raises(IndexError):
        frames[FRAMES]
    assert number_in(frames[5]) == 5


def test_colours_are_those_of_the_source(video: tuple[Path, float]) -> None:
    frames = VideoFrames(video[0], WIDTH, HEIGHT)
    difference = frames[33][12:].astype(float) - picture(33)[12:]
    assert np.abs(difference.mean(axis=(0, 1))).max() < 2.0, "no shift of colour or range beyond rounding"
    assert np.abs(difference).mean() < 2.0


def test_a_pickled_reader_reads(video: tuple[Path, float]) -> None:
    frames = VideoFrames(video[0], WIDTH, HEIGHT)
    assert number_in(frames[9]) == 9
    assert number_in(pickle.loads(pickle.dumps(frames))[10]) == 10  # noqa: TID251


def test_a_broken_file_is_an_error_of_the_system(tmp_path: Path) -> None:
    def broken() -> Iterator[NDArray[np.uint8]]:
        yield picture(0)
        raise RuntimeError("the source broke off")

    with pytest.raises(RuntimeError):
        write_video(tmp_path / "rgb.mp4", broken(), 30.0)
    assert not list(tmp_path.iterdir())
    (tmp_path / "rgb.mp4").write_bytes(b"no video")
    with pytest.raises((OSError, ValueError)):
        VideoFrames(tmp_path / "rgb.mp4", WIDTH, HEIGHT)[0]
