"""Stages of the user's own: a file becomes a place whose floor and obstacles are known."""

from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from camera_rigs import World
from render_jobs import Environment, Lamp, Mesh, Sun
from render_jobs.imported import SCENE_SUFFIXES, SceneFileError, import_scene
from whacamole.dataset.files import sha256_of, write_arrays, write_text
from whacamole.stage.light import Hdri, lit_by
from whacamole.stage.stage import Stage
from whacamole.stage.surroundings import daylight
from whacamole.stage.survey import (
    Ground,
    Solids,
    survey_ground,
    survey_solids,
    world_triangles,
)

__all__ = ["SMALLEST_FLOOR", "OwnStage", "check_stage", "load_stage", "stage_files"]

SMALLEST_FLOOR = 1.0
"""A floor on which one can walk on less than this is taken for a mistake [m²]."""

CAMERA_REACH = 15.0
"""Solids up to this far from the people's paths are known to the camera [m]."""


SURVEY, PROBLEM = "survey.npz", ".problem"


@dataclass(frozen=True, eq=False)
class OwnStage:
    """A user's place, its floor at z = 0; x and y are those of the file.

    Attributes:
        name: of the file, without its suffix.
        meshes, lights, environment: what is seen; no environment if the file has none.
        lit: whether the file brings light.
        exposure: stops that suit the file's own light.
        ground, solids: what the survey found.
        notes: what of the file could not be taken over.
    """

    name: str
    meshes: tuple[Mesh, ...]
    lights: tuple[Sun | Lamp, ...]
    environment: Environment | None
    lit: bool
    exposure: float
    ground: Ground
    solids: Solids
    notes: tuple[str, ...]

    def stage(self, rng: np.random.Generator, paths: NDArray[np.float64], hdris: tuple[Hdri, ...]) -> Stage:
        """Return the stage around the people's paths (N, 2), lit by the file, else by a drawn day."""
        low, high = paths.min(axis=0) - CAMERA_REACH, paths.max(axis=0) + CAMERA_REACH
        world = World(obstacles=self.solids.boxes(low, high))
        if self.lit:
            environment = self.environment or Environment(color=(0.0, 0.0, 0.0))
            return Stage(self.name, self.meshes, self.lights, environment, self.exposure, world)
        sun, sky = daylight(rng, (20.0, 65.0))
        stage = Stage(self.name, self.meshes, (sun,), sky, 0.6, world)
        return lit_by(stage, hdris, rng) if hdris else stage


def stage_files(path: Path) -> tuple[Path, ...]:
    """Return the stage files that ``path`` stands for: itself, or those in the folder, by name.

    Raises:
        SceneFileError: there is none.
    """
    if path.is_file():
        return (path,)
    if not path.is_dir():
        raise SceneFileError(f"{path}: there is no such file or folder")
    found = sorted(
        file for file in path.iterdir() if file.suffix.lower() in SCENE_SUFFIXES and file.is_file()
    )
    if not found:
        raise SceneFileError(f"{path}: holds no stage ({', '.join(SCENE_SUFFIXES)})")
    return tuple(found)


def load_stage(file: Path, cache: Path) -> OwnStage:
    """Read a stage file, or what is kept of an earlier reading in the folder ``cache``.

    Raises:
        SceneFileError: it cannot be read, or has no floor.
    """
    return _load(file, _kept(file, cache))


def check_stage(file: Path, cache: Path) -> tuple[str, ...]:
    """Read a stage file if that has not been done; return notes on what could not be taken over.

    Raises:
        SceneFileError: it cannot be read, or has no floor.
    """
    kept = _kept(file, cache)
    known_to_be_good = (kept / SURVEY).is_file() and not kept.with_suffix(PROBLEM).exists()
    return () if known_to_be_good else _load(file, kept).notes


def _kept(file: Path, cache: Path) -> Path:
    try:
        return cache / sha256_of(file)[:32]
    except OSError as error:
        raise SceneFileError(f"{file}: cannot be read ({error.strerror})") from error


@lru_cache(maxsize=2)
def _load(file: Path, folder: Path) -> OwnStage:
    broken = folder.with_suffix(PROBLEM)
    if broken.is_file():
        raise SceneFileError(f"{file}: {broken.read_text(encoding='utf-8')}")
    try:
        return _read(file, folder)
    except SceneFileError as error:
        folder.parent.mkdir(parents=True, exist_ok=True)
        write_text(broken, str(error).removeprefix(f"{file}: "))
        raise


def _read(file: Path, folder: Path) -> OwnStage:
    scene = import_scene(file, folder)
    height = _floor_height([mesh for mesh in scene.meshes if mesh.name in scene.floor])
    meshes = tuple(_lowered(mesh, height) for mesh in scene.meshes)
    floor = tuple(mesh for mesh in meshes if mesh.name in scene.floor) or meshes
    ground, solids = _surveyed(meshes, floor, folder / SURVEY)
    if ground.area < SMALLEST_FLOOR:
        raise SceneFileError(
            f"{file}: no floor to walk on; name an object or its collection `floor`, "
            "or put the floor at z = 0"
        )
    return OwnStage(
        name=file.stem,
        meshes=meshes,
        lights=tuple(_light_lowered(light, height) for light in scene.lights),
        environment=scene.environment,
        lit=scene.lit,
        exposure=scene.exposure,
        ground=ground,
        solids=solids,
        notes=scene.notes,
    )


def _surveyed(meshes: tuple[Mesh, ...], floor: tuple[Mesh, ...], kept: Path) -> tuple[Ground, Solids]:
    """Survey a place, or read what an earlier survey found."""
    if kept.is_file():
        with np.load(kept, allow_pickle=False) as found:
            ground = Ground(found["ground_low"], found["clearance"])
            return ground, Solids(found["solids_low"], found["solid"])
    everything = _triangles(meshes)
    ground = survey_ground(_triangles(floor), everything)
    solids = survey_solids(everything, ground)
    write_arrays(
        kept,
        {
            "ground_low": ground.low,
            "clearance": ground.clearance,
            "solids_low": solids.low,
            "solid": solids.solid,
        },
    )
    return ground, solids


def _triangles(meshes: tuple[Mesh, ...]) -> NDArray[np.float64]:
    parts = [world_triangles(mesh.vertices, mesh.faces, mesh.placements) for mesh in meshes]
    return np.concatenate(parts) if parts else np.zeros((0, 3, 3))


def _floor_height(marked: list[Mesh]) -> float:
    """The height that holds most of the marked floor's level surface; 0 where none is marked."""
    triangles = _triangles(tuple(marked))
    normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    area = np.linalg.norm(normal, axis=1)
    # Only what faces up: the underside of a slab is no floor.
    level = normal[:, 2] > 0.9 * np.maximum(area, 1e-12)
    if not level.any():
        level = np.abs(normal[:, 2]) > 0.9 * np.maximum(area, 1e-12)
    if not level.any():
        return 0.0
    heights, inverse = np.unique(np.round(triangles[level, :, 2].mean(axis=1), 2), return_inverse=True)
    return float(heights[np.argmax(np.bincount(inverse, weights=area[level]))])


def _lowered(mesh: Mesh, height: float) -> Mesh:
    if height == 0.0:
        return mesh
    if mesh.placements is None:
        return replace(mesh, vertices=mesh.vertices - np.array([0.0, 0.0, height], np.float32))
    placements = mesh.placements.copy()
    placements[:, 2, 3] -= height
    return replace(mesh, placements=placements)


def _light_lowered(light: Sun | Lamp, height: float) -> Sun | Lamp:
    if isinstance(light, Sun):
        return light
    (x, y, z), (tx, ty, tz) = light.position, light.target
    return light.model_copy(update={"position": (x, y, z - height), "target": (tx, ty, tz - height)})
