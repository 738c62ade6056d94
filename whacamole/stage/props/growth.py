"""What plants are put together from: single leaves and limbs."""

import numpy as np
from numpy.typing import NDArray

from whacamole.body import unit_vectors
from whacamole.stage.shapes import Solid

__all__ = ["blades", "leafy", "limb", "on_box", "scattered"]

Floats = NDArray[np.float64]

TONES = 16
"""A picture of leaf tones has this many a side; each leaf shows one of them."""


def leafy(
    places: Floats, normals: Floats, size: tuple[float, float], rng: np.random.Generator, droop: float = 0.0
) -> Solid:
    """Return flat leaves, a rhombus each.

    Args:
        places: (N, 3) their middles [m].
        normals: (N, 3) what they face, of any length.
        size: about their length and width [m].
        droop: 0 lies any way round, 1 points down the slope.
    """
    count = len(places)
    facing = unit_vectors(normals)
    wanted = rng.normal(size=(count, 3)) * (1.0 - droop) - [0.0, 0.0, droop]
    along = unit_vectors(np.cross(np.cross(facing, wanted + 1e-6), facing))
    across = np.cross(facing, along)
    half = 0.5 * rng.uniform(0.7, 1.3, (count, 1)) * np.asarray(size)
    ahead, aside = along * half[:, :1], across * half[:, 1:]
    corners = np.stack([places - ahead, places + aside, places + ahead, places - aside], axis=1)
    faces = np.arange(4 * count, dtype=np.int32).reshape(-1, 4)
    return Solid(corners.reshape(-1, 3).astype(np.float32), faces, _one_tone_each(count, rng))


def blades(base: Floats, tips: Floats, width: float, rng: np.random.Generator) -> Solid:
    """Return long flat leaves from ``base`` to ``tips`` (N, 3), widest [m] a third of the way."""
    count = len(base)
    along = tips - base
    across = 0.5 * width * unit_vectors(np.cross(along, rng.normal(size=(count, 3))))
    belly = base + 0.35 * along
    corners = np.stack([base, belly + across, tips, belly - across], axis=1)
    return Solid(
        corners.reshape(-1, 3).astype(np.float32),
        np.arange(4 * count, dtype=np.int32).reshape(-1, 4),
        _one_tone_each(count, rng),
    )


def _one_tone_each(count: int, rng: np.random.Generator) -> NDArray[np.float32]:
    """UV (N, 4, 2) that give each leaf a field of its own in a picture of leaf tones."""
    tone = (rng.integers(TONES, size=(count, 1, 2)) + 0.5) / TONES
    inside = np.array([[-0.3, 0.0], [0.0, 0.3], [0.3, 0.0], [0.0, -0.3]]) / TONES
    return np.asarray(tone + inside, dtype=np.float32)


def scattered(center: Floats, radii: Floats, count: int, rng: np.random.Generator) -> tuple[Floats, Floats]:
    """Draw places near the surfaces of ellipsoids and the ways out of them, both (N · count, 3).

    Args:
        center, radii: (N, 3) [m].
    """
    outward = unit_vectors(rng.normal(size=(len(center), count, 3)))
    depth = 1.0 - 0.75 * rng.uniform(0.0, 1.0, (len(center), count, 1)) ** 2
    places = center[:, None] + radii[:, None] * outward * depth
    facing = outward / radii[:, None] + rng.normal(0.0, 0.35, outward.shape) / radii.mean()
    return places.reshape(-1, 3), facing.reshape(-1, 3)


def on_box(size: Floats, per_square_metre: float, rng: np.random.Generator) -> tuple[Floats, Floats]:
    """Draw places on the sides and the top of a box about the middle of its underside, and the ways out."""
    width, depth, height = size
    areas = np.array([depth * height, depth * height, width * height, width * height, width * depth])
    count = int(per_square_metre * areas.sum())
    side = rng.choice(5, count, p=areas / areas.sum())
    outward = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1.0]])[side]
    anywhere = rng.uniform(-0.5, 0.5, (count, 3))
    places = np.where(outward != 0.0, 0.5 * outward, anywhere) * size + [0.0, 0.0, 0.5 * height]
    return places, outward + rng.normal(0.0, 0.4, outward.shape)


def limb(path: Floats, radii: Floats, sides: int = 8) -> Solid:
    """Return a round closed tube along ``path`` (K, 3) of ``radii`` (K,) [m]; UV in metres."""
    path, radii = np.asarray(path, float), np.asarray(radii, float)
    along = unit_vectors(np.gradient(path, axis=0))
    helper = np.eye(3)[int(np.argmin(np.abs(path[-1] - path[0])))]
    first = unit_vectors(np.cross(along, helper))
    second = np.cross(along, first)
    angle = np.arange(sides) * (2.0 * np.pi / sides)
    ring = np.cos(angle)[:, None] * first[:, None] + np.sin(angle)[:, None] * second[:, None]
    vertices = np.concatenate([(path[:, None] + radii[:, None, None] * ring).reshape(-1, 3), path[[0, -1]]])
    low = (np.arange(len(path) - 1)[:, None] * sides + np.arange(sides)).ravel()
    turn = np.tile(np.arange(sides), len(path) - 1)
    right = low - turn + (turn + 1) % sides
    here = np.arange(sides)
    there, last, middle = (here + 1) % sides, (len(path) - 1) * sides, len(path) * sides
    faces = np.concatenate(
        [
            np.stack([low, right, right + sides], axis=1),
            np.stack([low, right + sides, low + sides], axis=1),
            np.stack([there, here, np.full(sides, middle)], axis=1),
            np.stack([last + here, last + there, np.full(sides, middle + 1)], axis=1),
        ]
    )
    up = np.concatenate([[0.0], np.linalg.norm(np.diff(path, axis=0), axis=1).cumsum()])
    girth = 2.0 * np.pi * float(radii.max()) / sides
    bottom, top = np.repeat(up[:-1], sides), np.repeat(up[1:], sides)
    left, far = turn * girth, (turn + 1) * girth
    lids = np.zeros((2 * sides, 3, 2))
    uv = np.concatenate(
        [
            np.stack([np.stack([left, bottom], 1), np.stack([far, bottom], 1), np.stack([far, top], 1)], 1),
            np.stack([np.stack([left, bottom], 1), np.stack([far, top], 1), np.stack([left, top], 1)], 1),
            lids,
        ]
    )
    return Solid(vertices.astype(np.float32), faces.astype(np.int32), uv.astype(np.float32))
