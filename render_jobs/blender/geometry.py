"""Meshes in Blender. Moving ones are played from a PC2 file by a Mesh Cache modifier.

A cache gives Cycles the positions before and after the frame, hence right motion vectors and motion blur;
vertices set by a frame handler would give neither.
"""

from __future__ import annotations

import struct
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix
from numpy.typing import NDArray

from render_jobs.scene import Mesh

FIRST_CACHED_FRAME = -1.0


def add_mesh(mesh: Mesh, material: Any, scratch: Path) -> None:
    """Add the mesh to the scene, once for each placement.

    Args:
        mesh: the geometry; its track id becomes the object index.
        material: the Blender material.
        scratch: a folder for the vertex cache, kept until the render has ended.
    """
    scene: Any = bpy.context.scene
    data = _mesh_data(mesh)
    data.materials.append(material)
    cache = scratch / f"{mesh.name}.pc2" if mesh.animated else None
    if cache is not None:
        write_pc2(cache, mesh.vertices)
    placements = np.eye(4)[None] if mesh.placements is None else mesh.placements
    for index, placement in enumerate(placements):
        entity = bpy.data.objects.new(f"{mesh.name}.{index}", data)
        scene.collection.objects.link(entity)
        entity.matrix_world = Matrix(placement.tolist())
        entity.pass_index = mesh.track_id
        if cache is not None:
            _play_cache(entity, cache)
        if mesh.subdivision:
            modifier: Any = entity.modifiers.new("subdivision", "SUBSURF")
            modifier.levels = modifier.render_levels = mesh.subdivision
            modifier.use_limit_surface = False  # the raster engine can draw these points, too


def write_pc2(path: Path, vertices: NDArray[np.float32]) -> None:
    """Write a point cache of ``(N, V, 3)`` positions, one sample a frame, the first at frame −1."""
    header = struct.pack(
        "<12siiffi", b"POINTCACHE2\0", 1, vertices.shape[1], FIRST_CACHED_FRAME, 1.0, len(vertices)
    )
    with path.open("wb") as file:
        file.write(header)
        file.write(np.ascontiguousarray(vertices, "<f4").data)


def _play_cache(entity: Any, cache: Path) -> None:
    modifier = entity.modifiers.new("cache", "MESH_CACHE")
    modifier.cache_format = "PC2"
    modifier.filepath = str(cache)
    modifier.frame_start = FIRST_CACHED_FRAME
    modifier.interpolation = "LINEAR"


def _mesh_data(mesh: Mesh) -> Any:
    """The Blender mesh at frame 0; ``foreach_set`` throughout, as Python loops take seconds on a body."""
    corners, starts, kept = _loops(mesh.faces)
    data = bpy.data.meshes.new(mesh.name)
    data.vertices.add(mesh.num_vertices)
    data.vertices.foreach_set("co", mesh.frame(0).ravel())
    data.loops.add(len(corners))
    data.loops.foreach_set("vertex_index", corners)
    data.polygons.add(len(starts))
    data.polygons.foreach_set("loop_start", starts)
    data.polygons.foreach_set("use_smooth", np.full(len(starts), mesh.smooth))
    if mesh.uv is not None:
        layer = data.uv_layers.new(name="UVMap")
        layer.uv.foreach_set("vector", mesh.uv[kept].ravel())
    data.update(calc_edges=True)
    data.validate(clean_customdata=False)
    return data


def _loops(faces: NDArray[np.int32]) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.bool_]]:
    """Face corners in a row, the first corner of each face, and which entries of ``faces`` are corners."""
    kept = faces >= 0
    sizes = kept.sum(axis=1)
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]]).astype(np.int32)
    return np.ascontiguousarray(faces[kept]), starts, kept
