"""Clothes, hair, brows and lashes as MakeHuman binds them: every vertex hangs on three vertices of the
base mesh."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from open_people.rig import Rig, skin
from open_people.tpose import TPose


@dataclass(frozen=True, eq=False)
class Proxy:
    """One item.

    vertex k = Σ weights[k, i] · base[refs[k, i]] + offsets[k], in the modelled pose.

    Attributes:
        refs, weights: ``(n, 3)``.
        offsets: ``(n, 3)`` metres.
        faces, uv_faces: ``(F, 4)``, −1 in the fourth column of a triangle.
        uv: ``(m, 2)``, v up.
        hidden: base-mesh vertices that the item covers.
        textures: path by kind: ``diffuse``, ``normal``, ``ao``.
    """

    refs: NDArray[np.int64]
    weights: NDArray[np.float64]
    offsets: NDArray[np.float64]
    faces: NDArray[np.int64]
    uv_faces: NDArray[np.int64]
    uv: NDArray[np.float64]
    hidden: NDArray[np.int64]
    textures: dict[str, Path]

    def with_faces(self, chosen: NDArray[np.bool_]) -> Proxy:
        """Only the chosen faces, with the vertices and texture coordinates they use."""
        used, faces = _renumber(self.faces[chosen])
        used_uv, uv_faces = _renumber(self.uv_faces[chosen])
        return Proxy(
            self.refs[used], self.weights[used], self.offsets[used], faces, uv_faces, self.uv[used_uv],
            self.hidden, self.textures,
        )  # fmt: skip


def _renumber(faces: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    used = np.unique(faces[faces >= 0])
    number = np.full(used.max() + 2, -1)
    number[used] = np.arange(len(used))
    return used, number[faces]


def read_proxy(folder: Path, name: str) -> Proxy:
    """Reads ``folder/name/name.json`` (three.js geometry 3, with MakeHuman's binding beside it)."""
    path = folder / name / f"{name}.json"
    data: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    faces, uv_faces = _read_faces(data["faces"])
    material = data["materials"][0]
    keys = {"diffuse": "mapDiffuse", "normal": "mapNormal", "ao": "mapAO"}
    textures = {
        kind: path.parent / material[key] for kind, key in keys.items() if isinstance(material.get(key), str)
    }
    hidden = np.atleast_1d(np.array(data["metadata"].get("deleteVerts", []), bool))
    return Proxy(
        refs=np.array(data["ref_vIdxs"], np.int64).reshape(-1, 3),
        weights=np.array(data["weights"], float).reshape(-1, 3),
        offsets=np.array(data["offsets"], float).reshape(-1, 3) / 10.0,  # decimetres
        faces=faces,
        uv_faces=uv_faces,
        uv=np.array(data["uvs"][0], float).reshape(-1, 2),
        hidden=np.flatnonzero(hidden),
        textures={kind: file for kind, file in textures.items() if file.is_file()},
    )


def _read_faces(numbers: list[int]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Decodes the face list: a bit field a face (1 quad, 2 material, 8 texture coordinates …), then its
    numbers."""
    faces, uv_faces = [], []
    at = 0
    while at < len(numbers):
        kind = numbers[at]
        size = 4 if kind & 1 else 3
        at += 1
        faces.append([*numbers[at : at + size], -1][:4])
        at += size + bool(kind & 2) + bool(kind & 4)
        if kind & 8:
            uv_faces.append([*numbers[at : at + size], -1][:4])
            at += size
        at += bool(kind & 16) + size * bool(kind & 32) + bool(kind & 64) + size * bool(kind & 128)
    return np.array(faces), np.array(uv_faces)


def face_pieces(faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """``(F,)`` number of the connected piece each face belongs to (faces that share a corner)."""
    corners = [faces[:, k] for k in range(4)]
    links = np.concatenate([np.stack([corners[0], c], 1)[c >= 0] for c in corners[1:]])
    count = int(faces.max()) + 1
    graph = sparse.coo_matrix((np.ones(len(links)), links.T), shape=(count, count))
    _, label = connected_components(graph, directed=False)
    return label[faces[:, 0]]


def rest_positions(proxy: Proxy, vertices: NDArray[np.float64]) -> NDArray[np.float64]:
    """``(n, 3)`` the item on a body in the modelled pose."""
    return np.einsum("nk,nkc->nc", proxy.weights, vertices[proxy.refs]) + proxy.offsets


def binding_weights(proxy: Proxy, count: int) -> sparse.csr_matrix:
    """``(n, count)`` convex weights over base vertices: what carries skinning weights from the body to
    the item."""
    convex = np.clip(proxy.weights, 0, None)
    convex /= convex.sum(axis=1, keepdims=True)
    rows = np.repeat(np.arange(len(convex)), 3)
    return sparse.csr_matrix((convex.ravel(), (rows, proxy.refs.ravel())), shape=(len(convex), count))


def tpose_offsets(proxy: Proxy, rig: Rig, modelled: NDArray[np.float64], tpose: TPose) -> NDArray[np.float64]:
    """Offsets ``(n, 3)`` that bind the item in the T-pose: it is fitted as modelled, then posed with the
    body."""
    fitted = rest_positions(proxy, modelled)
    weights = binding_weights(proxy, len(modelled)) @ rig.weights
    posed = skin(fitted, weights, tpose.turn, tpose.rest_heads, tpose.heads)
    return posed - np.einsum("nk,nkc->nc", proxy.weights, tpose.vertices[proxy.refs])
