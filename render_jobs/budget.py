"""How much disk images take: the largest of three stages, as measured by ``benchmarks/disk.py``."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from render_jobs.passes import PASSES

BYTES_PER_PIXEL: dict[str, float] = {
    "jpg": 0.50,
    "png": 1.50,
    "mp4": 0.11,
    "mask": 0.01,
    "depth": 2.75,
    "normal": 1.44,
    "flow": 6.12,
}
"""Of each pass that was measured; RGB by its format. Noise that a recipe adds makes RGB larger."""


def frame_bytes(passes: Iterable[str], image_format: str, width: int, height: int) -> float:
    """Bytes of all images of a frame.

    Args:
        passes: names from :data:`render_jobs.passes.PASSES`.
        image_format: of the rgb files.
        width, height: in pixels.
    """
    names = (image_format if name == "rgb" else name for name in passes)
    return sum(_bytes_per_pixel(name) for name in names) * width * height


def _bytes_per_pixel(name: str) -> float:
    """What was measured; of a pass that was not, what its values take uncompressed."""
    if name in BYTES_PER_PIXEL:
        return BYTES_PER_PIXEL[name]
    return float(np.dtype(PASSES[name].dtype).itemsize * len(PASSES[name].channels))
