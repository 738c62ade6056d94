"""Clothes over clothes: what lies under another item is left out, and its edge tucked in.

Items come from different suits, so a shirt knows nothing of the trousers below it. All is decided once,
on the mean shape at rest; as both items then move with the same skin, it holds in every pose.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
import numpy.typing as npt
import scipy.spatial

from whacamole.body import vertex_normals
from whacamole.wardrobe.catalogue import Catalogue, Item, Slot
from whacamole.wardrobe.layer import item_layer

Float32Array = npt.NDArray[np.float32]
BoolArray = npt.NDArray[np.bool_]

OVER: Final[tuple[tuple[Slot, Slot], ...]] = (("bottom", "shoes"), ("top", "bottom"))
"""Which slot is worn over which."""

AROUND: Final = 0.07
"""The hem above a point is the lowest of the outer item within this horizontal distance [m]."""

OVERLAP: Final = 0.03
"""The inner item is kept this far up under the hem [m]."""

TUCK: Final = 0.005
"""What remains under the outer item lies at least this far inside it [m] …"""

FADE: Final = 0.03
"""… and returns to its place over this length below the hem [m]."""


@dataclass(frozen=True, eq=False)
class Tucked:
    """An item under others.

    Attributes:
        hidden: (n,) vertices that cannot be seen.
        push: (n, 3) displacement at rest [m].
    """

    hidden: BoolArray
    push: Float32Array


def tuck_all(wardrobe: Catalogue, items: tuple[Item, ...]) -> tuple[Tucked, ...]:
    """How each item gives way to those worn over it."""
    out = []
    for inner in items:
        count = item_layer(wardrobe, inner.name).num_vertices
        hidden, push = np.zeros(count, dtype=bool), np.zeros((count, 3), dtype=np.float32)
        for outer in items:
            if (outer.slot, inner.slot) in OVER:
                under = _tuck(wardrobe, outer.name, inner.name)
                hidden, push = hidden | under.hidden, push + under.push
        out.append(Tucked(hidden, push))
    return tuple(out)


@lru_cache(maxsize=256)
def _tuck(wardrobe: Catalogue, outer: str, inner: str) -> Tucked:
    over, under = (item_layer(wardrobe, name).template.astype(np.float64) for name in (outer, inner))
    above_hem = under[:, 1] - _hem_height(over, under)
    normals = _normals(wardrobe, outer)
    distance, nearest = scipy.spatial.cKDTree(over).query(under)
    depth = np.einsum("nk,nk->n", over[nearest] - under, normals[nearest])
    # A hem has no cloth further down, so below it the nearest point says less and less.
    share = np.clip(1 + above_hem / FADE, 0, 1) * (distance < AROUND)
    push = -normals[nearest] * (share * np.clip(TUCK - depth, 0, None))[:, None]
    return Tucked(above_hem > OVERLAP, push.astype(np.float32))


def _hem_height(over: npt.NDArray[np.float64], under: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """(n,) height of the lowest outer vertex near each inner one; infinite where none is near."""
    tree = scipy.spatial.cKDTree(over[:, [0, 2]])
    near = tree.query_ball_point(under[:, [0, 2]], AROUND)
    return np.array([over[index, 1].min() if index else np.inf for index in near])


def _normals(wardrobe: Catalogue, name: str) -> npt.NDArray[np.float64]:
    faces = wardrobe.geometry(name).faces
    quads = faces[faces[:, 3] >= 0]
    triangles = np.concatenate([faces[:, :3], quads[:, [0, 2, 3]]])
    template = item_layer(wardrobe, name).template
    return vertex_normals(template, triangles).astype(np.float64)
