"""The finished body as arrays of the SMPL-X schema."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from open_people.base_mesh import BODY_VERTICES, INNER_GROUPS, BaseMesh
from open_people.shape_space import ShapeSpace
from open_people.skeleton import JOINTS, PARENTS
from whacamole.wardrobe.hands import relaxed_hands

PARTS: Final = ("skin", "left_eye", "right_eye", "upper_teeth", "lower_teeth", "tongue")
"""Values of ``vertex_part``: skin, then :data:`INNER_GROUPS`."""

NO_PARENT: Final = 2**32 - 1

SMALLEST_CORRECTIVE: Final = 5e-5
"""Lesser entries (metres a unit of R − I) are dropped."""


@dataclass(frozen=True, eq=False)
class BodyData:
    """Everything the body file needs, over all vertices of the base mesh.

    Attributes:
        space: shape space.
        expressions: ``(10, N, 3)``.
        correctives: ``(N, 3, 54, 9)``.
        weights: ``(N, 55)``.
        regressor: ``(55, V)`` over ``mesh.model_vertices``.
        order: ``(V,)`` base-mesh index of every vertex of the model.
        landmarks: ``(51,)`` base-mesh vertices.
        outline: ``(79, 17)`` base-mesh vertices.
        statistics: how betas go with gender, age and origin.
    """

    mesh: BaseMesh
    space: ShapeSpace
    expressions: NDArray[np.float64]
    correctives: NDArray[np.float32]
    weights: sparse.csr_matrix
    regressor: NDArray[np.float64]
    order: NDArray[np.int64]
    landmarks: NDArray[np.int64]
    outline: NDArray[np.int64]
    statistics: dict[str, list[list[float]]]


@dataclass(frozen=True, eq=False)
class Surface:
    """Faces of the model, in model vertices.

    Attributes:
        quads, uv_quads: ``(Q, 4)``.
        triangles, uv_triangles: ``(2Q, 3)``, each quad cut along its shorter diagonal.
        uv: ``(M, 2)``, only those used.
    """

    quads: NDArray[np.int64]
    uv_quads: NDArray[np.int64]
    triangles: NDArray[np.int64]
    uv_triangles: NDArray[np.int64]
    uv: NDArray[np.float64]


def model_surface(mesh: BaseMesh, order: NDArray[np.int64], vertices: NDArray[np.float64]) -> Surface:
    """The faces of skin, eyes, teeth and tongue; ``vertices (V, 3)`` decide the diagonals."""
    number = np.full(mesh.num_vertices, -1)
    number[order] = np.arange(len(order))
    chosen = mesh.faces_of("body", *INNER_GROUPS)
    quads = number[mesh.quads[chosen]]
    used, uv_quads = np.unique(mesh.uv_quads[chosen], return_inverse=True)
    uv_quads = uv_quads.reshape(-1, 4)
    p = vertices[quads]
    first = np.linalg.norm(p[:, 0] - p[:, 2], axis=1) <= np.linalg.norm(p[:, 1] - p[:, 3], axis=1)
    corners = np.where(first[:, None], [0, 1, 2, 0, 2, 3], [0, 1, 3, 1, 2, 3])
    cut = [np.take_along_axis(q, corners, axis=1).reshape(-1, 3) for q in (quads, uv_quads)]
    return Surface(quads, uv_quads, cut[0], cut[1], mesh.uv[used])


def schema_arrays(data: BodyData) -> dict[str, NDArray[np.generic]]:
    """The keys of an SMPL-X model file, and a few of our own (quads, parts, where each vertex came from)."""
    order = data.order
    template = data.space.mean[order]
    surface = model_surface(data.mesh, order, template)
    place = np.argsort(data.mesh.model_vertices)
    columns = place[np.searchsorted(data.mesh.model_vertices, order, sorter=place)]
    directions = np.concatenate([data.space.directions[:, order], data.expressions[:, order]])
    posedirs = data.correctives[order]
    posedirs = np.where(np.abs(posedirs) < SMALLEST_CORRECTIVE, 0, posedirs).reshape(len(order), 3, -1)
    return {
        "v_template": template.astype(np.float32),
        "f": surface.triangles.astype(np.uint32),
        "shapedirs": directions.transpose(1, 2, 0).astype(np.float32),
        "posedirs": posedirs.astype(np.float32),
        "J_regressor": data.regressor[:, columns].astype(np.float32),
        "weights": data.weights[order].toarray().astype(np.float32),
        "kintree_table": np.array([[NO_PARENT, *PARENTS[1:]], list(range(len(JOINTS)))], np.int64),
        "vt": surface.uv.astype(np.float32),
        "ft": surface.uv_triangles.astype(np.uint32),
        "quads": surface.quads.astype(np.uint32),
        "quads_t": surface.uv_quads.astype(np.uint32),
        "joint_names": np.array(JOINTS),
        **_landmark_arrays(data, surface.triangles),
        **_hand_arrays(),
        "vertex_part": _vertex_parts(data.mesh, order),
        "mh_index": order.astype(np.int32),
    }


def _landmark_arrays(data: BodyData, triangles: NDArray[np.int64]) -> dict[str, NDArray[np.generic]]:
    """Landmarks as a triangle and barycentric coordinates each; ours are vertices, so one coordinate is 1."""
    number = np.full(data.mesh.num_vertices, -1)
    number[data.order] = np.arange(len(data.order))
    flat = triangles.ravel()
    first_corner = np.full(len(data.order), -1)
    first_corner[flat[::-1]] = np.arange(len(flat))[::-1]
    out: dict[str, NDArray[np.generic]] = {}
    for key, vertices in (("lmk", data.landmarks), ("dynamic_lmk", data.outline)):
        corner = first_corner[number[vertices]]
        out[f"{key}_faces_idx"] = (corner // 3).astype(np.int64)
        out[f"{key}_bary_coords"] = np.eye(3, dtype=np.float32)[corner % 3]
    return out


def _hand_arrays() -> dict[str, NDArray[np.generic]]:
    """Hands in the form the ``smplx`` package wants: the relaxed pose as mean, every angle a component of
    its own."""
    left, right = relaxed_hands()
    return {
        "hands_meanl": left.reshape(-1).astype(np.float32),
        "hands_meanr": right.reshape(-1).astype(np.float32),
        "hands_componentsl": np.eye(45, dtype=np.float32),
        "hands_componentsr": np.eye(45, dtype=np.float32),
    }


def _vertex_parts(mesh: BaseMesh, order: NDArray[np.int64]) -> NDArray[np.uint8]:
    """``(V,)`` index into :data:`PARTS`."""
    part = np.zeros(mesh.num_vertices, np.uint8)
    for k, group in enumerate(INNER_GROUPS, start=1):
        part[mesh.vertex_groups[group]] = k
    assert not part[:BODY_VERTICES].any()
    return part[order]


def topology_digest(quads: NDArray[np.generic]) -> str:
    """SHA-256 of the faces ``(Q, 4)``: by it the wardrobe knows the body it was cut for."""
    return hashlib.sha256(np.ascontiguousarray(quads, np.int32).tobytes()).hexdigest()
