"""Small facts about triangle meshes that several labels need."""

import numpy as np

from whacamole.labels.arrays import Float64s, Integers


def face_normals(vertices: Float64s, faces: Integers) -> Float64s:
    """``(F, 3)`` outward normals, as long as twice the area of their triangle [m²]."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normals: Float64s = np.cross(b - a, c - a)
    return normals


def vertex_areas(vertices: Float64s, faces: Integers) -> Float64s:
    """``(V,)`` surface around each vertex, a third of its triangles [m²]; sums to the area of the mesh."""
    third = np.linalg.norm(face_normals(vertices, faces), axis=1) / 6
    areas = np.bincount(faces.ravel(), weights=np.repeat(third, 3), minlength=len(vertices))
    return np.asarray(areas, dtype=np.float64)
