"""What textures are painted with: noise, cells with joints, scattered ellipses; all of it tiles."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

__all__ = ["Image", "cells", "clipped", "masonry", "noise", "strew", "tinted", "tones"]

Image = NDArray[np.float64]


def clipped(image: Image) -> Image:
    return np.asarray(np.clip(image, 0.0, 1.0), dtype=np.float64)


def noise(rng: np.random.Generator, size: int, slope: float = 1.6, coarsest: float = 2.0) -> Image:
    """Return tileable noise ``(size, size)`` with mean 0 and standard deviation 1.

    Args:
        slope: amplitude falls as frequency to the power ``-slope``; larger is smoother.
        coarsest: waves longer than ``size / coarsest`` are left out.
    """
    frequency = np.hypot(
        *np.meshgrid(np.fft.fftfreq(size) * size, np.fft.rfftfreq(size) * size, indexing="ij")
    )
    amplitude = np.where(frequency >= coarsest, np.maximum(frequency, 1.0) ** -slope, 0.0)
    phase = rng.uniform(0.0, 2.0 * np.pi, frequency.shape)
    field = np.fft.irfft2(amplitude * np.exp(1j * phase), s=(size, size))
    return np.asarray((field - field.mean()) / field.std())


def tinted(rng: np.random.Generator, size: int, color: tuple[float, float, float], grain: float) -> Image:
    """Return ``color`` broken up by soft patches and fine grain of relative strength ``grain``."""
    patches, fine = noise(rng, size, 1.8), noise(rng, size, 0.6, 24.0)
    tone = 1.0 + grain * (0.7 * patches + 0.6 * fine)
    return clipped(np.asarray(color) * tone[..., None])


def cells(size: int, rows: int, columns: int, stagger: float) -> tuple[NDArray[np.int64], Image]:
    """Return the cell index of each pixel and its distance to the cell's edge in pixels."""
    y, x = np.mgrid[0:size, 0:size].astype(np.float64)
    row = np.floor(y / size * rows)
    shifted = x / size * columns + stagger * (row % 2)
    column = np.floor(shifted) % columns
    inside_x = (shifted % 1.0) * size / columns
    inside_y = (y / size * rows % 1.0) * size / rows
    edge = np.minimum(
        np.minimum(inside_x, size / columns - inside_x), np.minimum(inside_y, size / rows - inside_y)
    )
    return (row * columns + column).astype(np.int64), edge


def masonry(
    rng: np.random.Generator,
    size: int,
    rows: int,
    columns: int,
    *,
    color: tuple[float, float, float],
    joint: tuple[float, float, float],
    stagger: float,
    spread: float,
    joint_width: float,
) -> Image:
    """Return stones of varied tone with joints between them."""
    index, edge = cells(size, rows, columns, stagger)
    tone = rng.normal(1.0, spread, rows * columns)[index]
    hue = rng.normal(0.0, spread / 14, (rows * columns, 3))[index]
    stones = tinted(rng, size, color, 0.10) * tone[..., None] + hue
    joints = tinted(rng, size, joint, 0.12)
    blend = np.clip((edge - joint_width) / 1.5, 0.0, 1.0)[..., None]
    return clipped(blend * stones + (1.0 - blend) * joints)


def strew(
    rng: np.random.Generator,
    image: Image,
    count: int,
    colors: tuple[tuple[float, float, float], ...],
    half: tuple[float, float],
    roundness: float,
) -> None:
    """Lay ``count`` ellipses of the colours on a tileable image: leaves, blossoms, stones.

    Args:
        half: range of their half lengths [px].
        roundness: width over length.
    """
    size = len(image)
    y, x = np.mgrid[-7:8, -7:8].astype(np.float64)
    for _ in range(count):
        turn, long = rng.uniform(0.0, np.pi), rng.uniform(*half)
        along, across = x * np.cos(turn) + y * np.sin(turn), y * np.cos(turn) - x * np.sin(turn)
        rows, columns = np.nonzero((along / long) ** 2 + (across / (roundness * long)) ** 2 < 1.0)
        row, column = rng.integers(0, size, 2)
        color = np.asarray(colors[rng.integers(len(colors))]) * rng.uniform(0.75, 1.25)
        image[(row + rows) % size, (column + columns) % size] = color


def tones(color: Image, factors: Iterable[float]) -> tuple[tuple[float, float, float], ...]:
    """Return lighter and darker kinds of an sRGB colour (3,)."""
    return tuple((float(f * color[0]), float(f * color[1]), float(f * color[2])) for f in factors)
