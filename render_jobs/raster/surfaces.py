"""Meshes as a graphics card wants them: triangles, a vertex for each pair of position and texture point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from render_jobs.raster.subdivide import subdivide
from render_jobs.scene import Mesh

Floats = NDArray[np.float32]
Ints = NDArray[np.int32]


@dataclass(frozen=True)
class Surface:
    """What of a mesh does not change from frame to frame.

    Attributes:
        mesh: where it comes from.
        operator: ``(V', V)`` takes the mesh's vertices to the subdivided ones; None where there are none.
        corner_vertex: ``(N,)`` the (subdivided) vertex behind each vertex drawn.
        uv: ``(N, 2)`` texture coordinates, v up; zero where the mesh has none.
        triangles: ``(M, 3)`` indices of vertices drawn.
        mesh_triangles: ``(M, 3)`` the same as (subdivided) vertices.
    """

    mesh: Mesh
    operator: sparse.csr_array | None
    corner_vertex: Ints
    uv: Floats
    triangles: Ints
    mesh_triangles: Ints

    def positions(self, frame: int) -> Floats:
        """The vertices drawn, ``(N, 3)``."""
        return np.ascontiguousarray(self._vertices(frame)[self.corner_vertex], dtype=np.float32)

    def normals(self, frame: int) -> Floats:
        """Smooth unit normals of the vertices drawn, ``(N, 3)``: area-weighted over the triangles around."""
        vertices = self._vertices(frame)
        corners = vertices[self.mesh_triangles]
        area = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        count = len(self.mesh_triangles)
        rows, columns = self.mesh_triangles.ravel(), np.repeat(np.arange(count), 3)
        around = sparse.csr_array((np.ones(3 * count), (rows, columns)), shape=(len(vertices), count))
        total = around @ area
        length = np.linalg.norm(total, axis=1, keepdims=True)
        unit = np.divide(total, length, out=np.zeros_like(total), where=length > 0)
        return np.ascontiguousarray(unit[self.corner_vertex], dtype=np.float32)

    def _vertices(self, frame: int) -> Floats:
        coarse = self.mesh.frame(frame)
        return coarse if self.operator is None else self.operator @ coarse


def surface_of(mesh: Mesh) -> Surface:
    """Prepare a mesh. Quads are cut along the diagonal from their first corner."""
    faces, uv, operator, num_vertices = mesh.faces, mesh.uv, None, mesh.num_vertices
    if mesh.subdivision:
        refined = subdivide(faces, uv, num_vertices, mesh.subdivision)
        faces, uv, operator = refined.faces, refined.uv, refined.operator
        num_vertices = operator.shape[0]
    corners = _triangle_corners(faces)
    vertex = faces.ravel()[corners]
    if uv is None:
        used = np.arange(num_vertices, dtype=np.int32)
        return Surface(mesh, operator, used, np.zeros((num_vertices, 2), np.float32), vertex, vertex)
    coordinates = uv.reshape(-1, 2)[corners.ravel()] * np.float32(mesh.material.uv_scale)
    keys = np.column_stack([vertex.ravel(), coordinates.view(np.int32)])
    _, first, index = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    return Surface(
        mesh,
        operator,
        np.ascontiguousarray(vertex.ravel()[first]),
        np.ascontiguousarray(coordinates[first]),
        np.ascontiguousarray(index.reshape(-1, 3), dtype=np.int32),
        vertex,
    )


def _triangle_corners(faces: Ints) -> Ints:
    """Triangles ``(M, 3)`` as indices into the flattened faces."""
    index = np.arange(faces.size, dtype=np.int32).reshape(faces.shape)
    if faces.shape[1] == 3:
        return index
    second = index[faces[:, 3] >= 0][:, [0, 2, 3]]
    return np.concatenate([index[:, :3], second])
