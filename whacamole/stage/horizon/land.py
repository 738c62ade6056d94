"""Distant land: a line of trees, hills."""

from functools import partial

import numpy as np
from numpy.typing import NDArray

from whacamole.stage.shapes import Solid
from whacamole.stage.stage import SetBuilder
from whacamole.stage.textures.distance import distant_land, tree_row

__all__ = ["hills", "tree_line"]

Floats = NDArray[np.float64]

TREE_ROWS = ((88.0, (6.0, 10.0)), (112.0, (9.0, 15.0)))
"""Beyond the people's paths [m], and how high the trees are [m]."""

ROW_LENGTH = 42.0
"""About as much of a row of trees one picture shows [m]."""

CREST = (9.0, 30.0)
"""Height of hills [m]."""

RISE = 120.0
"""From the foot of the hills to their crest [m]."""

AROUND = 96
"""Corners of a ring."""


def tree_line(build: SetBuilder, center: Floats, reach: float, rng: np.random.Generator) -> None:
    """Plant two rows of trees around a place, the rear ones higher and hazier."""
    angle = np.arange(AROUND + 1) * (2.0 * np.pi / AROUND)
    for index, (beyond, (lowest, highest)) in enumerate(TREE_ROWS):
        radius = reach + beyond + 4.0 * _waves(angle, 5, rng)
        height = np.clip(
            (lowest + highest) / 2.0 + (highest - lowest) / 3.0 * _waves(angle, 9, rng), lowest, highest
        )
        foot = np.column_stack(
            [center + radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], 1), 0.0 * angle]
        )
        pictures = max(1, round(2.0 * np.pi * (reach + beyond) / ROW_LENGTH))
        along = np.linspace(0.0, pictures, AROUND + 1)
        rows = np.stack([foot, foot + np.array([0.0, 0.0, 1.0]) * height[:, None]])
        # Not up to the picture's rims, where it would repeat.
        uv = np.stack([np.stack([along, np.full_like(along, v)], 1) for v in (0.01, 0.98)])
        trees = build.material(
            f"far-trees-{index}", partial(tree_row, haze=0.12 + 0.15 * index), rng,
            metres=1.0, roughness=1.0, cut=True,
        )  # fmt: skip
        build.add(f"far-trees-{index}", _sheet(rows, uv), trees, smooth=True)


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
