"""Colour arithmetic."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from render_jobs.scene import Colour


def linear(colour: Colour) -> tuple[float, float, float]:
    """sRGB in 0..1 as linear light (IEC 61966-2-1)."""
    value = np.asarray(colour)
    curve = np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)
    return float(curve[0]), float(curve[1]), float(curve[2])


def srgb(light: Sequence[float]) -> Colour:
    """Linear light as sRGB in 0..1, clipped: the inverse of :func:`linear`."""
    value = np.clip(np.asarray(light, float)[:3], 0.0, 1.0)
    curve = np.where(value <= 0.0031308, value * 12.92, 1.055 * value ** (1 / 2.4) - 0.055).clip(0.0, 1.0)
    return float(curve[0]), float(curve[1]), float(curve[2])


def linear_image(pixels: NDArray[np.uint8]) -> NDArray[np.float32]:
    """8-bit sRGB of any shape as linear light."""
    value = np.arange(256) / 255.0
    curve = np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)
    light: NDArray[np.float32] = curve.astype(np.float32)[pixels]
    return light


def encoded(light: NDArray[Any]) -> NDArray[np.uint8]:
    """Linear light as 8-bit sRGB (IEC 61966-2-1), clipped."""
    value = np.clip(light, 0.0, 1.0)
    curve = np.where(value <= 0.0031308, value * 12.92, 1.055 * value ** (1 / 2.4) - 0.055)
    pixels: NDArray[np.uint8] = np.rint(curve * 255.0).astype(np.uint8)
    return pixels
