"""Image files of a finished frame: written beside their place and renamed into it, so that none is ever
half there."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
from numpy.typing import NDArray
from PIL import Image

from render_jobs.job import RenderJob
from render_jobs.noise import with_noise
from render_jobs.passes import PASSES, RenderPass

PARTIAL_FOLDER = ".partial"
"""In the output folder: files that are being written. Safe to remove when nothing renders."""

JPEG_QUALITY = 95
PNG_LEVEL = 3
"""Of 9: more takes far longer than it saves."""

Writer = Callable[[Path], None]


def is_complete(out: Path, frame: int, passes: tuple[str, ...], image_format: str) -> bool:
    """Whether every file of a frame is there."""
    return all((out / PASSES[name].file(frame, image_format)).is_file() for name in passes)


def publish_frame(out: Path, frame: int, writers: Mapping[str, Writer], image_format: str) -> None:
    """Write the files of a frame, each atomically.

    Args:
        out: the output folder.
        frame: the frame's number.
        writers: for each pass, what writes its file to the path it is given.
        image_format: of the rgb file.
    """
    partial = out / PARTIAL_FOLDER
    partial.mkdir(parents=True, exist_ok=True)
    ready: list[tuple[Path, Path]] = []
    for name, write in writers.items():
        target = out / PASSES[name].file(frame, image_format)
        beside = partial / f"{name}-{os.getpid()}-{target.name}"
        write(beside)
        ready.append((beside, target))
    for beside, target in ready:
        target.parent.mkdir(exist_ok=True)
        beside.replace(target)


def read_picture(path: Path) -> Image.Image:
    """The picture in a file, held in memory."""
    with Image.open(path) as image:
        return image.convert("RGB")


def picture_writer(picture: Image.Image, job: RenderJob, frame: int) -> Writer:
    """What puts the job's noise on a display-ready picture and encodes it, without any metadata.

    JPEG keeps the full resolution of the colours.
    """

    def write(path: Path) -> None:
        finished = with_noise(picture, job.noise, job.seed, frame)
        if job.image_format == "jpg":
            finished.save(path, format="JPEG", quality=JPEG_QUALITY, subsampling=0)
        else:
            finished.save(path, format="PNG", compress_level=PNG_LEVEL)

    return write


def label_writer(name: str, values: NDArray[Any], max_track_id: int) -> Writer:
    """What writes the values of a label pass."""
    if name == "mask":
        return lambda path: write_mask(path, values, max_track_id)
    return lambda path: write_exr(path, PASSES[name], values)


def write_mask(path: Path, track_ids: NDArray[np.integer[Any]], max_track_id: int) -> None:
    """Write ids ``(H, W)`` as PNG, 8-bit if the largest id of the job fits, so that its frames are alike."""
    image = Image.fromarray(track_ids.astype(np.uint8 if max_track_id <= 255 else np.uint16))
    image.save(path, format="PNG")


def write_exr(path: Path, kind: RenderPass, values: NDArray[Any]) -> None:
    """Write ``(H, W)`` or ``(H, W, C)`` values as a single-part ZIP EXR whose header says what it holds."""
    planes = values[..., None] if values.ndim == 2 else values
    channels = {
        name: np.ascontiguousarray(planes[..., index], dtype=kind.dtype)
        for index, name in enumerate(kind.channels)
    }
    header = {
        "compression": OpenEXR.ZIP_COMPRESSION,
        "type": OpenEXR.scanlineimage,
        "pass": kind.name,
        "unit": kind.unit,
        "description": kind.description,
        "pixelCentre": "pixel (0, 0) covers [0, 1) x [0, 1)",
    }
    with OpenEXR.File(header, channels) as file:
        file.write(str(path))


def read_exr(path: Path) -> dict[str, NDArray[Any]]:
    """All channels ``(H, W)`` of an EXR file, those of several parts under ``PART.CHANNEL``."""
    channels: dict[str, NDArray[Any]] = {}
    with OpenEXR.File(str(path), separate_channels=True) as file:
        several = len(file.parts) > 1
        for index, part in enumerate(file.parts):
            for name, channel in file.channels(index).items():
                prefix = part.name() + "."
                full = name if not several or name.startswith(prefix) else prefix + name
                channels[full] = channel.pixels
    return channels
