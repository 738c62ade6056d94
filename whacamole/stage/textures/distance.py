"""What is seen from afar: house fronts, wooded land, rows of trees; paler with distance, as through haze."""

import numpy as np

from whacamole.stage.textures.painting import Image, clipped, noise

__all__ = ["HAZE", "distant_front", "distant_land", "hazed", "tree_row"]

HAZE = np.array([0.70, 0.76, 0.83])
"""Colour of the air before distant things."""

WALLS = (
    (0.74, 0.70, 0.62),
    (0.66, 0.62, 0.57),
    (0.52, 0.34, 0.27),
    (0.60, 0.50, 0.40),
    (0.56, 0.56, 0.55),
    (0.70, 0.60, 0.46),
)
"""Plaster, sandstone, brick, concrete."""


def hazed(color: Image, haze: float) -> Image:
    """Return a colour or picture (…, 3) seen through haze, 0 none to 1 nothing else."""
    return np.asarray((1.0 - haze) * color + haze * HAZE)


def distant_front(rng: np.random.Generator, size: int = 128, haze: float = 0.2) -> Image:
    """Four storeys of four windows each, some shuttered, some with blinds."""
    wall = np.asarray(WALLS[int(rng.integers(len(WALLS)))]) * rng.uniform(0.85, 1.1)
    image = wall * (1.0 + 0.05 * noise(rng, size, 1.4))[..., None]
    y, x = np.mgrid[0:size, 0:size] / size * 4.0
    width, height = rng.uniform(0.3, 0.5), rng.uniform(0.45, 0.6)
    across, up = np.abs(x % 1.0 - 0.5), np.abs(y % 1.0 - 0.5)
    image[(across < width / 2 + 0.06) & (up < height / 2 + 0.05)] = 1.15 * wall
    glass = rng.uniform(0.08, 0.34, (4, 4))[y.astype(int), x.astype(int), None] * np.array([0.85, 0.95, 1.1])
    pane = (across < width / 2) & (up < height / 2)
    image[pane] = glass[pane]
    return clipped(hazed(image, haze))


def distant_land(rng: np.random.Generator, size: int = 256, haze: float = 0.3) -> Image:
    """Hills with woods and meadows."""
    woods, crowns = noise(rng, size, 1.5, 3.0), noise(rng, size, 0.5, 24.0)
    meadow, forest = np.array([0.38, 0.42, 0.22]), np.array([0.17, 0.24, 0.12])
    share = np.clip(2.5 * (woods + 0.5), 0.0, 1.0)[..., None]
    tone = 1.0 + (0.06 + 0.22 * share[..., 0]) * crowns
    return clipped(hazed(((1.0 - share) * meadow + share * forest) * tone[..., None], haze))


def tree_row(rng: np.random.Generator, size: int = 512, haze: float = 0.15) -> Image:
    """Return a row of trees ``(size / 4, size, 4)``, cut out by alpha; it repeats along x."""
    height = size // 4
    image = np.zeros((height, size, 4))
    image[..., :3] = hazed(np.array([0.13, 0.18, 0.08]), haze)
    _undergrowth(rng, image)
    green = np.array([0.24, 0.33, 0.13])
    x = rng.uniform(0.0, size)
    for _ in range(int(rng.integers(8, 12))):
        x += size * rng.uniform(0.07, 0.14)
        tone = green * rng.uniform(0.75, 1.2) * [rng.uniform(0.85, 1.5), 1.0, rng.uniform(0.8, 1.1)]
        _crown(rng, image, x, height * rng.uniform(0.55, 0.95), hazed(tone, haze))
    return clipped(image)


def _undergrowth(rng: np.random.Generator, image: Image) -> None:
    """Fill the foot of a row of trees with bushes."""
    height, size = image.shape[:2]
    top = height * (0.22 + 0.05 * noise(rng, size, 1.2)[0])
    up = height - 1 - np.arange(height)[:, None]
    inside = up < np.maximum(top, 0.06 * height)
    shade = (
        0.7 + 0.6 * np.clip(up / np.maximum(top, 1.0), 0.0, 1.0) + 0.2 * noise(rng, size, 0.4, 40.0)[:height]
    )
    image[..., :3] = np.where(inside[..., None], image[..., :3] * shade[..., None], image[..., :3])
    image[inside, 3] = 1.0


def _crown(rng: np.random.Generator, image: Image, x: float, top: float, color: Image) -> None:
    """Paint a tree of ``top`` pixels: boughs of small dabs, lighter towards the sky."""
    height, size = image.shape[:2]
    boughs = int(rng.integers(5, 9))
    center = np.stack(
        [x + 0.30 * top * rng.uniform(-1.0, 1.0, boughs), top * rng.uniform(0.35, 0.85, boughs)], axis=1
    )
    reach = 0.26 * top * rng.uniform(0.7, 1.0, boughs) * np.clip(1.5 - center[:, 1] / top, 0.5, 1.0)
    for (middle, up), radius in zip(center[np.argsort(center[:, 1])], reach, strict=True):
        offset = rng.normal(0.0, 0.45 * radius, (int(0.5 * radius**2) + 20, 2))
        offset = offset[np.argsort(offset[:, 1])]
        light = 0.75 + 0.35 * offset[:, 1] / radius + rng.normal(0.0, 0.12, len(offset))
        for dx, dy in ((0, 0), (1, 0), (0, 1), (-1, 0), (0, -1), (1, 1)):
            column = (middle + offset[:, 0] + dx).astype(int) % size
            row = np.clip(height - 1 - (up + offset[:, 1] + dy).astype(int), 3, height - 1)
            image[row, column, :3] = color * light[:, None]
            image[row, column, 3] = 1.0
