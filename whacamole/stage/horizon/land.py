"""Distant land: a line of trees, hills."""

from functools import partial

import numpy as np
from numpy.typing import NDArray

from whacamole.stage.shapes import Solid
from whacamole.stage.stage import SetBuilder
from whacamole.stage.textures.distance import distant_land, distant_woods

__all__ = ["hills", "tree_line"]

Floats = NDArray[np.float64]

TREE_ROWS = ((88.0, (6.0, 10.0)), (112.0, (9.0, 15.0)))
"""Beyond the people's paths [m], and how high the trees are [m]."""

ROW_LENGTH = 42.0
"""About as much of a row of trees one picture shows [m]."""

OUTLINE = 0.45
"""Step of the outline of a row of trees [m]."""

CROWN = (6.0, 14.0)
"""Width of a distant crown [m]."""

CREST = (9.0, 30.0)
"""Height of hills [m]."""

RISE = 120.0
"""From the foot of the hills to their crest [m]."""

AROUND = 96
"""Corners of a ring."""


def tree_line(build: SetBuilder, center: Floats, reach: float, rng: np.random.Generator) -> None:
    """Plant two rows of trees around a place, the rear ones higher and hazier.

    Solid up to a ragged outline: a picture cut out by its alpha would cost a path tracer much more.
    """
    for index, (beyond, (lowest, highest)) in enumerate(TREE_ROWS):
        columns = int(2.0 * np.pi * (reach + beyond) / OUTLINE)
        angle = np.arange(columns + 1) * (2.0 * np.pi / columns)
        radius = reach + beyond + 4.0 * _waves(angle, 5, rng)
        height = _outline(columns, lowest, highest, rng)
        level = [center + radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)]
        foot = np.column_stack([*level, np.zeros(columns + 1)])
        pictures = max(1, round(2.0 * np.pi * (reach + beyond) / ROW_LENGTH))
        along = np.linspace(0.0, pictures, columns + 1)
        rows = np.stack([foot, foot + np.array([0.0, 0.0, 1.0]) * height[:, None]])
        up = 0.02 + 0.96 * np.stack([0.0 * height, height / highest])
        uv = np.stack([np.broadcast_to(along, up.shape), up], axis=-1)
        paint = partial(distant_woods, haze=0.12 + 0.15 * index)
        woods = build.material(f"far-trees-{index}", paint, rng, metres=1.0, roughness=1.0)
        build.add(f"far-trees-{index}", _sheet(rows, uv), woods, smooth=True)


def _outline(columns: int, lowest: float, highest: float, rng: np.random.Generator) -> Floats:
    """Return the height (columns + 1,) of rounded crowns above undergrowth, ragged by their twigs [m]."""
    count = int(2.0 * columns * OUTLINE / CROWN[0])
    middle, half = rng.uniform(0.0, columns, count), rng.uniform(*CROWN, count) / 2.0 / OUTLINE
    top = rng.uniform(lowest, highest, count)
    away = np.abs((np.arange(columns)[:, None] - middle + columns / 2.0) % columns - columns / 2.0) / half
    crowns = top * np.clip(1.0 - away**2, 0.0, 1.0) ** 0.35
    boughs = np.convolve(rng.normal(0.0, 0.9, columns + 3), np.full(4, 0.25), "valid")
    height = np.maximum(crowns.max(axis=1), 0.5 * lowest) + boughs + rng.normal(0.0, 0.3, columns)
    height = np.clip(height, 0.35 * lowest, highest)
    return np.append(height, height[0])


def hills(build: SetBuilder, center: Floats, foot: float, rng: np.random.Generator) -> None:
    """Raise wooded hills all around, from ``foot`` metres off."""
    angle = np.arange(AROUND + 1) * (2.0 * np.pi / AROUND)
    crest = np.clip(np.mean(CREST) + (CREST[1] - CREST[0]) / 3.0 * _waves(angle, 7, rng), *CREST)
    share = np.linspace(0.0, 1.0, 9)[:, None]
    radius = foot + RISE * share + 10.0 * _waves(angle, 11, rng) * share
    lumps = 0.12 * np.stack([_waves(angle, 20, rng) for _ in share]) * np.sin(np.pi * share)
    z = crest * (share**2 * (3.0 - 2.0 * share) + lumps) - 0.3
    x, y = center[0] + radius * np.cos(angle), center[1] + radius * np.sin(angle)
    land = build.material("hills", partial(distant_land, haze=0.35), rng, metres=110.0, roughness=1.0)
    rows = np.stack([x, y, z], axis=-1)
    build.add("hills", _sheet(rows, rows[..., :2]), land, smooth=True)


def _waves(angle: Floats, most: int, rng: np.random.Generator) -> Floats:
    """Return a smooth random function around the circle, about −1 … 1."""
    order = np.arange(1, most + 1)
    phase, size = rng.uniform(0.0, 2.0 * np.pi, most), rng.uniform(0.4, 1.0, most) / order**0.5
    return np.asarray(
        (size * np.cos(order * angle[:, None] + phase)).sum(axis=1) / np.linalg.norm(size) / 1.2
    )


def _sheet(rows: Floats, uv: Floats) -> Solid:
    """Return quads between rows (R, N, 3), nearest first; seen from inside the ring they face the eye."""
    count = rows.shape[1]
    first = (np.arange(len(rows) - 1)[:, None] * count + np.arange(count - 1)).ravel()
    faces = np.stack([first + 1, first, first + count, first + count + 1], axis=1)
    return Solid(
        rows.reshape(-1, 3).astype(np.float32),
        faces.astype(np.int32),
        uv.reshape(-1, 2)[faces].astype(np.float32),
    )
