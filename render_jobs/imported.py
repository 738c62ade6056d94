"""A scene from a user's own file, read once and kept as plain values.

Blender (or trimesh, for glTF where Blender cannot run) reads the file in a child process, which writes a
folder::

    FOLDER/
      scene.json               materials, lights, surroundings, names; what could not be taken over
      meshes/0000/*.npy        vertices, faces, uv, placements
      textures/…               copies

Nothing in the file runs: scripts of ``.blend`` files are not executed, and only images beside the file are
read.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from pydantic import ValidationError

from render_jobs.errors import RenderJobError
from render_jobs.processes import child_environment
from render_jobs.scene import Environment, Light, Mesh, SceneValue
from render_jobs.storage import MeshRecord, read_mesh, with_folder, write_mesh

SCENE_FILE = "scene.json"
SCENE_SUFFIXES = (".blend", ".glb", ".gltf", ".usd", ".usda", ".usdc", ".usdz")
GLTF_SUFFIXES = (".glb", ".gltf")
IMPORT_TIMEOUT_S = 600.0


class SceneFileError(RenderJobError):
    """A scene file cannot be used. The message is one line that names the file and the remedy."""


class SceneRecord(SceneValue):
    """What ``scene.json`` holds."""

    version: int = 1
    meshes: tuple[MeshRecord, ...]
    floor: tuple[str, ...]
    lights: tuple[Light, ...]
    environment: Environment | None
    exposure: float
    notes: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class ImportedScene:
    """A scene in metres, z up.

    Attributes:
        meshes: everything that is drawn.
        floor: names of the meshes that the file marks as floor.
        lights: suns and lamps.
        environment: the surroundings, or None where the file has none to speak of.
        notes: what of the file could not be taken over, a line each.
        exposure: stops that the file asks for.
    """

    meshes: tuple[Mesh, ...]
    floor: frozenset[str]
    lights: tuple[Light, ...]
    environment: Environment | None
    notes: tuple[str, ...] = ()
    exposure: float = 0.0

    @property
    def lit(self) -> bool:
        """Whether the file brings light of its own."""
        glows = any(mesh.material.emission_strength > 0 for mesh in self.meshes)
        return bool(self.lights) or glows or self.environment is not None

    def save(self, folder: Path) -> None:
        """Write the folder; it must be empty."""
        environment = self.environment
        if environment is not None and isinstance(environment.hdri, Path):
            name = Path("textures", environment.hdri.name)
            (folder / "textures").mkdir(parents=True, exist_ok=True)
            if environment.hdri != folder / name:
                shutil.copyfile(environment.hdri, folder / name)
            environment = environment.model_copy(update={"hdri": name})
        record = SceneRecord(
            meshes=tuple(write_mesh(mesh, index, folder) for index, mesh in enumerate(self.meshes)),
            floor=tuple(sorted(self.floor)),
            lights=self.lights,
            environment=environment,
            exposure=self.exposure,
            notes=self.notes,
        )
        text = json.dumps(record.model_dump(mode="json"), indent=1, ensure_ascii=False)
        (folder / SCENE_FILE).write_text(text + "\n", encoding="utf-8")

    @classmethod
    def load(cls, folder: Path) -> ImportedScene:
        """Read a folder that :meth:`save` wrote.

        Raises:
            RenderJobError: it is damaged.
        """
        try:
            record = SceneRecord.model_validate_json((folder / SCENE_FILE).read_bytes())
        except (OSError, ValidationError) as error:
            raise RenderJobError(f"{folder}: no imported scene; delete the folder and start again") from error
        meshes = tuple(read_mesh(folder, mesh) for mesh in record.meshes)
        environment = None if record.environment is None else with_folder(record.environment, folder)
        return cls(meshes, frozenset(record.floor), record.lights, environment, record.notes, record.exposure)


def import_scene(file: Path, folder: Path, timeout: float = IMPORT_TIMEOUT_S) -> ImportedScene:
    """Read a scene file by a child process, or what an earlier call made of it.

    Args:
        file: ends in one of :data:`SCENE_SUFFIXES`.
        folder: where the plain values are kept; it appears whole or not at all.
        timeout: seconds after which the child is ended.

    Raises:
        SceneFileError: the file cannot be used.
    """
    if not (folder / SCENE_FILE).is_file():
        if file.suffix.lower() not in SCENE_SUFFIXES:
            raise SceneFileError(f"{file}: a stage ends in {', '.join(SCENE_SUFFIXES)}")
        if not file.is_file():
            raise SceneFileError(f"{file}: there is no such file")
        _import_apart(file, folder, timeout)
    return ImportedScene.load(folder)


def _import_apart(file: Path, folder: Path, timeout: float) -> None:
    folder.parent.mkdir(parents=True, exist_ok=True)
    fresh = folder.with_name(f".{folder.name}.new-{os.getpid()}")
    shutil.rmtree(fresh, ignore_errors=True)
    fresh.mkdir()
    command = [
        sys.executable,
        "-m",
        "render_jobs.import_scene",
        str(file.resolve()),
        str(fresh),
        str(os.getpid()),
    ]
    try:
        child = subprocess.run(
            command, capture_output=True, text=True, errors="replace", timeout=timeout,
            env=child_environment(), check=False, stdin=subprocess.DEVNULL,
        )  # fmt: skip
        if child.returncode != 0:
            raise SceneFileError(f"{file}: {_reason(child.stdout, child.stderr, child.returncode)}")
        shutil.rmtree(folder, ignore_errors=True)
        fresh.replace(folder)
    except subprocess.TimeoutExpired:
        raise SceneFileError(f"{file}: not read in {timeout:.0f} s; make the scene smaller") from None
    finally:
        shutil.rmtree(fresh, ignore_errors=True)


def _reason(output: str, errors: str, status: int) -> str:
    """What the child said, else how it ended."""
    for line in reversed(output.splitlines()):
        if line.startswith("{"):
            return str(json.loads(line)["error"])
    last = next((line.strip() for line in reversed(errors.splitlines()) if line.strip()), "it said nothing")
    return f"reading it ended with status {status} ({last}); open and save it with Blender again"
