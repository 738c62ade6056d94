"""MP4 files from pictures and back, with frame times that are exactly those of the labels."""

import os
import threading
from collections.abc import Iterable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Self

import av
import numpy as np
from av.video.reformatter import ColorRange, Colorspace
from numpy.typing import NDArray

__all__ = ["VideoFrames", "write_video"]

READ_ON = 16
"""Frames ahead up to which decoding on is taken for faster than seeking."""

LARGEST_DENOMINATOR = 1001
"""Frame rates are n/1 or n/1001 (29.97 is 30000/1001)."""


def write_video(path: Path, pictures: Iterable[NDArray[np.uint8]], fps: float, *, quality: int = 20) -> None:
    """Write pictures (H, W, 3) as H.264, 4:2:0; an odd width or height gains a repeated column or row.

    Args:
        quality: constant rate factor of H.264; 18 is commonly held to look like the source.
    """
    beside = path.with_name(f".{path.name}.part")
    try:
        _write(beside, pictures, Fraction(fps).limit_denominator(LARGEST_DENOMINATOR), quality)
        beside.replace(path)
    finally:
        beside.unlink(missing_ok=True)


class VideoFrames:
    """The pictures of a video by number; reading on is fast, going back or far ahead seeks.

    Safe in threads, after a fork, and when it is pickled: each process opens the file for itself.
    """

    def __init__(self, path: Path, width: int, height: int) -> None:
        self._path, self._size = path, (width, height)
        self._lock = threading.Lock()
        self._pid = 0
        self._next = -READ_ON
        self._pictures: Iterator[tuple[int, av.VideoFrame]] = iter(())

    def __reduce__(self) -> tuple[type[Self], tuple[Path, int, int]]:
        return type(self), (self._path, *self._size)

    def __getitem__(self, number: int) -> NDArray[np.uint8]:
        """Return picture ``number`` (H, W, 3), sRGB.

        Raises:
            IndexError: the video ends before it.
            OSError, ValueError: the file is missing or broken (PyAV's errors are among these).
        """
        with self._lock:
            if self._pid != os.getpid():
                self._forget()
                self._pid = os.getpid()
            if not self._next <= number < self._next + READ_ON:
                self._pictures = self._from(number)
            for found, picture in self._pictures:
                self._next = found + 1
                if found == number:
                    width, height = self._size
                    return np.ascontiguousarray(picture.to_ndarray(format="rgb24")[:height, :width])
                if found > number:
                    break
            self._forget()
            raise IndexError(f"{self._path}: holds no frame {number}")

    def _forget(self) -> None:
        """Begin anew: what is open belongs to another process, or has ended."""
        self._next = -READ_ON
        self._pictures = iter(())

    def _from(self, number: int) -> Iterator[tuple[int, av.VideoFrame]]:
        """Decode from the last key frame at or before ``number``; yield (number, picture)."""
        with av.open(str(self._path)) as container:
            stream = container.streams.video[0]
            step = 1 / (stream.average_rate * stream.time_base)
            if number:
                container.seek(int(number * step), stream=stream)
            for picture in container.decode(stream):
                yield round(picture.pts / step), picture


def _write(path: Path, pictures: Iterable[NDArray[np.uint8]], rate: Fraction, quality: int) -> None:
    with av.open(str(path), "w", format="mp4", options={"movflags": "faststart"}) as container:
        stream = container.add_stream("libx264", rate=rate, options={"crf": str(quality)})
        stream.pix_fmt, stream.codec_context.time_base = "yuv420p", 1 / rate
        coded = stream.codec_context  # what swscale makes of RGB, said so that no player has to guess
        coded.color_range, coded.colorspace = ColorRange.MPEG, Colorspace.ITU601
        for number, picture in enumerate(pictures):
            height, width = picture.shape[:2]
            padded = np.pad(picture, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge")
            if not number:
                stream.width, stream.height = padded.shape[1], padded.shape[0]
            frame = av.VideoFrame.from_ndarray(padded, format="rgb24")
            frame.pts, frame.time_base = number, 1 / rate
            container.mux(stream.encode(frame))
        container.mux(stream.encode())
