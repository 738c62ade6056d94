"""A coarser surface through some of a body's own vertices.

A saved scene holds every frame's vertices, so their number decides its size. The thinned body keeps a part of
the vertices where they are, posed exactly; only the surface between them is coarser.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from whacamole.body import JOINT_INDEX, BodyModel

__all__ = ["Surface", "full_surface", "thinned_surface"]

Floats = NDArray[np.float64]
Indices = NDArray[np.intp]

CELL, FINE_CELL = 0.032, 0.013
"""Width of the cells that keep one vertex each, of the body and of hands and head [m]."""

_FINE_FROM = JOINT_INDEX["jaw"]
_FINE = {JOINT_INDEX["head"], JOINT_INDEX["left_wrist"], JOINT_INDEX["right_wrist"]}


@dataclass(frozen=True, eq=False)
class Surface:
    """A mesh through some vertices of a body.

    Attributes:
        vertices: (n,) which vertices of the body, ascending.
        faces: (F, 3) into ``vertices``.
    """

    vertices: Indices
    faces: NDArray[np.int32]


def full_surface(model: BodyModel) -> Surface:
    """The surface as it is."""
    return Surface(np.arange(model.num_vertices), model.faces)


def thinned_surface(model: BodyModel) -> Surface:
    """One vertex of every occupied cell of a grid on the body at rest: about a quarter of them.

    Vertices that follow different joints never share a cell, so fingers and limbs stay apart; a cell keeps
    the vertex nearest to the mean of its vertices.
    """
    rest = np.asarray(model.v_template, dtype=np.float64)
    joint = model.weights.argmax(axis=1)
    fine = (joint >= _FINE_FROM) | np.isin(joint, list(_FINE))
    cells = np.floor(rest / np.where(fine, FINE_CELL, CELL)[:, None]).astype(np.int64)
    _, group = np.unique(np.column_stack([joint, cells]), axis=0, return_inverse=True)
    group = group.reshape(-1)
    count = np.bincount(group)
    mean = np.stack([np.bincount(group, weights=rest[:, axis]) for axis in range(3)], axis=1) / count[:, None]
    order = np.lexsort((np.linalg.norm(rest - mean[group], axis=1), group))
    kept = order[np.searchsorted(group[order], np.arange(len(count)))]
    faces = _distinct(kept[group[model.faces]])
    vertices, places = np.unique(faces, return_inverse=True)
    return Surface(vertices.astype(np.intp), places.reshape(-1, 3).astype(np.int32))


def _distinct(faces: Indices) -> Indices:
    """Faces with three different corners, each once."""
    a, b, c = faces.T
    whole = faces[(a != b) & (b != c) & (c != a)]
    _, first = np.unique(np.sort(whole, axis=1), axis=0, return_index=True)
    distinct: Indices = whole[np.sort(first)]
    return distinct
