"""Wood and cloth."""

import numpy as np

from whacamole.stage.textures.painting import Image, clipped, noise

__all__ = ["awning", "wood"]

BOARDS = 3


def wood(rng: np.random.Generator, size: int = 512) -> Image:
    """Planks along x with grain, each of boards of its own tone that meet at a joint."""
    planks = int(rng.integers(4, 8))
    y, x = np.mgrid[0:size, 0:size] / size
    plank = np.floor(y * planks).astype(np.int64)
    warp = 0.04 * noise(rng, size, 2.0)
    rings = np.sin(2.0 * np.pi * (y * planks * 6 + warp * 9 + np.sin(2 * np.pi * x) * 0.3 + plank * 0.37))
    along = (x * BOARDS + rng.uniform(0.0, 1.0, planks)[plank]) % BOARDS
    board = plank * BOARDS + np.floor(along).astype(np.int64)
    grain = 0.10 * rings + 0.10 * noise(rng, size, 0.5, 24.0)
    tone = rng.normal(1.0, 0.13, planks * BOARDS)[board] * (1.0 + grain)
    base = np.array([0.48, 0.34, 0.21]) * rng.uniform(0.7, 1.25)
    gap = np.minimum(y * planks % 1.0, 1.0 - y * planks % 1.0) * size / planks
    joint = np.minimum(along % 1.0, 1.0 - along % 1.0) * size / BOARDS
    edge = np.clip(np.minimum(gap, joint) / 2.0, 0.0, 1.0)
    return clipped(base * (tone * (0.4 + 0.6 * edge))[..., None])


CANVAS = (
    (0.62, 0.16, 0.14),
    (0.16, 0.36, 0.25),
    (0.18, 0.29, 0.46),
    (0.76, 0.58, 0.26),
    (0.45, 0.44, 0.42),
    (0.70, 0.38, 0.22),
)
"""Colours of market cloth."""


def awning(rng: np.random.Generator, size: int = 256) -> Image:
    """Canvas of one colour, or with pale stripes along y, faded in patches."""
    _, x = np.mgrid[0:size, 0:size] / size
    color, pale = np.array(CANVAS[rng.integers(len(CANVAS))]), np.array([0.88, 0.85, 0.78])
    stripes = (np.floor(x * 8) % 2)[..., None] * float(rng.random() < 0.7)
    image = (1.0 - stripes) * color + stripes * pale
    return clipped(
        image * (1.0 + 0.06 * noise(rng, size, 1.3) + 0.03 * noise(rng, size, 0.3, 30.0))[..., None]
    )
