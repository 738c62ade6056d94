"""Tileable surface textures from a few numbers and a seed: grounds, walls, wood.

Every texture is a square ``(N, N, 3)`` array of sRGB in [0, 1] that repeats without a seam. Each carries
detail at many scales, because visual odometry and the eye both need something to hold on to.
"""

from collections.abc import Callable, Iterable

import numpy as np
from numpy.typing import NDArray

__all__ = ["TEXTURES"]

Image = NDArray[np.float64]


def _clipped(image: Image) -> Image:
    return np.asarray(np.clip(image, 0.0, 1.0), dtype=np.float64)


def noise(rng: np.random.Generator, size: int, slope: float = 1.6, coarsest: float = 2.0) -> Image:
    """Return tileable noise ``(size, size)`` with mean 0 and standard deviation 1.

    Args:
        slope: amplitude falls as frequency to the power ``-slope``; larger is smoother.
        coarsest: waves longer than ``size / coarsest`` are left out.
    """
    frequency = np.hypot(
        *np.meshgrid(np.fft.fftfreq(size) * size, np.fft.rfftfreq(size) * size, indexing="ij")
    )
    amplitude = np.where(frequency >= coarsest, np.maximum(frequency, 1.0) ** -slope, 0.0)
    phase = rng.uniform(0.0, 2.0 * np.pi, frequency.shape)
    field = np.fft.irfft2(amplitude * np.exp(1j * phase), s=(size, size))
    return np.asarray((field - field.mean()) / field.std())


def _tinted(rng: np.random.Generator, size: int, color: tuple[float, float, float], grain: float) -> Image:
    """Return ``color`` broken up by soft patches and fine grain of relative strength ``grain``."""
    patches, fine = noise(rng, size, 1.8), noise(rng, size, 0.6, 24.0)
    tone = 1.0 + grain * (0.7 * patches + 0.6 * fine)
    return _clipped(np.asarray(color) * tone[..., None])


def _cells(size: int, rows: int, columns: int, stagger: float) -> tuple[NDArray[np.int64], Image]:
    """Return the cell index of each pixel and its distance to the cell's edge in pixels."""
    y, x = np.mgrid[0:size, 0:size].astype(np.float64)
    row = np.floor(y / size * rows)
    shifted = x / size * columns + stagger * (row % 2)
    column = np.floor(shifted) % columns
    inside_x = (shifted % 1.0) * size / columns
    inside_y = (y / size * rows % 1.0) * size / rows
    edge = np.minimum(
        np.minimum(inside_x, size / columns - inside_x), np.minimum(inside_y, size / rows - inside_y)
    )
    return (row * columns + column).astype(np.int64), edge


def _masonry(
    rng: np.random.Generator,
    size: int,
    rows: int,
    columns: int,
    *,
    color: tuple[float, float, float],
    joint: tuple[float, float, float],
    stagger: float,
    spread: float,
    joint_width: float,
) -> Image:
    """Return stones of varied tone with joints between them."""
    index, edge = _cells(size, rows, columns, stagger)
    tone = rng.normal(1.0, spread, rows * columns)[index]
    hue = rng.normal(0.0, spread / 14, (rows * columns, 3))[index]
    stones = _tinted(rng, size, color, 0.10) * tone[..., None] + hue
    joints = _tinted(rng, size, joint, 0.12)
    blend = np.clip((edge - joint_width) / 1.5, 0.0, 1.0)[..., None]
    return _clipped(blend * stones + (1.0 - blend) * joints)


def paving(rng: np.random.Generator, size: int = 512) -> Image:
    """Square or staggered slabs."""
    rows = int(rng.integers(4, 9))
    base = np.array([0.56, 0.53, 0.49]) * rng.uniform(0.75, 1.15) + rng.normal(0.0, 0.02, 3)
    return _masonry(
        rng, size, rows - rows % 2, rows - rows % 2,
        color=(base[0], base[1], base[2]), joint=(0.33, 0.32, 0.30),
        stagger=float(rng.choice([0.0, 0.5])), spread=0.09, joint_width=1.5,
    )  # fmt: skip


def brick(rng: np.random.Generator, size: int = 512) -> Image:
    """A running bond of bricks."""
    base = np.array([0.50, 0.30, 0.23]) * rng.uniform(0.8, 1.2) + rng.normal(0.0, 0.015, 3)
    return _masonry(
        rng, size, 16, 8,
        color=(base[0], base[1], base[2]), joint=(0.62, 0.60, 0.56),
        stagger=0.5, spread=0.14, joint_width=1.2,
    )  # fmt: skip


def asphalt(rng: np.random.Generator, size: int = 512) -> Image:
    """Dark, coarse-grained, with worn patches."""
    ground = _tinted(rng, size, (0.26, 0.26, 0.27), 0.12)
    stones = np.clip(noise(rng, size, 0.2, 60.0) - 1.1, 0.0, 1.0)[..., None]
    return _clipped(ground + 0.25 * stones)


def grass(rng: np.random.Generator, size: int = 512) -> Image:
    """Short grass in tufts, with dry and bare patches, daisies and fallen leaves."""
    blades, tufts, patches = noise(rng, size, 0.5, 30.0), noise(rng, size, 0.9, 12.0), noise(rng, size, 1.8)
    green, dry, earth = (np.array(c) for c in ([0.22, 0.31, 0.12], [0.46, 0.43, 0.24], [0.30, 0.23, 0.16]))
    mix = np.clip(0.35 + 0.28 * patches, 0.0, 1.0)[..., None]
    shade = 1.0 + 0.22 * blades + 0.24 * np.clip(tufts, -1.5, 1.8)
    image = ((1.0 - mix) * green + mix * dry) * shade[..., None]
    worn = np.clip(3.0 * (noise(rng, size, 1.2, 3.0) - 1.5), 0.0, 1.0)[..., None]
    image = (1.0 - worn) * image + worn * earth * (1.0 + 0.15 * blades)[..., None]
    _strew(rng, image, size * size // 1000, AUTUMN, (2.5, 6.5), 0.55)
    _strew(rng, image, size * size // 1500, DAISIES, (1.6, 2.6), 1.0)
    return _clipped(image)


AUTUMN = ((0.55, 0.42, 0.18), (0.42, 0.24, 0.10), (0.62, 0.54, 0.30), (0.30, 0.22, 0.12))
DAISIES = ((0.88, 0.87, 0.80), (0.90, 0.82, 0.30), (0.85, 0.80, 0.86))
BLOSSOMS = (
    (0.78, 0.16, 0.20),
    (0.88, 0.70, 0.15),
    (0.75, 0.72, 0.80),
    (0.52, 0.24, 0.58),
    (0.86, 0.45, 0.58),
)


def _strew(
    rng: np.random.Generator,
    image: Image,
    count: int,
    colors: tuple[tuple[float, float, float], ...],
    half: tuple[float, float],
    roundness: float,
) -> None:
    """Lay ``count`` ellipses of the colours on a tileable image: leaves, blossoms, stones.

    Args:
        half: range of their half lengths [px].
        roundness: width over length.
    """
    size = len(image)
    y, x = np.mgrid[-7:8, -7:8].astype(np.float64)
    for _ in range(count):
        turn, long = rng.uniform(0.0, np.pi), rng.uniform(*half)
        along, across = x * np.cos(turn) + y * np.sin(turn), y * np.cos(turn) - x * np.sin(turn)
        rows, columns = np.nonzero((along / long) ** 2 + (across / (roundness * long)) ** 2 < 1.0)
        row, column = rng.integers(0, size, 2)
        color = np.asarray(colors[rng.integers(len(colors))]) * rng.uniform(0.75, 1.25)
        image[(row + rows) % size, (column + columns) % size] = color


def _tones(color: Image, factors: Iterable[float]) -> tuple[tuple[float, float, float], ...]:
    """Return lighter and darker kinds of an sRGB colour (3,)."""
    return tuple((float(f * color[0]), float(f * color[1]), float(f * color[2])) for f in factors)


def gravel(rng: np.random.Generator, size: int = 512) -> Image:
    """Trodden gravel: pale, with stones of many sizes and damp patches."""
    pale = np.array([0.60, 0.55, 0.46]) * rng.uniform(0.85, 1.1)
    image = pale * (1.0 + 0.10 * noise(rng, size, 1.8) + 0.10 * noise(rng, size, 0.3, 60.0))[..., None]
    _strew(rng, image, size * size // 500, _tones(pale, rng.uniform(0.55, 1.35, 4)), (1.5, 5.0), 0.8)
    return _clipped(image)


def flowers(rng: np.random.Generator, size: int = 512) -> Image:
    """A flower bed: blossoms of two or three colours over dark leaves."""
    image = 0.75 * leaves(rng, size)
    kinds = rng.choice(len(BLOSSOMS), int(rng.integers(2, 4)), replace=False)
    _strew(rng, image, size * size // 350, tuple(BLOSSOMS[kind] for kind in kinds), (3.0, 7.0), 0.9)
    return _clipped(image)


def concrete(rng: np.random.Generator, size: int = 512) -> Image:
    """Cast panels with stains."""
    index, edge = _cells(size, 2, 2, 0.0)
    tone = rng.normal(1.0, 0.05, 4)[index]
    grey = rng.uniform(0.45, 0.66)
    panel = _tinted(rng, size, (grey, grey, grey * 0.97), 0.07) * tone[..., None]
    return _clipped(panel * (0.62 + 0.38 * np.clip(edge / 2.5, 0.0, 1.0))[..., None])


def plaster(rng: np.random.Generator, size: int = 512) -> Image:
    """Painted, slightly uneven."""
    hue = rng.uniform(0.0, 1.0)
    color = rng.uniform(0.6, 0.8) * (1.0 + 0.09 * np.cos(2.0 * np.pi * (hue + np.array([0.0, 0.33, 0.67]))))
    color *= np.array([1.05, 1.0, 0.92])  # paints are warm more often than not
    return _tinted(rng, size, (color[0], color[1], color[2]), 0.08)


BOARDS = 3
"""Boards end to end in a plank of the texture."""


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
    return _clipped(base * (tone * (0.4 + 0.6 * edge))[..., None])


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
    return _clipped(image)


def leaves(rng: np.random.Generator, size: int = 512) -> Image:
    """Foliage: clumps of light and dark green, with leaves that catch the light and gaps between them."""
    clumps, fine = noise(rng, size, 1.0, 8.0), noise(rng, size, 0.3, 40.0)
    green = np.array([0.20, 0.30, 0.10]) * rng.uniform(0.8, 1.3) * [rng.uniform(0.8, 1.6), 1.0, 1.0]
    image = green * (1.0 + 0.35 * clumps + 0.25 * fine)[..., None]
    tones = tuple(
        (float(t * green[0]), float(t * green[1]), float(t * green[2])) for t in (0.25, 0.4, 1.5, 1.9)
    )
    _strew(rng, image, size * size // 250, tones, (3.0, 7.0), 0.6)
    return _clipped(image)


def _dye(rng: np.random.Generator) -> Image:
    """Return an sRGB colour (3,), neither grey nor glaring."""
    hue = rng.uniform(0.0, 2.0 * np.pi) + np.array([0.0, 2.1, 4.2])
    return np.asarray(rng.uniform(0.3, 0.65) * (1.0 + 0.45 * np.cos(hue)))


def cloth(rng: np.random.Generator, size: int = 512) -> Image:
    """Woven stripes or checks."""
    y, x = np.mgrid[0:size, 0:size] / size
    first, second = _dye(rng), _dye(rng)
    bands = int(rng.integers(3, 9))
    mix = (np.floor(x * bands * 2) % 2) * 0.7
    if rng.random() < 0.5:
        mix = 0.5 * mix + 0.5 * (np.floor(y * bands * 2) % 2)
    weave = 1.0 + 0.06 * np.sign(np.sin(x * size * np.pi / 2) * np.sin(y * size * np.pi / 2))
    color = mix[..., None] * first + (1.0 - mix[..., None]) * second
    return _clipped(color * (weave * (1.0 + 0.05 * noise(rng, size, 1.2)))[..., None])


def wallpaper(rng: np.random.Generator, size: int = 512) -> Image:
    """A printed pattern of dots and stripes on a pale ground."""
    y, x = np.mgrid[0:size, 0:size] / size
    pale, print_color = 0.55 + 0.45 * _dye(rng), _dye(rng)
    count = 2 * int(rng.integers(2, 5))  # staggered columns meet at the border only if their number is even
    cell_x, cell_y = x * count % 1.0 - 0.5, (y * count + 0.5 * (np.floor(x * count) % 2)) % 1.0 - 0.5
    dots = np.hypot(cell_x, cell_y) < rng.uniform(0.12, 0.3)
    stripes = np.abs(cell_x) < 0.03
    image = np.where((dots | stripes)[..., None], print_color, pale)
    return _clipped(image * (1.0 + 0.03 * noise(rng, size, 1.0))[..., None])


TEXTURES: dict[str, Callable[..., Image]] = {
    "asphalt": asphalt,
    "brick": brick,
    "cloth": cloth,
    "concrete": concrete,
    "facade": facade,
    "flowers": flowers,
    "grass": grass,
    "gravel": gravel,
    "leaves": leaves,
    "paving": paving,
    "plaster": plaster,
    "wallpaper": wallpaper,
    "wood": wood,
}
