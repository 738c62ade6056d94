"""The one list of what a renderer can write for a frame. Every file name, unit and type comes from here."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from render_jobs.errors import RenderJobError


@dataclass(frozen=True)
class RenderPass:
    """One kind of image.

    Attributes:
        name: the folder and the name users type.
        description: one sentence: what a pixel holds.
        unit: of a pixel's value.
        dtype: of a pixel's value in the file.
        channels: names of the channels, in order.
        suffix: of the file; that of ``rgb`` is the job's image format.
    """

    name: str
    description: str
    unit: str
    dtype: str
    channels: tuple[str, ...]
    suffix: str

    def file(self, frame: int, image_format: str = "jpg") -> Path:
        """The path of a frame, relative to the output folder."""
        suffix = image_format if self.name == "rgb" else self.suffix
        return Path(self.name, f"{frame:06d}.{suffix}")


PASSES: dict[str, RenderPass] = {
    entry.name: entry
    for entry in (
        RenderPass(
            "rgb",
            "What a camera would record, display-ready sRGB.",
            "sRGB 0..255",
            "uint8",
            ("R", "G", "B"),
            "jpg",
        ),
        RenderPass(
            "mask",
            "track_id of the surface at the pixel centre, 0 is background; 16-bit where an id exceeds 255.",
            "track_id",
            "uint8 or uint16",
            ("L",),
            "png",
        ),
        RenderPass(
            "depth",
            "Planar depth (camera z) of the surface at the pixel centre; no hit is infinity.",
            "m",
            "float32",
            ("Z",),
            "exr",
        ),
        RenderPass(
            "normal",
            "Unit normal in the camera frame (x right, y down, z forward), towards the camera; no hit is 0.",
            "1",
            "float32",
            ("X", "Y", "Z"),
            "exr",
        ),
        RenderPass(
            "flow",
            "Motion of the surface point at the pixel centre to the next frame, x right, y down; "
            "also where it becomes hidden or leaves the image.",
            "px",
            "float32",
            ("X", "Y"),
            "exr",
        ),
    )
}
"""Every pass, by name."""

DEFAULT_PASSES: tuple[str, ...] = ("rgb", "mask", "depth")
LABEL_PASSES: tuple[str, ...] = tuple(name for name in PASSES if name != "rgb")


def checked_passes(names: Iterable[str]) -> tuple[str, ...]:
    """The names in the order of :data:`PASSES`, each once.

    Raises:
        RenderJobError: a name is unknown, or there is none.
    """
    wanted = set(names)
    unknown = sorted(wanted - set(PASSES))
    if unknown or not wanted:
        raise RenderJobError(f"passes {', '.join(unknown) or '(none)'}: choose from {', '.join(PASSES)}")
    return tuple(name for name in PASSES if name in wanted)
