"""What a stage is: a place to film in, ready for a renderer and known to the camera planner."""

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from render_jobs import Environment, Lamp, Material, Mesh, Sun
from whacamole.stage.shapes import Solid

__all__ = ["SetBuilder", "Stage"]


@dataclass(frozen=True, eq=False)
class Stage:
    """A place with its light.

    Attributes:
        name: kind of place.
        meshes: everything that is not a person; ``track_id`` 0.
        lights: suns and lamps.
        environment: what surrounds it all.
        exposure: stops added when the picture is developed.
        obstacles: (N, 2, 3) axis-aligned boxes (low corner, high corner) in metres that neither a camera
            nor a person may enter.
    """

    name: str
    meshes: tuple[Mesh, ...]
    lights: tuple[Sun | Lamp, ...]
    environment: Environment
    exposure: float
    obstacles: NDArray[np.float64]


@dataclass
class SetBuilder:
    """Collects solids and their textures while a stage is built.

    Args:
        folder: where texture files are written.
    """

    folder: Path
    meshes: list[Mesh] = field(default_factory=list)
    obstacles: list[NDArray[np.float64]] = field(default_factory=list)

    def material(
        self,
        name: str,
        texture: Callable[..., NDArray[np.float64]],
        rng: np.random.Generator,
        *,
        metres: float,
        roughness: float = 0.85,
    ) -> Material:
        """Paint a texture that repeats every ``metres`` and return the material that shows it."""
        self.folder.mkdir(parents=True, exist_ok=True)
        path = self.folder / f"{name}.png"
        pixels = np.round(texture(rng) * 255.0).astype(np.uint8)
        Image.fromarray(pixels, "RGB").save(path, compress_level=1)
        return Material(name=name, base_color_texture=path, roughness=roughness, uv_scale=1.0 / metres)

    def add(self, name: str, solid: Solid, material: Material, *, blocks: bool = True) -> None:
        """Put a solid on the set; with ``blocks`` its bounding box is an obstacle."""
        self.meshes.append(Mesh(name, solid.vertices, solid.faces, material, uv=solid.uv, smooth=False))
        if blocks:
            low, high = solid.vertices.min(axis=0), solid.vertices.max(axis=0)
            self.obstacles.append(np.stack([low, high]).astype(np.float64))

    def stage(
        self, name: str, lights: tuple[Sun | Lamp, ...], environment: Environment, exposure: float = 0.0
    ) -> Stage:
        """Return the finished stage."""
        boxes = np.stack(self.obstacles) if self.obstacles else np.zeros((0, 2, 3))
        return Stage(name, tuple(self.meshes), lights, environment, exposure, boxes)
