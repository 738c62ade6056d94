"""Trees: a trunk that blocks the way, a crown above the heads that does not."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from whacamole.stage.floor import Floor
from whacamole.stage.shapes import Solid, Vector
from whacamole.stage.stage import SetBuilder
from whacamole.stage.textures import TEXTURES

__all__ = ["plant_trees"]


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


def _crown(base: Vector, radius: float, rng: np.random.Generator) -> Solid:
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
