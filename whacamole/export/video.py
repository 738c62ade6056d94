"""MP4: a sequence as a video whose frame times are exactly those of the labels."""

from fractions import Fraction
from pathlib import Path

import av
import numpy as np

from whacamole.dataset import Sequence
from whacamole.export.source import Source

__all__ = ["write_mp4"]

QUALITY = "16"
"""Constant rate factor of H.264; 18 is commonly held to look like the source."""

LARGEST_DENOMINATOR = 1001
"""Frame rates are n/1 or n/1001 (29.97 is 30000/1001)."""


def write_mp4(source: Source, folder: Path) -> list[str]:
    """Write ``<sequence>.mp4`` (H.264, 4:2:0); an odd width or height gains a repeated column or row."""
    for sequence in source:
        _write(sequence, folder / f"{sequence.id}.mp4")
    return []


def _write(sequence: Sequence, path: Path) -> None:
    rate = Fraction(float(sequence.facts["fps"])).limit_denominator(LARGEST_DENOMINATOR)
    width, height = sequence.size
    right, below = width % 2, height % 2
    with av.open(str(path), "w") as container:
        stream = container.add_stream("libx264", rate=rate, options={"crf": QUALITY})
        stream.width, stream.height, stream.pix_fmt = width + right, height + below, "yuv420p"
        stream.codec_context.time_base = 1 / rate
        for number in range(len(sequence)):
            image = np.pad(sequence.rgb(number), ((0, below), (0, right), (0, 0)), mode="edge")
            frame = av.VideoFrame.from_ndarray(image, format="rgb24")
            frame.pts, frame.time_base = number, 1 / rate
            container.mux(stream.encode(frame))
        container.mux(stream.encode())
