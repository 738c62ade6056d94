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
        image.save(buffer, "WEBP", quality=WEBP_QUALITY, method=6)
        return ".webp", buffer.getvalue()
    image.save(buffer, "JPEG", quality=JPEG_QUALITY, optimize=True)
    return ".jpg", buffer.getvalue()
