"""How much work goes into a pixel: the presets, each a point on the measured curve of image error over
seconds.

The measurements and the command that repeats them are in ``docs/rendering.md``.
"""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from render_jobs.errors import RenderJobError
from render_jobs.scene import NonNegative, SceneValue

Bounces = Annotated[int, Field(ge=0, le=64)]


class Quality(SceneValue):
    """Path-tracing settings. Engines that trace no paths use ``samples`` alone, for antialiasing."""

    name: str
    samples: Annotated[int, Field(ge=1, le=65536)]
    """Most samples a pixel gets."""
    noise_threshold: NonNegative = 0.0
    """Stop sampling a pixel at this noise level; 0 gives every pixel all samples."""
    denoise: Literal["off", "fast", "balanced", "high"] = "high"
    """The strength of Open Image Denoise."""
    prefilter: Literal["none", "fast", "accurate"] = "accurate"
    """Whether albedo and normal are themselves denoised before they guide the denoiser."""
    diffuse_bounces: Bounces = 4
    glossy_bounces: Bounces = 4
    transparent_bounces: Bounces = 8
    """Layers of clipped or blended surface (hair cards) a ray may pass."""
    light_tree: bool = True
    clamp_indirect: NonNegative = 10.0
    """Largest value an indirect sample may add; 0 is no limit."""


QUALITIES: dict[str, Quality] = {
    quality.name: quality
    for quality in (
        Quality(name="draft", samples=4, denoise="balanced"),
        Quality(name="standard", samples=16),
        Quality(name="high", samples=64),
    )
}
"""The presets by name."""


def quality_preset(name: str) -> Quality:
    """The preset of this name.

    Raises:
        RenderJobError: there is none.
    """
    if name not in QUALITIES:
        raise RenderJobError(f"quality {name!r} is not one of {', '.join(QUALITIES)}")
    return QUALITIES[name]
