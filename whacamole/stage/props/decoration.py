"""Lamps that stand and plants in pots."""

import numpy as np

from whacamole.stage.props.pieces import in_cells, rod
from whacamole.stage.props.prop import Part, Prop, drawn, fitted
from whacamole.stage.shapes import Solid, lathe
from whacamole.stage.textures.interiors import CELLS

__all__ = ["floor_lamp", "plant"]


def floor_lamp(rng: np.random.Generator) -> Prop:
    """A foot, a rod and a lit shade."""
    height, wide, narrow = drawn(rng, (1.45, 1.7), (0.19, 0.25), (0.12, 0.18))
    shade = lathe([(wide, height - 0.28), (narrow, height)], 24)
    parts = [
        Part(lathe([(0.15, 0.0), (0.15, 0.02), (0.02, 0.03)], 20), "dark"),
        Part(rod((0.0, 0.0, 0.02), (0.0, 0.0, height - 0.26), 0.012), "dark"),
        Part(shade, "shade"),
    ]
    return fitted("floor-lamp", parts)


def plant(rng: np.random.Generator) -> Prop:
    """Long leaves that arch out of a pot, with or without a stem."""
    pot, tall, stem = drawn(rng, (0.13, 0.2), (0.55, 1.15), (0.0, 0.5))
    urn = lathe(
        [
            (0.72 * pot, 0.0),
            (pot, 1.7 * pot),
            (pot, 1.9 * pot),
            (0.85 * pot, 1.9 * pot),
            (0.8 * pot, 1.7 * pot),
        ],
        20,
    )
    top = 1.75 * pot
    parts = [Part(in_cells(urn, rng.integers(0, CELLS**2, 1), len(urn.faces)), "things")]
    if stem > 0.2:
        parts.append(Part(rod((0.0, 0.0, top), (0.0, 0.0, top + stem), 0.018), "wood"))
        top += stem
    parts.append(Part(_leaves(rng, top - 0.02, tall, int(rng.integers(18, 34))), "leaves", smooth=True))
    return fitted("plant", parts)


def _leaves(rng: np.random.Generator, base: float, length: float, count: int) -> Solid:
    """Return bent blades (count) that spring from one point: five cross sections each, a point at the end."""
    share = np.linspace(0.0, 1.0, 6)
    azimuth = np.arange(count) * 2.399963 + rng.uniform(0.0, 0.5, count)
    long = length * rng.uniform(0.55, 1.0, count)
    rise = rng.uniform(0.5, 1.35, count)
    droop = rng.uniform(0.5, 1.4, count)
    angle = rise[:, None] - droop[:, None] * share
    step = long[:, None] / 5.0
    out = np.concatenate([np.zeros((count, 1)), (np.cos(angle) * step)[:, :-1].cumsum(axis=1)], axis=1)
    up = base + np.concatenate([np.zeros((count, 1)), (np.sin(angle) * step)[:, :-1].cumsum(axis=1)], axis=1)
    half = 0.5 * rng.uniform(0.05, 0.1, count)[:, None] * np.sin(np.pi * (0.12 + 0.88 * share)) ** 0.8
    c, s = np.cos(azimuth)[:, None], np.sin(azimuth)[:, None]
    up = np.maximum(up, 0.05)
    left = np.stack([out * c - half * s, out * s + half * c, up], axis=-1)
    right = np.stack([out * c + half * s, out * s - half * c, up], axis=-1)
    vertices = np.stack([left, right], axis=2).reshape(-1, 3)
    first = (12 * np.arange(count)[:, None] + 2 * np.arange(5)).ravel()
    faces = np.stack([first, first + 1, first + 3, first + 2], axis=1)
    along = np.tile(share, count) * length
    uv = np.stack([np.stack([along, along], 1), np.tile([0.0, 0.08], (len(along), 1))], axis=-1).reshape(
        -1, 2
    )
    return Solid(vertices.astype(np.float32), faces.astype(np.int32), uv[faces].astype(np.float32))
