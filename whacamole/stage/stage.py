"""What a stage is: a place to film in, ready for a renderer and known to the camera planner."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from camera_rigs import Obstacle, World
from render_jobs import Environment, Lamp, Material, Mesh, Sun
from whacamole.stage.shapes import Solid, Vector, box

__all__ = ["SetBuilder", "Stage", "one_of"]


@dataclass(frozen=True, eq=False)
class Stage:
    """A place with its light.

    Attributes:
        name: kind of place.
        meshes: everything that is not a person; ``track_id`` 0.
        lights: suns and lamps.
        environment: what surrounds it all.
        exposure: stops added when the picture is developed.
        world: the obstacles, for the camera planner and for placing people.
    """

    name: str
    meshes: tuple[Mesh, ...]
    lights: tuple[Sun | Lamp, ...]
    environment: Environment
    exposure: float
    world: World


@dataclass
class SetBuilder:
    """Collects solids and their textures while a stage is built.

    Args:
        folder: where texture files are written; None paints none.
    """

    folder: Path | None
    meshes: list[Mesh] = field(default_factory=list)
    obstacles: list[Obstacle] = field(default_factory=list)
    bounds: tuple[Vector, Vector] | None = None

    def material(
        self,
        name: str,
        texture: Callable[..., NDArray[np.float64]],
        rng: np.random.Generator,
        *,
        metres: float,
        roughness: float = 0.85,
    ) -> Material:
        """Paint a texture that repeats every ``metres`` and return the material that shows it.

        One number is drawn from ``rng`` whether or not anything is painted, so that a stage which is only
        planned on is the stage that will be filmed.
        """
        grain = int(rng.integers(2**63))
        if self.folder is None:
            return Material(name=name, roughness=roughness)
        self.folder.mkdir(parents=True, exist_ok=True)
        path = self.folder / f"{name}.png"
        pixels = np.round(texture(np.random.default_rng(grain)) * 255.0).astype(np.uint8)
        Image.fromarray(pixels, "RGB").save(path, compress_level=1)
        return Material(name=name, base_color_texture=path, roughness=roughness, uv_scale=1.0 / metres)

    def add(
        self,
        name: str,
        solid: Solid,
        material: Material,
        obstacle: Obstacle | None = None,
        *,
        smooth: bool = False,
    ) -> None:
        """Put a solid on the set, with the box that a camera and people keep out of."""
        mesh = Mesh(name, solid.vertices, solid.faces, material, uv=solid.uv, smooth=smooth)
        self.meshes.append(mesh)
        if obstacle is not None:
            self.obstacles.append(obstacle)

    def add_box(self, name: str, base: Vector, size: Vector, material: Material, yaw: float = 0.0) -> None:
        """Put a box on the set; ``base`` is the middle of its underside, ``yaw`` turns it about z [rad]."""
        self.add(name, box(base, size, yaw), material, _around(name, base, size, yaw))

    def keep_out(self, name: str, base: Vector, size: Vector, yaw: float) -> None:
        """Keep people and cameras out of a box of ``size`` about the middle of its underside."""
        self.obstacles.append(_around(name, base, size, yaw))

    def plain(
        self, name: str, color: Vector, *, roughness: float = 0.6, metallic: float = 0.0, glow: float = 0.0
    ) -> Material:
        """Return a material of one sRGB colour, lit by ``glow`` times that colour; lamps do the rest."""
        return Material(
            name=name, base_color=color, roughness=roughness, metallic=metallic,
            emission=color, emission_strength=glow, emission_lights=False,
        )  # fmt: skip

    def tinted(self, painted: Material, name: str, color: Vector, roughness: float | None = None) -> Material:
        """Return a painted material in another sRGB colour: one texture serves for many."""
        rough = painted.roughness if roughness is None else roughness
        return painted.model_copy(update={"name": name, "base_color": color, "roughness": rough})

    def stage(
        self, name: str, lights: tuple[Sun | Lamp, ...], environment: Environment, exposure: float = 0.0
    ) -> Stage:
        """Return the finished stage."""
        world = World(obstacles=tuple(self.obstacles), bounds=self.bounds)
        return Stage(name, tuple(self.meshes), lights, environment, exposure, world)


def _around(name: str, base: Vector, size: Vector, yaw: float) -> Obstacle:
    return Obstacle((base[0], base[1], base[2] + size[2] / 2.0), size, yaw, name)


def one_of(rng: np.random.Generator, colors: Sequence[Vector]) -> Vector:
    """Draw one of several colours, each as likely as the others."""
    return colors[int(rng.integers(len(colors)))]
