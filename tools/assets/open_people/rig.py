"""The MakeHuman rig of 163 bones: hierarchy, where the bones are for a given shape, skinning weights."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.spatial.transform import Rotation

from open_people.base_mesh import BaseMesh


@dataclass(frozen=True, eq=False)
class Rig:
    """Bones in an order where parents come first.

    Attributes:
        names: of the B bones.
        parents: ``(B,)``, −1 for the root.
        heads, tails: ``(B, N)`` sparse; applied to the vertices they give the bone ends.
        weights: ``(N, B)`` sparse skinning weights, rows sum to 1.
    """

    names: tuple[str, ...]
    parents: NDArray[np.int64]
    heads: sparse.csr_matrix
    tails: sparse.csr_matrix
    weights: sparse.csr_matrix

    @cached_property
    def index(self) -> dict[str, int]:
        """Bone number by name."""
        return {name: k for k, name in enumerate(self.names)}

    def parent_name(self, name: str) -> str:
        """Name of the bone that ``name`` hangs on; "" for the root."""
        parent = self.parents[self.index[name]]
        return self.names[parent] if parent >= 0 else ""

    def forward(
        self, heads: NDArray[np.float64], rotations: dict[str, NDArray[np.float64]]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Poses the bones.

        Args:
            heads: ``(B, 3)`` at rest.
            rotations: global rotation ``(3, 3)`` by bone name; a bone without one turns with its parent.

        Returns:
            Global rotations ``(B, 3, 3)`` and heads ``(B, 3)``.
        """
        turn = np.zeros((len(self.names), 3, 3))
        place = np.zeros((len(self.names), 3))
        for k, (name, parent) in enumerate(zip(self.names, self.parents, strict=True)):
            if parent < 0:
                turn[k], place[k] = rotations.get(name, np.eye(3)), heads[k]
            else:
                turn[k] = rotations.get(name, turn[parent])
                place[k] = place[parent] + turn[parent] @ (heads[k] - heads[parent])
        return turn, place


def skin(
    vertices: NDArray[np.float64],
    weights: sparse.csr_matrix,
    turn: NDArray[np.float64],
    heads: NDArray[np.float64],
    posed_heads: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Linear blend skinning: ``vertices (N, 3)`` at rest -> posed, each bone turned about its head."""
    shift = posed_heads - np.einsum("bij,bj->bi", turn, heads)
    blended = (weights @ np.concatenate([turn, shift[:, :, None]], axis=2).reshape(len(turn), 12)).reshape(
        -1, 3, 4
    )
    return np.einsum("nij,nj->ni", blended[:, :, :3], vertices) + blended[:, :, 3]


def skin_rigidly(
    rig: Rig,
    vertices: NDArray[np.float64],
    weights: sparse.csr_matrix,
    turn: NDArray[np.float64],
    heads: NDArray[np.float64],
    posed_heads: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Dual quaternion skinning: ``vertices (N, 3)`` at rest -> posed, each bone turned about its head.

    Bones are blended as rigid motions and so are vertices moved: a bent hip, knee or elbow keeps its girth
    where blending matrices would pinch it (Kavan et al. 2008, "Geometric Skinning with Approximate Dual
    Quaternion Blending").

    Args:
        rig: the bones; which hangs on which decides the sign of their quaternions.
        vertices: ``(N, 3)``.
        weights: ``(N, B)``, rows sum to 1.
        turn: ``(B, 3, 3)`` global rotations.
        heads, posed_heads: ``(B, 3)``.
    """
    real = _signed_alike(rig, Rotation.from_matrix(turn).as_quat())
    shift = posed_heads - np.einsum("bij,bj->bi", turn, heads)
    xyz, w = real[:, :3], real[:, 3:]
    dual = 0.5 * np.concatenate(
        [w * shift + np.cross(shift, xyz), -np.sum(xyz * shift, axis=1, keepdims=True)], axis=1
    )
    blended = weights @ np.concatenate([real, dual], axis=1)
    blended /= np.linalg.norm(blended[:, :4], axis=1, keepdims=True)
    xyz, w, dual_xyz, dual_w = blended[:, :3], blended[:, 3:4], blended[:, 4:7], blended[:, 7:]
    moved = Rotation.from_quat(blended[:, :4]).apply(vertices)
    return moved + 2 * (w * dual_xyz - dual_w * xyz + np.cross(xyz, dual_xyz))


def _signed_alike(rig: Rig, quaternions: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of q and −q, which are the same rotation, the one nearer to the parent's: blends go the short way."""
    out = quaternions.copy()
    for k, parent in enumerate(rig.parents):
        if parent >= 0 and out[k] @ out[parent] < 0:
            out[k] = -out[k]
    return out


def read_rig(mpfb2: Path, mesh: BaseMesh) -> Rig:
    """Reads the default rig and its weights from the ``mpfb2`` folder."""
    folder = mpfb2 / "rigs" / "standard"
    bones: dict[str, dict[str, Any]] = json.loads((folder / "rig.default.json").read_text(encoding="utf-8"))
    weights = json.loads((folder / "weights.default.json").read_text(encoding="utf-8"))["weights"]
    names = _parents_first(bones)
    number = {name: k for k, name in enumerate(names)}
    return Rig(
        names=names,
        parents=np.array([number.get(bones[name]["parent"] or "", -1) for name in names]),
        heads=_bone_ends([bones[name]["head"] for name in names], mesh),
        tails=_bone_ends([bones[name]["tail"] for name in names], mesh),
        weights=_weight_matrix([weights[name] for name in names], mesh.num_vertices),
    )


def _parents_first(bones: dict[str, dict[str, Any]]) -> tuple[str, ...]:
    children: dict[str, list[str]] = {}
    for name, bone in bones.items():
        children.setdefault(bone["parent"] or "", []).append(name)
    out: list[str] = []
    stack = children[""][::-1]
    while stack:
        name = stack.pop()
        out.append(name)
        stack.extend(children.get(name, [])[::-1])
    return tuple(out)


def _bone_ends(specs: list[dict[str, Any]], mesh: BaseMesh) -> sparse.csr_matrix:
    """Each end is the mean of some vertices: of a joint cube, one vertex, or a listed few."""
    matrix = sparse.lil_matrix((len(specs), mesh.num_vertices))
    for row, spec in enumerate(specs):
        if spec["strategy"] == "CUBE":
            vertices = mesh.vertex_groups[spec["cube_name"]]
        elif spec["strategy"] == "VERTEX":
            vertices = np.array([spec["vertex_index"]])
        else:
            vertices = np.array(spec["vertex_indices"])
        for vertex in vertices:
            matrix[row, vertex] += 1 / len(vertices)
    return matrix.tocsr()


def _weight_matrix(columns: list[list[list[float]]], num_vertices: int) -> sparse.csr_matrix:
    entries = [(int(vertex), k, weight) for k, column in enumerate(columns) for vertex, weight in column]
    rows, cols, values = (np.array(x) for x in zip(*entries, strict=True))
    matrix = sparse.csr_matrix((values, (rows, cols)), shape=(num_vertices, len(columns)))
    total = np.asarray(matrix.sum(axis=1)).ravel()
    return sparse.diags(1 / total) @ matrix
