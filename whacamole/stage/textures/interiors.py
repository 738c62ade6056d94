"""What is inside a room: paint, wallpaper, timber, woven cloth, coloured things, pictures, boxes of board.

Those that are made to be tinted are pale and nearly grey; a material's base colour gives them theirs.
"""

import numpy as np

from whacamole.stage.textures.painting import Image, cells, clipped, noise

__all__ = [
    "CELLS",
    "art",
    "blockwork",
    "cardboard",
    "paint",
    "palette",
    "rug",
    "timber",
    "wallpaper",
    "weave",
]

CELLS = 4
"""Pictures of ``art`` and colours of ``palette`` to a side."""

MUTED = (
    (0.30, 0.22, 0.18),
    (0.52, 0.20, 0.17),
    (0.70, 0.56, 0.33),
    (0.22, 0.30, 0.40),
    (0.26, 0.36, 0.29),
    (0.78, 0.74, 0.66),
    (0.40, 0.40, 0.41),
    (0.62, 0.38, 0.22),
    (0.17, 0.18, 0.21),
    (0.55, 0.62, 0.66),
    (0.47, 0.29, 0.33),
    (0.86, 0.84, 0.80),
    (0.72, 0.46, 0.20),
    (0.35, 0.45, 0.52),
    (0.58, 0.58, 0.46),
    (0.64, 0.20, 0.16),
)
"""Colours of books, boxes, vases and such: sixteen, few of them loud."""


def _grey(tone: Image) -> Image:
    """Return one channel (H, W) as three."""
    return clipped(np.repeat(tone[..., None], 3, axis=2))


def paint(rng: np.random.Generator, size: int = 512) -> Image:
    """Wall paint put on with a roller: nearly even, with marks that odometry can hold on to. To be tinted."""
    roller, clouds, specks = noise(rng, size, 0.4, 50.0), noise(rng, size, 1.7), noise(rng, size, 0.3, 24.0)
    marks = np.clip(specks - 2.6, 0.0, 1.0)
    return clipped(
        np.full((size, size, 3), 0.93) * (1.0 + 0.014 * roller + 0.02 * clouds - 0.12 * marks)[..., None]
    )


def wallpaper(rng: np.random.Generator, size: int = 512) -> Image:
    """A small figure or fine stripes, a tone darker than their ground. To be tinted."""
    y, x = np.mgrid[0:size, 0:size] / size
    count = 2 * int(rng.integers(3, 7))  # staggered columns meet at the border only if their number is even
    if rng.random() < 0.4:
        mask = 0.6 * (np.abs(x * count % 1.0 - 0.5) < 0.22) + 0.4 * (np.abs(x * count % 1.0 - 0.5) < 0.03)
    else:
        u, v = x * count % 1.0 - 0.5, (y * count + 0.5 * (np.floor(x * count) % 2)) % 1.0 - 0.5
        angle, radius = np.arctan2(v, u), np.hypot(u, v)
        petals = int(rng.integers(2, 5))
        bloom = radius < 0.16 + 0.14 * np.cos(petals * angle) ** 2
        mask = bloom & (radius > 0.05)
    strength = rng.uniform(0.06, 0.13)
    tone = 0.94 * (1.0 - strength * mask + 0.012 * noise(rng, size, 0.8))
    return _grey(tone)


def timber(rng: np.random.Generator, size: int = 512) -> Image:
    """Veneer: straight grain along x, pores, no joints. To be tinted."""
    y = np.mgrid[0:size, 0:size][0] / size
    warp = 0.5 * noise(rng, size, 2.2)
    rings = np.sin(2.0 * np.pi * (14 * y + 0.35 * warp)) + 0.5 * np.sin(2.0 * np.pi * (33 * y + 0.8 * warp))
    fine = noise(rng, size, 0.4, 30.0)
    pores = np.stack([np.roll(fine, step, axis=1) for step in range(0, 28, 4)]).mean(axis=0)
    tone = 0.86 * (1.0 + 0.06 * rings + 0.07 * pores + 0.03 * noise(rng, size, 1.4))
    return clipped(tone[..., None] * np.array([1.0, 0.97, 0.93]))


def weave(rng: np.random.Generator, size: int = 512) -> Image:
    """Upholstery: threads over and under, slubs. To be tinted."""
    y, x = np.mgrid[0:size, 0:size] * (np.pi / 4.0)
    threads = np.sin(x) * np.sin(y)
    slubs = np.clip(noise(rng, size, 0.3, 40.0) - 1.0, 0.0, 1.5)
    tone = 0.86 * (1.0 + 0.06 * threads + 0.05 * noise(rng, size, 0.9, 6.0) - 0.07 * slubs)
    return _grey(tone)


def palette(rng: np.random.Generator, size: int = 128) -> Image:
    """Sixteen fields of colour for small things."""
    index, _ = cells(size, CELLS, CELLS, 0.0)
    colors = np.asarray(MUTED)[rng.permutation(len(MUTED))] * rng.uniform(0.85, 1.15, (len(MUTED), 1))
    return clipped(colors[index] * (1.0 + 0.03 * noise(rng, size, 0.4))[..., None])


def art(rng: np.random.Generator, size: int = 512) -> Image:
    """Sixteen pictures to hang: horizons, soft fields, shapes on a ground."""
    side = size // CELLS
    rows = [np.concatenate([_picture(rng, side) for _ in range(CELLS)], axis=1) for _ in range(CELLS)]
    return clipped(np.concatenate(rows))


def _picture(rng: np.random.Generator, side: int) -> Image:
    y, x = np.mgrid[0:side, 0:side] / side
    colors = np.asarray(MUTED)[rng.permutation(len(MUTED))[:5]]
    image = np.broadcast_to(colors[0], (side, side, 3)) * (1.0 + 0.1 * noise(rng, side, 1.2))[..., None]
    if rng.random() < 0.5:  # a landscape: sky above ridges, each nearer one darker
        image = (0.55 + 0.4 * y)[..., None] * np.array([0.80, 0.86, 0.92]) * np.ones((side, side, 1))
        for ridge, color in enumerate(colors[1:4]):
            crest = 0.45 + 0.15 * ridge + 0.06 * noise(rng, side, 1.8)[0]
            land = color * (1.0 + 0.12 * noise(rng, side, 0.9))[..., None]
            image = np.where((y > crest)[..., None], land, image)
        return np.asarray(image)
    for color in colors[1:]:
        u, v = x - rng.uniform(0.2, 0.8), y - rng.uniform(0.2, 0.8)
        a, b = rng.uniform(0.08, 0.35, 2)
        inside = np.hypot(u / a, v / b) < 1.0 if rng.random() < 0.5 else (np.abs(u) < a) & (np.abs(v) < b)
        image = np.where(inside[..., None], color, image)
    return np.asarray(image)


def rug(rng: np.random.Generator, size: int = 512) -> Image:
    """A rug's field on a metre: small diamonds and stripes in three muted tones, or a plain pile."""
    y, x = np.mgrid[0:size, 0:size] / size
    ground, first, second = np.asarray(MUTED)[rng.permutation(len(MUTED))[:3]]
    ground = 0.5 * ground + 0.3
    count = int(rng.integers(2, 5))
    u, v = np.abs(x * count % 1.0 - 0.5), np.abs(y * count % 1.0 - 0.5)
    image = np.broadcast_to(ground, (size, size, 3))
    if rng.random() < 0.7:
        image = np.where((np.abs(u + v - 0.42) < 0.05)[..., None], first, image)
        image = np.where((u + v < 0.16)[..., None], second, image)
        image = np.where((v > 0.46)[..., None], 0.5 * (first + ground), image)
    return clipped(image * (1.0 + 0.09 * noise(rng, size, 0.3, 30.0))[..., None])


def cardboard(rng: np.random.Generator, size: int = 256) -> Image:
    """Corrugated board, half a metre of it: a strip of tape along the middle, a label, a print."""
    y, x = np.mgrid[0:size, 0:size] / size
    image = np.array([0.63, 0.50, 0.36]) * (1.0 + 0.03 * noise(rng, size, 1.2))[..., None]
    image = image * (1.0 + 0.02 * np.sin(2.0 * np.pi * 64 * x))[..., None]
    image = np.where((np.abs(y - 0.5) < 0.045)[..., None], image * [1.12, 1.05, 0.9], image)
    left, low = rng.uniform(0.1, 0.6, 2)
    label = (np.abs(x - left - 0.13) < 0.13) & (np.abs(y - low - 0.08) < 0.08)
    image = np.where(label[..., None], 0.86, image)
    print_ = label & (np.sin(2.0 * np.pi * 20 * y) > 0.2) & (np.abs(x - left - 0.13) < 0.1)
    return clipped(np.where(print_[..., None], 0.2, image))


def blockwork(rng: np.random.Generator, size: int = 512) -> Image:
    """Painted masonry of concrete blocks, 20 × 40 cm on 1.6 m. To be tinted."""
    index, edge = cells(size, 8, 4, 0.5)
    tone = rng.normal(0.90, 0.018, 32)[index] * (1.0 + 0.03 * noise(rng, size, 0.7, 8.0))
    return clipped(
        np.repeat((tone * (0.72 + 0.28 * np.clip((edge - 0.6) / 2.0, 0.0, 1.0)))[..., None], 3, axis=2)
    )
