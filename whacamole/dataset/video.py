"""MP4 files from pictures, with frame times that are exactly those of the labels."""

from collections.abc import Iterable
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
from numpy.typing import NDArray

__all__ = ["write_video"]

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


def _write(path: Path, pictures: Iterable[NDArray[np.uint8]], rate: Fraction, quality: int) -> None:
    with av.open(str(path), "w", format="mp4", options={"movflags": "faststart"}) as container:
        stream = container.add_stream("libx264", rate=rate, options={"crf": str(quality)})
        stream.pix_fmt, stream.codec_context.time_base = "yuv420p", 1 / rate
        for number, picture in enumerate(pictures):
            height, width = picture.shape[:2]
            padded = np.pad(picture, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge")
            if not number:
                stream.width, stream.height = padded.shape[1], padded.shape[0]
            frame = av.VideoFrame.from_ndarray(padded, format="rgb24")
            frame.pts, frame.time_base = number, 1 / rate
            container.mux(stream.encode(frame))
        container.mux(stream.encode())
