"""How much disk images take: measured by ``benchmarks/disk.py``, a little on the safe side."""

from __future__ import annotations

from collections.abc import Iterable

BYTES_PER_PIXEL: dict[str, float] = {
    "jpg": 0.45,
    "png": 1.9,
    "mp4": 0.2,
    "mask": 0.02,
    "depth": 2.4,
    "normal": 7.0,
    "flow": 6.5,
}
"""Of each pass; RGB by its format."""


def frame_bytes(passes: Iterable[str], image_format: str, width: int, height: int) -> float:
    """Bytes of all images of a frame.

    Args:
        passes: names from :data:`render_jobs.passes.PASSES`.
        image_format: of the rgb files.
        width, height: in pixels.
    """
    names = (image_format if name == "rgb" else name for name in passes)
    return sum(BYTES_PER_PIXEL[name] for name in names) * width * height
