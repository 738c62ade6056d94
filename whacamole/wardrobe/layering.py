"""Clothes over clothes: what lies under another item is left out, and its edge hangs on that item.

Items come from different suits, so a shirt knows nothing of the trousers below it, and a waistband bends at the
hip where the hem over it does not. So what is kept under a hem gives up its own hold on the body: it is
tucked in, and stays in its place below the cloth over it, however that folds.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
import numpy.typing as npt
import scipy.sparse
import scipy.spatial

from whacamole.body import vertex_normals
from whacamole.wardrobe.catalogue import Catalogue, Item, Slot
from whacamole.wardrobe.layer import HELD_STIFFLY, Layer, item_layer

FloatArray = npt.NDArray[np.float64]
Float32Array = npt.NDArray[np.float32]
BoolArray = npt.NDArray[np.bool_]
Int32Array = npt.NDArray[np.int32]
IndexArray = npt.NDArray[np.int64]

OVER: Final[tuple[tuple[Slot, Slot], ...]] = (("top", "bottom"), ("bottom", "shoes"))
"""Which slot is worn over which, from the outermost in."""

AROUND: Final = 0.07
"""The hem above a point is the lowest of the outer item within this horizontal distance [m]."""

OVERLAP: Final = 0.03
"""The inner item is kept this far up under the hem [m]."""

TUCK: Final = 0.005
"""What remains under the outer item lies at least this far inside it [m] …"""

EDGE: Final = 0.01
"""… also where it looks out by no more than this [m] …"""

FADE: Final = 0.04
"""… and from there returns to its own hold on the body over this length [m]."""

HELD: Final = 0.04
"""What is nearer than this to the outer item hangs on it wholly, from ``AROUND`` on not at all [m]."""

SPLITS: Final = 4
"""Points along each side of a face of the outer item where others may hang on it …"""

HOOKS: Final = 6
"""… and how many of them carry a point."""


@dataclass(frozen=True, eq=False)
class _Hold:
    """How m vertices of one item hang below the cloth of another (N vertices).

    Attributes:
        vertices: (m,) of the inner item.
        share: (m, 1) 1 for what follows the outer item alone, falling to 0 for what keeps its own motion.
        hooks: sparse (m, N): the point of the cloth over each.
        triangles: (F, 3) of the outer item, those that give normals at the hooks.
        edge: (m, 2) outer vertices whose difference gives a direction along the cloth.
        hidden: (n,) vertices of the inner item that cannot be seen.
    """

    vertices: IndexArray
    share: Float32Array
    hooks: scipy.sparse.csr_array
    triangles: Int32Array
    edge: Int32Array
    hidden: BoolArray

    def frames(self, cloth: Float32Array) -> tuple[Float32Array, Float32Array]:
        """Points (T, m, 3) of the cloth (T, N, 3) and axes there (T, m, 3, 3): outwards, two along it."""
        outwards = _unit(_carry(self.hooks, vertex_normals(cloth, self.triangles)))
        along = cloth[:, self.edge[:, 1]] - cloth[:, self.edge[:, 0]]
        along = _unit(along - (along * outwards).sum(axis=-1, keepdims=True) * outwards)
        return _carry(self.hooks, cloth), np.stack([outwards, along, np.cross(outwards, along)], axis=-2)


def wear_all(
    wardrobe: Catalogue, items: Sequence[Item], rest: Sequence[Float32Array], posed: Sequence[Float32Array]
) -> tuple[BoolArray, ...]:
    """Hangs each item on those worn over it.

    Args:
        wardrobe: theirs.
        items: k items.
        rest: their vertices (n, 3) at rest, in the person's shape [m].
        posed: their vertices (T, n, 3) [m]; changed in place.

    Returns:
        For each item, which of its vertices (n,) cannot be seen.
    """
    hidden = tuple(np.zeros(len(vertices), dtype=bool) for vertices in rest)
    places = {item.slot: k for k, item in enumerate(items)}
    for outer, inner in ((places.get(a), places.get(b)) for a, b in OVER):
        if outer is None or inner is None:
            continue
        hold = _hold(wardrobe, items[outer].name, items[inner].name)
        hidden[inner][:] |= hold.hidden
        if len(hold.vertices):
            _hang(hold, rest[outer], rest[inner], posed[outer], posed[inner])
    return hidden


def _hang(
    hold: _Hold, over: Float32Array, under: Float32Array, posed_over: Float32Array, posed: Float32Array
) -> None:
    """Moves the held vertices of the inner item to their place below the outer one."""
    point, axes = (values[0] for values in hold.frames(over[None]))
    place = np.einsum("mij,mj->mi", axes, under[hold.vertices] - point)
    place[:, 0] = np.minimum(place[:, 0], -np.float32(TUCK))
    point, axes = hold.frames(posed_over)
    own = posed[:, hold.vertices]
    target = point + np.einsum("tmij,mi->tmj", axes, place)
    posed[:, hold.vertices] = own + hold.share * (target - own)


@lru_cache(maxsize=256)
def _hold(wardrobe: Catalogue, outer: str, inner: str) -> _Hold:
    """Decided on the mean shape at rest."""
    over, under = (item_layer(wardrobe, name).template.astype(np.float64) for name in (outer, inner))
    faces = wardrobe.geometry(outer).faces
    above_hem = under[:, 1] - _hem_height(over, under)
    hooks, edge = _hooks(faces, over, under)
    triangles = _triangles(faces)
    whole = _Hold(np.arange(len(under)), np.ones(1, np.float32), hooks, triangles, edge, above_hem > OVERLAP)
    point, axes = (values[0] for values in whole.frames(over[None].astype(np.float32)))
    place = np.einsum("mij,mj->mi", axes, under - point)
    past_edge = np.linalg.norm(place[:, 1:], axis=1)
    share = np.clip(1 - (past_edge - EDGE) / FADE, 0, 1)
    share *= np.clip((AROUND - np.abs(place[:, 0])) / (AROUND - HELD), 0, 1)
    if wardrobe.items[inner].slot in HELD_STIFFLY:
        share *= np.clip(above_hem / OVERLAP, 0, 1)  # a shoe keeps its form where it is seen
    held = np.flatnonzero(share > 0)
    used = np.zeros(len(over), dtype=bool)
    used[hooks[held].indices] = True
    return _Hold(
        held, share[held, None].astype(np.float32), hooks[held], triangles[used[triangles].any(axis=1)],
        edge[held], whole.hidden,
    )  # fmt: skip


def _hem_height(over: FloatArray, under: FloatArray) -> FloatArray:
    """(n,) height of the lowest outer vertex near each inner one; infinite where none is near."""
    tree = scipy.spatial.cKDTree(over[:, [0, 2]])
    near = tree.query_ball_point(under[:, [0, 2]], AROUND)
    return np.array([over[index, 1].min() if index else np.inf for index in near])


def _triangles(faces: Int32Array) -> Int32Array:
    quads = faces[faces[:, 3] >= 0]
    return np.concatenate([faces[:, :3], quads[:, [0, 2, 3]]])


def _hooks(
    faces: Int32Array, over: FloatArray, under: FloatArray
) -> tuple[scipy.sparse.csr_array, Int32Array]:
    """The cloth over each inner vertex as a mix (n, N) of outer ones, and an edge (n, 2) of the nearest face."""
    corners = np.where(faces < 0, faces[:, 2:3], faces)
    t = (np.arange(SPLITS) + 0.5) / SPLITS
    u, v = (grid.ravel() for grid in np.meshgrid(t, t))
    shares = np.stack([(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v], axis=1)
    at = np.einsum("pk,fkc->fpc", shares, over[corners]).reshape(-1, 3)
    distance, point = scipy.spatial.cKDTree(at).query(under, k=HOOKS)
    weight = 1 / np.maximum(distance, 1e-3) ** 2
    weight /= weight.sum(axis=1, keepdims=True)
    face, place = np.divmod(point, len(shares))
    values = (weight[..., None] * shares[place]).ravel().astype(np.float32)
    rows = np.repeat(np.arange(len(under)), HOOKS * corners.shape[1])
    mix = scipy.sparse.csr_array((values, (rows, corners[face].ravel())), shape=(len(under), len(over)))
    return mix, corners[face[:, 0], :2]


def _carry(mix: scipy.sparse.csr_array, values: Float32Array) -> Float32Array:
    """Values (T, N, 3) at mixes (m, N) of their places: (T, m, 3)."""
    flat = np.ascontiguousarray(values.transpose(1, 0, 2)).reshape(values.shape[1], -1)
    return np.asarray((mix @ flat).reshape(-1, len(values), 3).transpose(1, 0, 2))


def _unit(vectors: Float32Array) -> Float32Array:
    length = np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), np.float32(1e-9))
    return np.asarray(vectors / length)
