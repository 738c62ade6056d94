"""A user's scene file, read by Blender into plain values. Scripts in the file are not run.

What is taken over: all that has a surface when rendered (modifiers applied, instances kept as placements),
the core of each material, lamps, and the surroundings. The scene is read as it stands at its current frame.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from render_jobs.blender.import_images import Images
from render_jobs.blender.import_lights import read_light, read_world
from render_jobs.blender.import_materials import read_material
from render_jobs.errors import RenderJobError
from render_jobs.imported import GLTF_SUFFIXES, ImportedScene
from render_jobs.scene import Lamp, Material, Mesh, Sun
from render_jobs.scene_names import is_floor, mesh_name

SURFACES = ("MESH", "CURVE", "SURFACE", "META", "FONT")
MOST_TRIANGLES = 20_000_000


def read(file: Path, scratch: Path) -> ImportedScene:
    """Read a scene file.

    Args:
        file: a ``.blend``, glTF or USD file.
        scratch: where copies of its images go.

    Raises:
        RenderJobError: the file is damaged, reaches out of its folder, or holds no surface.
    """
    _open(file)
    images = Images(file.parent.resolve(), scratch)
    scene: Any = bpy.context.scene
    unit = float(scene.unit_settings.scale_length) if file.suffix == ".blend" else 1.0
    meshes, floor = _surfaces(images, unit)
    if not meshes:
        raise RenderJobError("holds nothing that is drawn; show and save at least a floor")
    return ImportedScene(
        tuple(meshes),
        frozenset(floor),
        tuple(_lights(unit)),
        read_world(scene.world, images),
        tuple(images.notes),
        float(scene.view_settings.exposure) if file.suffix == ".blend" else 0.0,
    )


def _open(file: Path) -> None:
    """Open the file with an empty scene around it, and without running anything that it carries."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    context: Any = bpy.context
    context.preferences.filepaths.use_scripts_auto_execute = False
    suffix = file.suffix.lower()
    try:
        if suffix == ".blend":
            bpy.ops.wm.open_mainfile(filepath=str(file), load_ui=False, use_scripts=False)
        elif suffix in GLTF_SUFFIXES:
            bpy.ops.import_scene.gltf(filepath=str(file))
        else:
            bpy.ops.wm.usd_import(filepath=str(file), import_usd_preview=True, set_frame_range=False)
    except RuntimeError as error:
        raise RenderJobError(
            f"is damaged or of another kind ({_first_line(error)}); save it again"
        ) from error
    root = file.parent.resolve()
    for library in bpy.data.libraries:
        path = Path(bpy.path.abspath(library.filepath)).resolve()
        if not path.is_relative_to(root):
            raise RenderJobError(
                f"links {path}, outside its folder; append its content or put it beside the file"
            )


def _first_line(error: RuntimeError) -> str:
    lines = [line.removeprefix("Error:").strip() for line in str(error).splitlines() if line.strip()]
    return lines[0].rstrip(".") if lines else "no reason given"


def _surfaces(images: Images, unit: float) -> tuple[list[Mesh], set[str]]:
    """Every drawn surface once for each of its materials, with all its placements; names of the floor."""
    graph: Any = bpy.context.evaluated_depsgraph_get()
    places: dict[tuple[str, str], list[NDArray[np.float64]]] = {}
    sources: dict[tuple[str, str], Any] = {}
    for instance in graph.object_instances:
        entity = instance.object
        if entity.type not in SURFACES or not instance.show_self or _is_hidden(entity.original):
            continue
        owner = instance.parent.original.name if instance.is_instance else ""
        key = (owner, entity.original.name if entity.original else entity.name)
        matrix = np.array(instance.matrix_world, np.float64)
        matrix[:3] *= unit
        places.setdefault(key, []).append(matrix)
        sources.setdefault(key, entity.original or entity)
    meshes: list[Mesh] = []
    floor: set[str] = set()
    materials: dict[str, Material | None] = {}
    total = 0
    for key in sorted(places):
        for part, slot_name in _parts(sources[key].evaluated_get(graph), images, materials):
            total += len(part[1]) * len(places[key])
            if total > MOST_TRIANGLES:
                raise RenderJobError(f"has over {MOST_TRIANGLES} triangles; make the scene smaller")
            material = materials[slot_name]
            if material is None:  # glass
                continue
            mesh = _placed(mesh_name(len(meshes)), part, material, places[key])
            meshes.append(mesh)
            if _marked_floor(sources[key]):
                floor.add(mesh.name)
    return meshes, floor


def _is_hidden(entity: Any) -> bool:
    return bool(entity is not None and entity.hide_render)


def _marked_floor(entity: Any) -> bool:
    return is_floor(entity.name) or any(is_floor(collection.name) for collection in entity.users_collection)


Part = tuple[NDArray[np.float32], NDArray[np.int32], NDArray[np.float32] | None, bool]
"""Vertices, triangles, texture coordinates of the corners, whether it is smooth."""


def _parts(entity: Any, images: Images, materials: dict[str, Material | None]) -> Iterator[tuple[Part, str]]:
    """The triangles of an evaluated object, apart by material; new materials are read on the way."""
    data = entity.to_mesh()
    if data is None or not len(data.polygons):
        return
    data.calc_loop_triangles()
    count = len(data.loop_triangles)
    vertices = np.empty(3 * len(data.vertices), np.float32)
    data.vertices.foreach_get("co", vertices)
    triangles, loops = np.empty(3 * count, np.int32), np.empty(3 * count, np.int32)
    data.loop_triangles.foreach_get("vertices", triangles)
    data.loop_triangles.foreach_get("loops", loops)
    slots, polygon = np.empty(count, np.int32), np.empty(count, np.int32)
    data.loop_triangles.foreach_get("material_index", slots)
    data.loop_triangles.foreach_get("polygon_index", polygon)
    smooth = np.empty(len(data.polygons), np.bool_)
    data.polygons.foreach_get("use_smooth", smooth)
    uv = None
    if data.uv_layers.active is not None:
        layer = np.empty(2 * len(data.loops), np.float32)
        data.uv_layers.active.uv.foreach_get("vector", layer)
        uv = layer.reshape(-1, 2)[loops.reshape(-1, 3)]
    sharp = _sharp_edges(data)
    for slot in np.unique(slots):
        painted = entity.material_slots[slot].material if slot < len(entity.material_slots) else None
        name = painted.name if painted is not None else ""
        if name not in materials:
            materials[name] = read_material(painted, images)
        chosen = slots == slot
        is_smooth = bool(smooth[polygon[chosen]].mean() > 0.5) and not sharp
        corners = None if uv is None else images.mapped(name, uv[chosen])
        yield _compact(vertices.reshape(-1, 3), triangles.reshape(-1, 3)[chosen], corners, is_smooth), name
    entity.to_mesh_clear()


def _sharp_edges(data: Any) -> bool:
    """Whether a fifth of the edges or more are marked sharp: the surface is shaded flat then."""
    attribute = data.attributes.get("sharp_edge")
    if attribute is None or not len(attribute.data):
        return False
    sharp = np.empty(len(attribute.data), np.bool_)
    attribute.data.foreach_get("value", sharp)
    return bool(sharp.mean() > 0.2)


def _compact(
    vertices: NDArray[np.float32], triangles: NDArray[np.int32], uv: NDArray[np.float32] | None, smooth: bool
) -> Part:
    used, index = np.unique(triangles, return_inverse=True)
    return vertices[used], index.reshape(-1, 3).astype(np.int32), uv, smooth


def _placed(name: str, part: Part, material: Material, places: list[NDArray[np.float64]]) -> Mesh:
    """The mesh; one placement is put into its vertices, several are kept."""
    vertices, triangles, uv, smooth = part
    if len(places) > 1:
        return Mesh(name, vertices, triangles, material, uv=uv, placements=np.stack(places), smooth=smooth)
    matrix = places[0]
    moved = vertices.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    if np.linalg.det(matrix[:3, :3]) < 0:
        triangles = triangles[:, ::-1]
        uv = None if uv is None else uv[:, ::-1]
    return Mesh(name, moved.astype(np.float32), triangles, material, uv=uv, smooth=smooth)


def _lights(unit: float) -> Iterator[Sun | Lamp]:
    graph: Any = bpy.context.evaluated_depsgraph_get()
    for instance in graph.object_instances:
        entity = instance.object
        if entity.type == "LIGHT" and instance.show_self and not _is_hidden(entity.original):
            matrix = np.array(instance.matrix_world, np.float64)
            matrix[:3] *= unit
            light = read_light(entity.data, matrix, unit)
            if light is not None:
                yield light
