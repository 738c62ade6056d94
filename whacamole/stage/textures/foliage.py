"""Foliage and flower beds."""

import numpy as np

from whacamole.stage.textures.painting import Image, clipped, noise, strew

__all__ = ["flowers", "leaves"]

BLOSSOMS = (
    (0.78, 0.16, 0.20),
    (0.88, 0.70, 0.15),
    (0.75, 0.72, 0.80),
    (0.52, 0.24, 0.58),
    (0.86, 0.45, 0.58),
)


def flowers(rng: np.random.Generator, size: int = 512) -> Image:
    """A flower bed: blossoms of two or three colours over dark leaves."""
    image = 0.75 * leaves(rng, size)
    kinds = rng.choice(len(BLOSSOMS), int(rng.integers(2, 4)), replace=False)
    strew(rng, image, size * size // 350, tuple(BLOSSOMS[kind] for kind in kinds), (3.0, 7.0), 0.9)
    return clipped(image)


def leaves(rng: np.random.Generator, size: int = 512) -> Image:
    """Foliage: clumps of light and dark green, with leaves that catch the light and gaps between them."""
    clumps, fine = noise(rng, size, 1.0, 8.0), noise(rng, size, 0.3, 40.0)
    green = np.array([0.20, 0.30, 0.10]) * rng.uniform(0.8, 1.3) * [rng.uniform(0.8, 1.6), 1.0, 1.0]
    image = green * (1.0 + 0.35 * clumps + 0.25 * fine)[..., None]
    tones = tuple(
        (float(t * green[0]), float(t * green[1]), float(t * green[2])) for t in (0.25, 0.4, 1.5, 1.9)
    )
    strew(rng, image, size * size // 250, tones, (3.0, 7.0), 0.6)
    return clipped(image)
