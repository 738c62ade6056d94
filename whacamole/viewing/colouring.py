"""Numbers as colours: depth, normals, flow and masks, with the legends that say what a colour means."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from whacamole.labels.shading import track_colour
from whacamole.viewing.drawing import INK, PAPER, font

__all__ = [
    "DepthScale",
    "colour_depth",
    "colour_flow",
    "colour_mask",
    "colour_normal",
    "depth_legend",
    "flow_legend",
]

Rgb = NDArray[np.uint8]
Floats = NDArray[np.floating[Any]]

NOTHING = (58, 58, 64)
"""Colour of pixels that hit nothing."""

_RAMP = np.array(
    [
        [255, 247, 214],
        [253, 205, 120],
        [245, 138, 85],
        [205, 75, 112],
        [128, 48, 130],
        [58, 36, 110],
        [18, 18, 52],
    ],
    dtype=np.float64,
)  # near to far, ever darker, so that it also reads in grey


@dataclass(frozen=True)
class DepthScale:
    """The depths at the two ends of the colours [m]."""

    near: float
    far: float

    @classmethod
    def of(cls, depths: list[NDArray[np.float32]]) -> "DepthScale":
        """A scale for images (H, W): all but the nearest and farthest few per cent."""
        finite = np.concatenate([depth[np.isfinite(depth)] for depth in depths]) if depths else np.zeros(0)
        if not finite.size:
            return cls(0.0, 1.0)
        near, far = (float(value) for value in np.quantile(finite, [0.005, 0.9]))
        return cls(near, far if far > near else near + 1.0)


def _ramp(share: Floats) -> Floats:
    """Colours (…, 3) of shares: 0 near, 1 far."""
    places = np.linspace(0.0, 1.0, len(_RAMP))
    return np.stack([np.interp(share, places, _RAMP[:, channel]) for channel in range(3)], axis=-1)


def colour_depth(depth: NDArray[np.float32], scale: DepthScale) -> Rgb:
    """Planar depth (H, W) [m], light near and dark far; what hits nothing is grey."""
    hit = np.isfinite(depth)
    share = (np.where(hit, depth, scale.far) - scale.near) / (scale.far - scale.near)
    coloured = _ramp(np.clip(share, 0.0, 1.0))
    coloured[~hit] = NOTHING
    return coloured.astype(np.uint8)


def colour_normal(normal: NDArray[np.float32]) -> Rgb:
    """Unit normals (H, W, 3) in OpenCV axes the usual way: red right, green up, blue towards the viewer."""
    hit = np.linalg.norm(normal, axis=-1) > 0.5
    coloured = 127.5 * (normal * np.float32([1, -1, -1]) + 1.0)  # type: ignore[arg-type]
    coloured[~hit] = NOTHING
    clipped: Rgb = np.clip(coloured, 0, 255).astype(np.uint8)
    return clipped


def colour_flow(flow: NDArray[np.float32], longest: float) -> Rgb:
    """Flow (H, W, 2) [px]: hue is the direction, x right and y down; colour fades to white where it is zero.

    Args:
        longest: length in full colour; longer ones look the same [px].
    """
    angle = np.arctan2(flow[..., 1], flow[..., 0])
    strength = np.clip(np.linalg.norm(flow, axis=-1) / max(longest, 1e-6), 0.0, 1.0)[..., None]
    # Three cosines a third of a turn apart: every direction its own hue, opposite ones complementary.
    hue = 0.5 + 0.5 * np.cos(angle[..., None] - np.array([0.0, 2 * np.pi / 3, 4 * np.pi / 3]))
    coloured = 255 * (1.0 - strength + strength * hue)
    return np.where(np.isfinite(coloured), coloured, 0.0).astype(np.uint8)


def colour_mask(mask: NDArray[np.integer[Any]]) -> Rgb:
    """Track ids (H, W) in the colours of the tracks."""
    coloured = np.zeros((*mask.shape, 3), dtype=np.uint8)
    coloured[:] = (24, 24, 28)
    for track_id in np.unique(mask[mask > 0]).tolist():
        coloured[mask == track_id] = track_colour(track_id)
    return coloured


def depth_legend(scale: DepthScale, height: int) -> Image.Image:
    """A bar of the colours with depths beside it [m]."""
    text = font(height)
    bar, width = max(6, height // 26), max(44, height // 4)
    picture = Image.new("RGB", (width, height // 2), PAPER)
    rows = _ramp(np.linspace(0.0, 1.0, height // 2 - 12))
    colours = np.repeat(rows[:, None], bar, axis=1).astype(np.uint8)
    picture.paste(Image.fromarray(colours), (5, 6))
    pen = ImageDraw.Draw(picture)
    for share in (0.0, 0.5, 1.0):
        depth = scale.near + share * (scale.far - scale.near)
        anchor = {0.0: "lt", 0.5: "lm", 1.0: "lb"}[share]
        y = 6 + share * (height // 2 - 12)
        pen.text((bar + 9, y), f"{depth:.1f} m", fill=INK, font=text, anchor=anchor)
    return picture


def flow_legend(longest: float, height: int) -> Image.Image:
    """The wheel of directions, full colour at its rim, with the length that the rim stands for [px]."""
    text = font(height)
    size = max(24, height // 4)
    line = round(text.getbbox("0")[3]) + 8
    axis = np.linspace(-1.0, 1.0, size)
    wheel = np.stack(np.meshgrid(axis, axis), axis=-1).astype(np.float32)
    coloured = colour_flow(wheel, 1.0)
    coloured[np.linalg.norm(wheel, axis=-1) > 1.0] = PAPER
    picture = Image.new("RGB", (max(size + 8, 56), size + line + 6), PAPER)
    picture.paste(Image.fromarray(coloured), ((picture.width - size) // 2, 4))
    pen = ImageDraw.Draw(picture)
    pen.text((picture.width / 2, size + 6), f"{longest:.3g} px", fill=INK, font=text, anchor="mt")
    return picture
