"""Floors of rooms: boards, herringbone, tiles, carpet, poured floors."""

import numpy as np
from numpy.typing import NDArray

from whacamole.stage.textures.painting import Image, clipped, masonry, noise, tinted

__all__ = ["BOARDS_METRES", "HERRINGBONE_METRES", "boards", "carpet", "floor_tiles", "herringbone", "poured"]

BOARDS_METRES = 2.4
"""Metres after which boards repeat: a plank in a row is as long, or cut in two."""

HERRINGBONE_METRES = 2.0

OAKS = ((0.60, 0.46, 0.32), (0.66, 0.54, 0.40), (0.47, 0.34, 0.23), (0.55, 0.47, 0.38), (0.36, 0.26, 0.19))
"""Honey, pale, brown, grey and smoked."""

_BLOCKS = 5
"""A block of herringbone is this many times as long as it is wide."""


def _oak(rng: np.random.Generator) -> NDArray[np.float64]:
    return np.asarray(OAKS[int(rng.integers(len(OAKS)))]) * rng.uniform(0.92, 1.08)


def _tones(rng: np.random.Generator, count: int, spread: float = 0.09) -> NDArray[np.float64]:
    """Return tints (count, 3) of boards: lighter and darker, a little redder or greyer."""
    return rng.normal(1.0, spread, (count, 1)) * rng.normal(1.0, 0.2 * spread, (count, 3))


def _grain(rng: np.random.Generator, size: int) -> Image:
    """Return streaks along x, fine and coarse, with mean 0."""
    fine = noise(rng, size, 0.4, 20.0)
    streaks = np.stack([np.roll(fine, step, axis=1) for step in range(0, 36, 4)]).mean(axis=0)
    return np.asarray(0.10 * streaks + 0.05 * noise(rng, size, 1.4))


def boards(rng: np.random.Generator, size: int = 768) -> Image:
    """Boards along x, 8 to 20 cm wide on 2.4 m, in rows of one long or two shorter ones."""
    rows = int(rng.integers(12, 28))
    y, x = np.mgrid[0:size, 0:size] / size
    row = np.floor(y * rows).astype(np.int64)
    starts, share = rng.uniform(0.0, 1.0, rows), rng.uniform(0.42, 0.58, rows)
    whole = rng.random(rows) < 0.3
    along = (x + starts[row]) % 1.0
    second = (along > share[row]) & ~whole[row]
    board = 2 * row + second
    joint = np.minimum(along, 1.0 - along) * size
    cut = np.where(whole[row], np.inf, np.abs(along - share[row]) * size)
    gap = np.minimum(y * rows % 1.0, 1.0 - y * rows % 1.0) * size / rows
    edge = np.clip(np.minimum(np.minimum(joint, cut), gap) / 1.3, 0.0, 1.0)
    shift = (board * 37) % size
    column = (np.arange(size)[None, :] + shift) % size
    grain = _grain(rng, size)[(np.arange(size)[:, None] + 5 * shift) % size, column]
    image = _oak(rng) * _tones(rng, 2 * rows)[board] * (1.0 + grain)[..., None]
    return clipped(image * (0.55 + 0.45 * edge)[..., None])


def herringbone(rng: np.random.Generator, size: int = 768) -> Image:
    """Blocks that meet at right angles, 10 × 50 cm on 2 m."""
    cells = 4 * _BLOCKS
    y, x = np.mgrid[0:size, 0:size] * (cells / size)
    i, j = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
    step = (i - j) % (2 * _BLOCKS)
    level = step < _BLOCKS
    along = np.where(level, step + x % 1.0, 2 * _BLOCKS - 1 - step + y % 1.0)
    across = np.where(level, y % 1.0, x % 1.0)
    first_i = np.where(level, i - step, i) % cells
    first_j = np.where(level, j, j - (2 * _BLOCKS - 1 - step)) % cells
    block = np.where(level, 0, cells * cells) + first_j * cells + first_i
    width = size / cells
    gap = np.minimum(np.minimum(across, 1.0 - across), np.minimum(along, _BLOCKS - along)) * width
    grain = _grain(rng, size)
    streaks = np.where(level, grain, grain.T)
    image = _oak(rng) * _tones(rng, 2 * cells * cells)[block] * (1.0 + streaks)[..., None]
    return clipped(image * (0.6 + 0.4 * np.clip(gap / 1.2, 0.0, 1.0))[..., None])


def floor_tiles(rng: np.random.Generator, size: int = 512) -> Image:
    """Square tiles, six to a side, of one pale, grey or terracotta tone."""
    tone = ((0.72, 0.70, 0.66), (0.55, 0.55, 0.54), (0.64, 0.44, 0.34))[int(rng.integers(3))]
    return masonry(
        rng, size, 6, 6, color=tone, joint=(0.45, 0.43, 0.40), stagger=0.0, spread=0.045, joint_width=1.2
    )


def carpet(rng: np.random.Generator, size: int = 512) -> Image:
    """Short pile, flecked, of one muted colour."""
    tones = ((0.50, 0.47, 0.43), (0.38, 0.41, 0.46), (0.58, 0.53, 0.45), (0.42, 0.34, 0.31))
    color = np.asarray(tones[int(rng.integers(4))]) * rng.uniform(0.9, 1.1)
    flecks = 0.14 * noise(rng, size, 0.2, 40.0) + 0.05 * noise(rng, size, 1.6)
    return clipped(color * (1.0 + flecks)[..., None])


def poured(rng: np.random.Generator, size: int = 512) -> Image:
    """Poured concrete or resin, pale grey without joints: stains, scuffs, fine grain. To be tinted."""
    image = tinted(rng, size, (0.80, 0.80, 0.79), 0.045)
    scuffs = np.clip(noise(rng, size, 1.0, 6.0) - 1.4, 0.0, 1.0)
    return clipped(image * (1.0 - 0.16 * scuffs)[..., None])
