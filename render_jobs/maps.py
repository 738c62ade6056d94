"""Environment maps: equirectangular images of light in OpenEXR or Radiance files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from render_jobs.errors import RenderJobError
from render_jobs.images import read_exr

Floats = NDArray[np.float32]

MAP_SUFFIXES = (".exr", ".hdr")


def read_map(path: Path) -> Floats:
    """Linear light ``(H, W, 3)`` of an ``.exr`` or ``.hdr`` file.

    Raises:
        RenderJobError: the file is damaged or of another kind.
    """
    try:
        if path.suffix.lower() == ".hdr":
            image = _read_radiance(path.read_bytes())
        else:
            channels = read_exr(path)
            image = np.stack([channels[name] for name in "RGB"], axis=-1).astype(np.float32)
    except Exception as error:  # OpenEXR raises what it likes
        reason = " ".join(str(error).split()) or type(error).__name__
        raise RenderJobError(f"{path}: no readable environment map ({reason}); save it again") from error
    if not np.isfinite(image).all() or image.max(initial=0.0) <= 0.0:
        raise RenderJobError(f"{path}: no environment map: it holds no light, or no numbers; save it again")
    return image


def solid_angles(height: int, width: int) -> Floats:
    """Solid angle ``(H, W)`` [sr] of the pixels of an equirectangular image."""
    edges = np.cos(np.pi * np.arange(height + 1) / height)
    rows = (edges[:-1] - edges[1:]) * 2 * np.pi / width
    return np.broadcast_to(rows[:, None], (height, width)).astype(np.float32)


def irradiance_from_above(image: Floats) -> float:
    """Luminous irradiance that a map throws on level ground, at strength 1."""
    height, width = image.shape[:2]
    cosine = np.clip(np.cos(np.pi * (np.arange(height) + 0.5) / height), 0.0, None)[:, None]
    luminance = image @ np.array([0.2126, 0.7152, 0.0722], np.float32)
    return float((luminance * solid_angles(height, width) * cosine).sum())


def _read_radiance(content: bytes) -> Floats:
    """Decode Ward's RGBE format: a header, a line with the size, run-length coded lines."""
    header, found, rest = content.partition(b"\n\n")
    size, _, pixels = rest.partition(b"\n")
    words = size.split()
    if not header.startswith(b"#?") or not found or len(words) != 4 or words[0] != b"-Y" or words[2] != b"+X":
        raise ValueError("it does not begin as a Radiance file does")
    height, width = int(words[1]), int(words[3])
    data = np.frombuffer(pixels, np.uint8)
    rgbe = np.empty((height, width, 4), np.uint8)
    if width < 8 or width > 32767 or len(data) < 4 or tuple(data[:2]) != (2, 2):
        rgbe[:] = data[: height * width * 4].reshape(height, width, 4)
    else:
        at = 0
        for row in rgbe:
            at = _read_line(data, at, row)
    scale = np.ldexp(1.0, rgbe[..., 3].astype(np.int32) - 136)
    return np.asarray(rgbe[..., :3] * np.where(rgbe[..., 3:] > 0, scale[..., None], 0.0), np.float32)


def _read_line(data: NDArray[np.uint8], at: int, row: NDArray[np.uint8]) -> int:
    """Fill one line ``(W, 4)``; return where the next begins."""
    width = len(row)
    if (
        len(data) < at + 4
        or tuple(data[at : at + 2]) != (2, 2)
        or int(data[at + 2]) << 8 | data[at + 3] != width
    ):
        raise ValueError("a line is damaged")
    at += 4
    for channel in range(4):
        column = 0
        while column < width:
            count = int(data[at])
            if count > 128:
                row[column : column + count - 128, channel] = data[at + 1]
                column, at = column + count - 128, at + 2
            else:
                if count == 0:
                    raise ValueError("a line is damaged")
                row[column : column + count, channel] = data[at + 1 : at + 1 + count]
                column, at = column + count, at + 1 + count
    return at
