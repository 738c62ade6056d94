"""Clothes over clothes: what lies under another item is left out, and its edge hangs on that item.

Items come from different suits, so a shirt knows nothing of the trousers below it, and a waistband bends at
the hip where the hem over it does not. So what is kept under a hem gives up its own hold on the body: it is
tucked in, and stays in its place below the cloth over it, however that folds.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
import numpy.typing as npt
import scipy.spatial

from whacamole.wardrobe.catalogue import Catalogue, Item, Slot
from whacamole.wardrobe.hooks import Hooks, hang
from whacamole.wardrobe.layer import HELD_STIFFLY, item_layer

FloatArray = npt.NDArray[np.float64]
Float32Array = npt.NDArray[np.float32]
BoolArray = npt.NDArray[np.bool_]
IndexArray = npt.NDArray[np.int64]

OVER: Final[tuple[tuple[Slot, Slot], ...]] = (("top", "bottom"), ("bottom", "shoes"))
"""Which slot is worn over which, from the outermost in."""

BRIM: Final = 0.012
"""Hair that reaches this far above the brim of a hat is left out [m] …"""

NEAR_BRIM: Final = 0.035
"""… the brim being the lowest of the hat within this horizontal distance [m] …"""

CROWN: Final = 0.05
"""… and so is all that reaches this far above the lowest of the hat [m]."""

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


@dataclass(frozen=True, eq=False)
class _Hold:
    """How m vertices of one item hang below the cloth of another (N vertices).

    Attributes:
        vertices: (m,) of the inner item.
        share: (m, 1) 1 for what follows the outer item alone, falling to 0 for what keeps its own motion.
        hooks: the point of the cloth over each.
        hidden: (n,) vertices of the inner item that cannot be seen.
    """

    vertices: IndexArray
    share: Float32Array
    hooks: Hooks
    hidden: BoolArray


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
    if "hat" in places and "hair" in places:
        hat, hair = places["hat"], places["hair"]
        hidden[hair][:] = _under_hat(wardrobe, items[hat].name, items[hair].name)
    return hidden


def _hang(
    hold: _Hold, over: Float32Array, under: Float32Array, posed_over: Float32Array, posed: Float32Array
) -> None:
    """Moves the held vertices of the inner item to their place below the outer one."""
    point, axes = (values[0] for values in hold.hooks.frames(over[None]))
    apart = under[hold.vertices] - point
    place = np.einsum("mij,mj->mi", axes, apart) / (axes[:, :1] ** 2).sum(axis=-1)
    place[:, 0] = np.minimum(place[:, 0], -np.float32(TUCK))
    point, axes = hold.hooks.frames(posed_over)
    own = posed[:, hold.vertices]
    target = point + np.einsum("tmij,mi->tmj", axes, place)
    posed[:, hold.vertices] = own + hold.share * (target - own)


@lru_cache(maxsize=256)
def _hold(wardrobe: Catalogue, outer: str, inner: str) -> _Hold:
    """Decided on the mean shape at rest."""
    over, under = (item_layer(wardrobe, name).template.astype(np.float64) for name in (outer, inner))
    above_hem = under[:, 1] - _hem_height(over, under)
    hidden = above_hem > OVERLAP
    faces = wardrobe.geometry(inner).corners
    kept = np.unique(faces[~hidden[faces].all(axis=1)])
    hooks = hang(wardrobe.geometry(outer).faces, over, under[kept])
    point, axes = (values[0] for values in hooks.frames(over[None].astype(np.float32)))
    place = np.einsum("mij,mj->mi", axes, under[kept] - point) / np.linalg.norm(axes, axis=-1)
    past_edge = np.linalg.norm(place[:, 1:], axis=1)
    share = np.clip(1 - (past_edge - EDGE) / FADE, 0, 1)
    share *= np.clip((AROUND - np.abs(place[:, 0])) / (AROUND - HELD), 0, 1)
    if wardrobe.items[inner].slot in HELD_STIFFLY:
        share *= np.clip(above_hem[kept] / OVERLAP, 0, 1)  # a shoe keeps its form where it is seen
    held = np.flatnonzero(share > 0)
    return _Hold(kept[held], share[held, None].astype(np.float32), hooks.of(held), hidden)


@lru_cache(maxsize=64)
def _under_hat(wardrobe: Catalogue, hat: str, hair: str) -> BoolArray:
    """The hair (n,) above the brim, and what of it reaches above."""
    over, under = (item_layer(wardrobe, name).template.astype(np.float64) for name in (hat, hair))
    brim = np.minimum(_hem_height(over, under, NEAR_BRIM) + BRIM, over[:, 1].min() + CROWN)
    above = under[:, 1] > brim
    faces = wardrobe.geometry(hair).corners
    hidden = above.copy()
    hidden[faces[above[faces].any(axis=1)]] = True
    return hidden


def _hem_height(over: FloatArray, under: FloatArray, around: float = AROUND) -> FloatArray:
    """(n,) height of the lowest outer vertex near each inner one; infinite where none is near."""
    tree = scipy.spatial.cKDTree(over[:, [0, 2]])
    near = tree.query_ball_point(under[:, [0, 2]], around)
    return np.array([over[index, 1].min() if index else np.inf for index in near])
