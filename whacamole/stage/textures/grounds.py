"""Grounds: paving, asphalt, gravel, grass, concrete."""

import numpy as np

from whacamole.stage.textures.painting import Image, cells, clipped, masonry, noise, strew, tinted, tones

__all__ = ["asphalt", "clinker", "concrete", "grass", "gravel", "setts", "slabs"]

AUTUMN = ((0.55, 0.42, 0.18), (0.42, 0.24, 0.10), (0.62, 0.54, 0.30), (0.30, 0.22, 0.12))


DAISIES = ((0.88, 0.87, 0.80), (0.90, 0.82, 0.30), (0.85, 0.80, 0.86))


def slabs(rng: np.random.Generator, size: int = 576) -> Image:
    """Stone slabs of 40 × 40 or 60 × 40 cm where they repeat every 4.8 m, worn and stained."""
    base = np.array([0.57, 0.54, 0.50]) * rng.uniform(0.8, 1.1) + rng.normal(0.0, 0.015, 3)
    image = masonry(
        rng, size, 12, int(rng.choice([8, 12])), color=(base[0], base[1], base[2]), joint=(0.34, 0.33, 0.31),
        stagger=float(rng.choice([0.0, 0.5])), spread=0.07, joint_width=1.2,
    )  # fmt: skip
    return _stained(rng, image)


def setts(rng: np.random.Generator, size: int = 576) -> Image:
    """Stones of 10 × 10 cm where they repeat every 3.6 m."""
    base = np.array([0.47, 0.46, 0.45]) * rng.uniform(0.85, 1.15) + rng.normal(0.0, 0.015, 3)
    image = masonry(
        rng, size, 36, 36, color=(base[0], base[1], base[2]), joint=(0.27, 0.26, 0.24),
        stagger=0.5, spread=0.13, joint_width=1.6,
    )  # fmt: skip
    return _stained(rng, image)


def clinker(rng: np.random.Generator, size: int = 576) -> Image:
    """Paving bricks of 20 × 10 cm where they repeat every 3.6 m."""
    base = np.array([0.47, 0.33, 0.27]) * rng.uniform(0.85, 1.15) + rng.normal(0.0, 0.015, 3)
    image = masonry(
        rng, size, 36, 18, color=(base[0], base[1], base[2]), joint=(0.36, 0.33, 0.29),
        stagger=0.5, spread=0.11, joint_width=0.9,
    )  # fmt: skip
    return _stained(rng, image)


def _stained(rng: np.random.Generator, image: Image) -> Image:
    """Darken a ground in patches, and spot it as chewing gum and oil do."""
    size = len(image)
    image = image * (1.0 + 0.06 * noise(rng, size, 1.5))[..., None]
    strew(rng, image, 40, ((0.24, 0.23, 0.22), (0.62, 0.60, 0.57), (0.33, 0.31, 0.29)), (1.5, 4.5), 0.85)
    return clipped(image)


def asphalt(rng: np.random.Generator, size: int = 512) -> Image:
    """Dark, coarse-grained, with worn patches."""
    ground = tinted(rng, size, (0.26, 0.26, 0.27), 0.12)
    stones = np.clip(noise(rng, size, 0.2, 60.0) - 1.1, 0.0, 1.0)[..., None]
    return clipped(ground + 0.25 * stones)


def grass(rng: np.random.Generator, size: int = 512) -> Image:
    """Short grass in tufts, with dry and bare patches, daisies and fallen leaves."""
    blades, tufts, patches = noise(rng, size, 0.5, 30.0), noise(rng, size, 0.9, 12.0), noise(rng, size, 1.8)
    green, dry, earth = (np.array(c) for c in ([0.22, 0.31, 0.12], [0.46, 0.43, 0.24], [0.30, 0.23, 0.16]))
    mix = np.clip(0.35 + 0.28 * patches, 0.0, 1.0)[..., None]
    shade = 1.0 + 0.22 * blades + 0.24 * np.clip(tufts, -1.5, 1.8)
    image = ((1.0 - mix) * green + mix * dry) * shade[..., None]
    worn = np.clip(3.0 * (noise(rng, size, 1.2, 3.0) - 1.5), 0.0, 1.0)[..., None]
    image = (1.0 - worn) * image + worn * earth * (1.0 + 0.15 * blades)[..., None]
    strew(rng, image, size * size // 1000, AUTUMN, (2.5, 6.5), 0.55)
    strew(rng, image, size * size // 1500, DAISIES, (1.6, 2.6), 1.0)
    return clipped(image)


def gravel(rng: np.random.Generator, size: int = 512) -> Image:
    """Trodden gravel: pale, with stones of many sizes and damp patches."""
    pale = np.array([0.60, 0.55, 0.46]) * rng.uniform(0.85, 1.1)
    image = pale * (1.0 + 0.10 * noise(rng, size, 1.8) + 0.10 * noise(rng, size, 0.3, 60.0))[..., None]
    strew(rng, image, size * size // 500, tones(pale, rng.uniform(0.55, 1.35, 4)), (1.5, 5.0), 0.8)
    return clipped(image)


def concrete(rng: np.random.Generator, size: int = 512) -> Image:
    """Cast panels with stains."""
    index, edge = cells(size, 2, 2, 0.0)
    tone = rng.normal(1.0, 0.05, 4)[index]
    grey = rng.uniform(0.45, 0.66)
    panel = tinted(rng, size, (grey, grey, grey * 0.97), 0.07) * tone[..., None]
    return clipped(panel * (0.62 + 0.38 * np.clip(edge / 2.5, 0.0, 1.0))[..., None])
