"""Walls and roofs: brick, stone, plaster, tiles."""

import numpy as np

from whacamole.stage.textures.painting import Image, cells, clipped, masonry, noise, tinted

__all__ = ["ashlar", "brick", "brickwork", "plaster", "roof_tiles", "stucco"]


def brick(rng: np.random.Generator, size: int = 512) -> Image:
    """A running bond of bricks."""
    base = np.array([0.50, 0.30, 0.23]) * rng.uniform(0.8, 1.2) + rng.normal(0.0, 0.015, 3)
    return masonry(
        rng, size, 16, 8,
        color=(base[0], base[1], base[2]), joint=(0.62, 0.60, 0.56),
        stagger=0.5, spread=0.14, joint_width=1.2,
    )  # fmt: skip


def plaster(rng: np.random.Generator, size: int = 512) -> Image:
    """Painted, slightly uneven."""
    hue = rng.uniform(0.0, 1.0)
    color = rng.uniform(0.6, 0.8) * (1.0 + 0.09 * np.cos(2.0 * np.pi * (hue + np.array([0.0, 0.33, 0.67]))))
    color *= np.array([1.05, 1.0, 0.92])  # paints are warm more often than not
    return tinted(rng, size, (color[0], color[1], color[2]), 0.08)


def stucco(rng: np.random.Generator, size: int = 512) -> Image:
    """Rendered wall, nearly white to be tinted: blotches, grain, and streaks that rain has left."""
    streaks = np.repeat(noise(rng, size, 0.9, 6.0)[:1], size, axis=0)
    streaks = streaks * np.clip(0.5 + 0.5 * noise(rng, size, 1.8), 0.0, 1.2)
    tone = 0.86 * (1.0 + 0.022 * noise(rng, size, 1.5) + 0.025 * noise(rng, size, 0.4, 40.0) + 0.02 * streaks)
    return clipped(tone[..., None] * np.array([1.0, 0.995, 0.98]))


def brickwork(rng: np.random.Generator, size: int = 512) -> Image:
    """Bricks of 25 × 7.7 cm with their joints, where the texture repeats every 4 m."""
    base = np.array([0.56, 0.34, 0.26]) * rng.uniform(0.85, 1.2) + rng.normal(0.0, 0.02, 3)
    image = masonry(
        rng, size, 52, 16,
        color=(base[0], base[1], base[2]), joint=(0.60, 0.57, 0.52),
        stagger=0.5, spread=0.13, joint_width=0.4,
    )  # fmt: skip
    return clipped(image * (1.0 + 0.07 * noise(rng, size, 1.8))[..., None])


def ashlar(rng: np.random.Generator, size: int = 512) -> Image:
    """Dressed stone, nearly white to be tinted; blocks of 60 × 40 cm where it repeats every 2.4 m."""
    return masonry(
        rng, size, 6, 4, color=(0.80, 0.78, 0.73), joint=(0.52, 0.50, 0.46),
        stagger=0.5, spread=0.055, joint_width=1.6,
    )  # fmt: skip


def roof_tiles(rng: np.random.Generator, size: int = 512) -> Image:
    """Rows of tiles that shade each other, nearly white to be tinted; 20 × 33 cm if repeated every 4 m."""
    rows, columns = 12, 20
    index, edge = cells(size, rows, columns, 0.5)
    y = np.mgrid[0:size, 0:size][0] / size * rows % 1.0
    tone = rng.normal(0.78, 0.08, rows * columns)[index] * (0.7 + 0.3 * y) * np.clip(edge / 2.0, 0.5, 1.0)
    return clipped((tone * (1.0 + 0.06 * noise(rng, size, 1.6)))[..., None] * np.array([1.0, 0.99, 0.97]))
