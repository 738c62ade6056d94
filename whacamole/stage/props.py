"""Things that stand about: they give the camera parallax and the eye a sense of size."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from render_jobs import Material
from whacamole.stage.floor import CLEARANCE, Floor
from whacamole.stage.shapes import Solid
from whacamole.stage.stage import SetBuilder
from whacamole.stage.textures import TEXTURES

__all__ = ["furnish", "plant_trees", "prop_materials"]

Size = tuple[float, float, float]

BOXES: dict[str, tuple[tuple[float, float], ...]] = {
    "crate": ((0.5, 1.1), (0.5, 1.1), (0.4, 1.2)),
    "planter": ((0.8, 2.0), (0.6, 0.9), (0.4, 0.7)),
    "bench": ((1.4, 2.2), (0.4, 0.5), (0.42, 0.48)),
    "wall": ((1.5, 3.0), (0.2, 0.3), (0.9, 1.8)),
    "cabinet": ((0.8, 1.6), (0.35, 0.5), (0.8, 2.1)),
    "table": ((1.0, 2.0), (0.7, 1.0), (0.72, 0.78)),
    "sofa": ((1.6, 2.3), (0.8, 1.0), (0.4, 0.75)),
    "vent": ((0.8, 2.0), (0.8, 1.6), (0.7, 1.6)),
    "stall": ((1.8, 2.8), (0.9, 1.2), (0.85, 1.0)),
}
"""Width, depth and height of the boxes among them, as ranges [m]."""

CYLINDERS: dict[str, tuple[tuple[float, float], ...]] = {
    "column": ((0.15, 0.3), (2.4, 4.0)),
    "bollard": ((0.08, 0.13), (0.7, 1.0)),
    "barrel": ((0.28, 0.36), (0.8, 0.95)),
    "stool": ((0.18, 0.24), (0.42, 0.75)),
}
"""Radius and height of the cylinders, as ranges [m]."""


def prop_materials(
    build: SetBuilder, surfaces: Sequence[tuple[str, float]], rng: np.random.Generator
) -> list[Material]:
    """Paint one material for each (texture, metres after which it repeats)."""
    return [
        build.material(f"prop-{index}", TEXTURES[kind], rng, metres=metres)
        for index, (kind, metres) in enumerate(surfaces)
    ]


def furnish(
    build: SetBuilder,
    floor: Floor,
    kinds: Sequence[str],
    count: int,
    materials: Sequence[Material],
    rng: np.random.Generator,
    *,
    beyond: float = 9.0,
    clearance: float = CLEARANCE,
) -> None:
    """Stand ``count`` props of the given kinds around the paths; fewer where the floor is full.

    Args:
        beyond: how far outside the rectangle of the paths [m]; farther off they give little parallax.
    """
    for index in range(count):
        kind = str(rng.choice(kinds))
        size = tuple(float(rng.uniform(*span)) for span in (BOXES.get(kind) or CYLINDERS[kind]))
        material = materials[int(rng.integers(len(materials)))]
        footprint = float(np.hypot(size[0], size[1]) / 2.0) if kind in BOXES else size[0]
        place = floor.spot(rng, footprint, beyond, clearance)
        yaw = float(rng.uniform(0.0, np.pi))
        if place is None:
            continue
        if kind in BOXES:
            build.add_box(f"{kind}-{index}", (*place, 0.0), (size[0], size[1], size[2]), material, yaw)
        else:
            build.add_cylinder(f"{kind}-{index}", (*place, 0.0), size[0], size[1], material)


def plant_trees(
    build: SetBuilder,
    floor: Floor,
    rings: Sequence[tuple[int, float, float]],
    rng: np.random.Generator,
) -> None:
    """Plant trees: a trunk that blocks the way, a crown above the heads that does not.

    Args:
        rings: how many, from how near the paths, to how far outside their rectangle [m].
    """
    bark = build.material("bark", TEXTURES["wood"], rng, metres=0.9)
    leaves = build.material("leaves", TEXTURES["leaves"], rng, metres=1.4, roughness=0.9)
    spans = [(nearest, beyond) for count, nearest, beyond in rings for _ in range(count)]
    for index, (nearest, beyond) in enumerate(spans):
        radius, trunk = float(rng.uniform(0.12, 0.28)), float(rng.uniform(2.2, 3.4))
        place = floor.spot(rng, radius + 0.6, beyond, nearest)
        if place is None:
            continue
        build.add_cylinder(f"trunk-{index}", (*place, 0.0), radius, trunk + 0.6, bark)
        crown = _crown((*place, trunk), float(rng.uniform(1.1, 2.0)), rng)
        build.add(f"crown-{index}", crown, leaves, smooth=True)


def _crown(base: Size, radius: float, rng: np.random.Generator) -> Solid:
    """Return a crown: a few leafy balls grown into each other, lumpy at the scale of branches."""
    import trimesh  # late: it takes longer to load than all else here

    ball = trimesh.creation.icosphere(subdivisions=3)
    vertices, faces, uv = [], [], []
    for index in range(int(rng.integers(3, 6))):
        lumps = 1.0 + 0.11 * _waves(ball.vertices, 5.0, rng) + 0.05 * _waves(ball.vertices, 12.0, rng)
        size = radius * rng.uniform(0.55, 0.85)
        offset = rng.uniform(-0.55, 0.55, 3) * radius * [1.0, 1.0, 0.5]
        center = np.asarray(base) + np.array([0.0, 0.0, radius]) + offset
        faces.append(ball.faces + index * len(ball.vertices))
        vertices.append(center + ball.vertices * lumps[:, None] * size)
        flat = np.stack([np.arctan2(ball.vertices[:, 1], ball.vertices[:, 0]), ball.vertices[:, 2]], axis=1)
        uv.append((flat * size)[ball.faces])
    return Solid(
        np.concatenate(vertices).astype(np.float32),
        np.concatenate(faces).astype(np.int32),
        np.concatenate(uv).astype(np.float32),
    )


def _waves(
    directions: NDArray[np.float64], frequency: float, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Return a smooth random function of unit vectors (N, 3), about −1 … 1."""
    total = np.zeros(len(directions))
    for _ in range(6):
        total += np.sin(directions @ rng.normal(0.0, frequency, 3) + rng.uniform(0.0, 2.0 * np.pi))
    return total / 3.0
