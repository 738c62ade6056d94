"""glTF scenes where Blender cannot run: geometry, colours and textures by trimesh; lights are not read."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from PIL import Image

from render_jobs.imported import ImportedScene
from render_jobs.scene import Colour, Material, Mesh
from render_jobs.scene_names import is_floor, mesh_name

UP = np.array([[1.0, 0, 0, 0], [0, 0, -1.0, 0], [0, 1.0, 0, 0], [0, 0, 0, 1.0]])
"""From glTF's y up to z up."""


def read(file: Path, scratch: Path) -> ImportedScene:
    """Read a ``.glb`` or ``.gltf`` file; images are written to ``scratch``."""
    scene = trimesh.load_scene(file)
    meshes: list[Mesh] = []
    floor: set[str] = set()
    materials: dict[int, Material] = {}
    for node in sorted(scene.graph.nodes_geometry):
        matrix, key = scene.graph[node]
        surface: Any = scene.geometry[key]
        if not isinstance(surface, trimesh.Trimesh) or not len(surface.faces):
            continue
        painted = getattr(surface.visual, "material", None)
        if id(painted) not in materials:
            materials[id(painted)] = _material(painted, scratch, len(materials))
        faces = _outward(surface.faces, matrix)
        mesh = Mesh(
            mesh_name(len(meshes)),
            trimesh.transform_points(surface.vertices, UP @ matrix).astype(np.float32),
            faces,
            materials[id(painted)],
            uv=_uv(surface, faces),
        )
        meshes.append(mesh)
        if is_floor(node) or is_floor(key):
            floor.add(mesh.name)
    notes = ("lights are not read without Blender",)
    return ImportedScene(tuple(meshes), frozenset(floor), (), None, notes)


def _outward(faces: Any, matrix: Any) -> Any:
    """Faces whose winding a mirroring transform has not turned over."""
    return faces[:, ::-1] if np.linalg.det(matrix[:3, :3]) < 0 else faces


def _uv(surface: Any, faces: Any) -> Any:
    uv = getattr(surface.visual, "uv", None)
    return None if uv is None else np.asarray(uv, np.float32)[faces]


def _material(painted: Any, scratch: Path, index: int) -> Material:
    if painted is None:
        return Material()
    if not hasattr(painted, "baseColorFactor"):
        painted = painted.to_pbr()
    factor = painted.baseColorFactor
    color: Colour = (1.0, 1.0, 1.0)
    if factor is not None:
        value = np.asarray(factor, float)[:3] / (255.0 if np.asarray(factor).dtype == np.uint8 else 1.0)
        color = (float(value[0]), float(value[1]), float(value[2]))
    return Material(
        name=f"material-{index}",
        base_color=color,
        base_color_texture=_image(painted.baseColorTexture, scratch, f"color-{index}"),
        alpha_mode="clip" if painted.alphaMode in ("MASK", "BLEND") else "opaque",
        normal_texture=_image(painted.normalTexture, scratch, f"normal-{index}"),
        roughness=float(painted.roughnessFactor if painted.roughnessFactor is not None else 0.8),
        double_sided=bool(painted.doubleSided),
    )


def _image(image: Image.Image | None, scratch: Path, name: str) -> Path | None:
    if image is None:
        return None
    scratch.mkdir(parents=True, exist_ok=True)
    path = scratch / f"{name}.png"
    image.convert("RGBA").save(path)
    return path
