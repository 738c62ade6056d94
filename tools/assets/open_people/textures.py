"""Cleans textures: marks painted out, unused corners filled, shading baked in, few bytes."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw
from scipy import ndimage

from open_people.item_list import Patch

JPEG_QUALITY: Final = 90
WEBP_QUALITY: Final = 88
FEATHER: Final = 5.0
"""Pixels over which a patch fades into its surroundings."""

AO_STRENGTH: Final = 0.6
ISLAND_MARGIN: Final = 3
"""Pixels kept round the used parts of a texture, so that filtering meets no foreign colour."""


CLEAR: Final = 128.0
"""Alpha (0..255) at which renderers cut hair."""

LUMA: Final = np.array([0.299, 0.587, 0.114])

SHEEN: Final = 10.0
"""Pixels over which painted sheen varies; strands are finer."""

SHEEN_KEPT: Final = 0.35
"""Share of sheen and of darker roots that stays."""

STRAND_DEPTH: Final = 0.22
"""Standard deviation of the logarithm of strands' brightness about that of their surroundings."""

MOST_DEEPENED: Final = 2.5
"""Beyond it noise would be made into strands."""

STRAND_LEVEL: Final = 0.35
"""Median brightness of a head of hair."""


def used_pixels(
    uv: NDArray[np.float64], uv_faces: NDArray[np.int64], size: tuple[int, int]
) -> NDArray[np.bool_]:
    """``(H, W)`` where the mesh reads the texture; ``size`` is width, height."""
    mask = Image.new("1", size)
    draw = ImageDraw.Draw(mask)
    points = np.stack([uv[:, 0] * size[0], (1 - uv[:, 1]) * size[1]], axis=1)
    for face in uv_faces:
        draw.polygon([tuple(points[k]) for k in face if k >= 0], fill=1, outline=1)
    return ndimage.binary_dilation(np.asarray(mask), iterations=ISLAND_MARGIN)


def fill_unused(pixels: NDArray[np.float64], used: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Every unused pixel takes the colour of the nearest used one: no background bleeds in, no mark is
    left."""
    nearest = ndimage.distance_transform_edt(~used, return_distances=False, return_indices=True)
    return pixels[nearest[0], nearest[1]]


def cut_out(pixels: NDArray[np.float64], used: NDArray[np.bool_]) -> NDArray[np.float64]:
    """``(H, W, 4)`` with nothing left where no mesh reads it, and the colour of the nearest strand where
    the picture is clear: filtering would bring white paper into the strands beside."""
    alpha = np.where(used, pixels[..., 3], 0.0)
    solid = alpha > CLEAR
    colours = fill_unused(pixels[..., :3], solid) if solid.any() else pixels[..., :3]
    return np.concatenate([colours, alpha[..., None]], axis=2)


def strands_only(pixels: NDArray[np.float64]) -> NDArray[np.float64]:
    """A picture of hair in greys, as if lit from everywhere: painted sheen taken down, strands equally deep
    on all heads. Its colour is given to it by whoever wears it."""
    weight = np.where(pixels[..., 3] > CLEAR, 1.0, 0.0)
    light = np.log(np.clip(pixels[..., :3] @ LUMA / 255.0, 0.02, 1.0))
    total = ndimage.gaussian_filter(weight, SHEEN)
    broad = ndimage.gaussian_filter(light * weight, SHEEN) / np.clip(total, 1e-6, None)
    fine = light - broad
    seen = weight > 0
    depth = min(STRAND_DEPTH / max(float(fine[seen].std()), 1e-3), MOST_DEEPENED)
    level = float(np.median(broad[seen]))
    kept = np.exp(SHEEN_KEPT * (broad - level) + depth * fine)
    grey = np.clip(255.0 * STRAND_LEVEL * kept, 0, 255)
    return np.concatenate([np.repeat(grey[..., None], 3, axis=2), pixels[..., 3:]], axis=2)


def paint_out(pixels: NDArray[np.float64], patches: tuple[Patch, ...]) -> NDArray[np.float64]:
    """Covers each patch with the cloth beside it."""
    out = pixels.copy()
    for patch in patches:
        left, top, right, bottom = patch.box
        dx, dy = patch.shift
        inside = np.zeros(pixels.shape[:2])
        inside[top:bottom, left:right] = 1
        fade = np.clip(ndimage.distance_transform_edt(inside) / FEATHER, 0, 1)[top:bottom, left:right, None]
        cloth = pixels[top + dy : bottom + dy, left + dx : right + dx]
        out[top:bottom, left:right] = fade * cloth + (1 - fade) * out[top:bottom, left:right]
    return out


def read_rgb(path: Path) -> NDArray[np.float64]:
    """``(H, W, 3)`` in 0..255."""
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"), float)


def read_rgba(path: Path) -> NDArray[np.float64]:
    """``(H, W, 4)`` in 0..255."""
    with Image.open(path) as image:
        return np.asarray(image.convert("RGBA"), float)


def bake_shading(pixels: NDArray[np.float64], shading: NDArray[np.float64]) -> NDArray[np.float64]:
    """Darkens folds: ``shading (H, W, 3)`` is an ambient occlusion map."""
    return pixels * (1 - AO_STRENGTH + AO_STRENGTH * shading / 255.0)


def encode(pixels: NDArray[np.float64]) -> tuple[str, bytes]:
    """Suffix and bytes: JPEG, or WebP where there is an alpha channel."""
    image = Image.fromarray(np.clip(np.rint(pixels), 0, 255).astype(np.uint8))
    buffer = io.BytesIO()
    if image.mode == "RGBA":
        image.save(buffer, "WEBP", quality=WEBP_QUALITY, method=6, exact=True)
        return ".webp", buffer.getvalue()
    image.save(buffer, "JPEG", quality=JPEG_QUALITY, optimize=True)
    return ".jpg", buffer.getvalue()
