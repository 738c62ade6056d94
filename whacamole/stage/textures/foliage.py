"""Bark, and the tones of leaves and blossoms."""

import numpy as np

from whacamole.stage.textures.painting import Image, clipped, noise

__all__ = ["bark", "blossom_tones", "leaf_tones"]

BLOSSOMS = (
    (0.78, 0.16, 0.20),
    (0.88, 0.70, 0.15),
    (0.75, 0.72, 0.80),
    (0.52, 0.24, 0.58),
    (0.86, 0.45, 0.58),
)


SEASONS = {
    "spring": ((0.36, 0.47, 0.16), (0.45, 0.52, 0.20)),
    "summer": ((0.20, 0.30, 0.09), (0.31, 0.40, 0.15)),
    "autumn": ((0.62, 0.42, 0.12), (0.52, 0.25, 0.09), (0.42, 0.40, 0.14), (0.66, 0.52, 0.18)),
    "conifer": ((0.13, 0.22, 0.12), (0.19, 0.27, 0.14)),
    "grass": ((0.25, 0.34, 0.12), (0.38, 0.44, 0.18), (0.50, 0.47, 0.27)),
    "houseplant": ((0.16, 0.30, 0.12), (0.26, 0.42, 0.17)),
}
"""Colours of leaves."""


def leaf_tones(rng: np.random.Generator, size: int = 64, season: str = "summer") -> Image:
    """16 × 16 fields, a leaf's tone each: those of a season, lighter and darker, a few withered."""
    return _fields(rng, size, np.asarray(SEASONS[season]), 0.18)


def blossom_tones(rng: np.random.Generator, size: int = 64) -> Image:
    """16 × 16 fields, the tones of blossoms of two or three kinds."""
    kinds = rng.choice(len(BLOSSOMS), int(rng.integers(2, 4)), replace=False)
    return _fields(rng, size, np.asarray(BLOSSOMS)[kinds], 0.1)


def _fields(rng: np.random.Generator, size: int, colors: Image, spread: float) -> Image:
    mix = rng.dirichlet(np.full(len(colors), 0.5), (16, 16))
    field = mix @ colors * np.exp(rng.normal(0.0, spread, (16, 16, 1)))
    return clipped(field.repeat(size // 16, axis=0).repeat(size // 16, axis=1))


def bark(rng: np.random.Generator, size: int = 256) -> Image:
    """Grey-brown bark, furrowed along the trunk (v)."""
    furrows, fine = noise(rng, size, 0.9, 8.0), noise(rng, size, 0.4, 30.0)
    # Stretched along the trunk: every fourth row, four times as long; the rows between are blended.
    rows = np.arange(size) / 4.0
    low = np.floor(rows).astype(int)
    share = (rows - low)[:, None]
    quarter = size // 4
    stretched = (1.0 - share) * furrows[low % quarter] + share * furrows[(low + 1) % quarter]
    base = np.array([0.36, 0.30, 0.24]) * rng.uniform(0.75, 1.2) * [1.0, 1.0, rng.uniform(0.9, 1.1)]
    tone = 1.0 + 0.30 * np.clip(stretched, -1.6, 1.4) + 0.10 * fine
    return clipped(base * tone[..., None])
