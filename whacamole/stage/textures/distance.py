"""What is seen from afar: house fronts, wooded land, rows of trees; paler with distance, as through haze."""

import numpy as np

from whacamole.stage.textures.painting import Image, clipped, noise

__all__ = ["HAZE", "distant_front", "distant_land", "distant_woods", "hazed"]

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


def distant_woods(rng: np.random.Generator, size: int = 512, haze: float = 0.15) -> Image:
    """The edge of a wood ``(size / 4, size, 3)``, dark at its foot; it repeats along x."""
    height = size // 4
    image = np.zeros((height, size, 3)) + hazed(np.array([0.11, 0.16, 0.07]), haze)
    green = np.array([0.24, 0.33, 0.13])
    x, tone = 0.0, green
    for bough in np.sort(rng.uniform(0.0, 1.05, 110)):
        if rng.random() < 0.4:  # the next tree
            x = rng.uniform(0.0, size)
            tone = green * rng.uniform(0.75, 1.2) * [rng.uniform(0.85, 1.5), 1.0, rng.uniform(0.8, 1.1)]
        shade = 0.6 + 0.45 * bough
        _bough(rng, image, x + rng.normal(0.0, 0.2 * height), height * bough, hazed(tone * shade, haze))
    return clipped(image)


def _bough(rng: np.random.Generator, image: Image, x: float, up: float, color: Image) -> None:
    """Paint a mass of leaves in small dabs, lighter towards the sky."""
    height, size = image.shape[:2]
    radius = height * rng.uniform(0.12, 0.2)
    offset = rng.normal(0.0, 0.45 * radius, (int(0.5 * radius**2) + 20, 2))
    offset = offset[np.argsort(offset[:, 1])]
    light = 0.75 + 0.35 * offset[:, 1] / radius + rng.normal(0.0, 0.12, len(offset))
    for dx, dy in ((0, 0), (1, 0), (0, 1), (-1, 0), (0, -1), (1, 1)):
        column = (x + offset[:, 0] + dx).astype(int) % size
        row = np.clip(height - 1 - (up + offset[:, 1] + dy).astype(int), 0, height - 1)
        image[row, column] = color * light[:, None]
