"""Walls: brick, plaster, house fronts, wallpaper."""

import numpy as np

from whacamole.stage.textures.painting import Image, clipped, dye, masonry, noise, tinted

__all__ = ["brick", "facade", "plaster", "wallpaper"]


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


def facade(rng: np.random.Generator, size: int = 512) -> Image:
    """One storey of a house front: plaster or brick around a row of windows."""
    wall = plaster(rng, size) if rng.random() < 0.6 else brick(rng, size)
    image = wall.copy()
    windows = int(rng.integers(2, 4))
    width, bottom, top = rng.uniform(0.42, 0.6) / windows, rng.uniform(0.12, 0.2), rng.uniform(0.68, 0.8)
    glass = np.clip(0.16 + 0.10 * noise(rng, size, 2.0), 0.03, 0.5)[..., None] * np.array([0.8, 0.95, 1.1])
    y, x = np.mgrid[0:size, 0:size] / size
    cell = (x * windows) % 1.0 / windows - 0.5 / windows
    for margin, paint in ((0.016, np.full_like(image, 0.85)), (0.0, glass)):
        inside = (np.abs(cell) < width / 2 + margin) & (y > 1.0 - top - margin) & (y < 1.0 - bottom + margin)
        image[inside] = paint[inside]
    return clipped(image)


def wallpaper(rng: np.random.Generator, size: int = 512) -> Image:
    """A printed pattern of dots and stripes on a pale ground."""
    y, x = np.mgrid[0:size, 0:size] / size
    pale, print_color = 0.55 + 0.45 * dye(rng), dye(rng)
    count = 2 * int(rng.integers(2, 5))  # staggered columns meet at the border only if their number is even
    cell_x, cell_y = x * count % 1.0 - 0.5, (y * count + 0.5 * (np.floor(x * count) % 2)) % 1.0 - 0.5
    dots = np.hypot(cell_x, cell_y) < rng.uniform(0.12, 0.3)
    stripes = np.abs(cell_x) < 0.03
    image = np.where((dots | stripes)[..., None], print_color, pale)
    return clipped(image * (1.0 + 0.03 * noise(rng, size, 1.0))[..., None])
