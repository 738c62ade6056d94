"""Skin below clothes: what must be kept near a hem, a cuff or a collar is drawn in, so that it stays below.

Only what cloth covers moves: bare skin is that of the labels.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import Final

import numpy as np
import numpy.typing as npt

from whacamole.body import BodyModel, vertex_normals
from whacamole.wardrobe.catalogue import Catalogue, Item
from whacamole.wardrobe.hooks import Hooks, hang
from whacamole.wardrobe.layer import item_layer

Float32Array = npt.NDArray[np.float32]
BoolArray = npt.NDArray[np.bool_]
IndexArray = npt.NDArray[np.int64]

DRAWN_IN: Final = np.float32(0.006)
"""Skin under the edge of a garment is lowered by this [m] …"""

BELOW: Final = np.float32(0.004)
"""… and where a bent knee or hip still brings it nearer to the cloth, down to this depth [m] …"""

FARTHEST: Final = np.float32(0.03)
"""… but by no more than this [m]."""

ASIDE: Final = 0.015
"""Skin that lies farther past the edge of the cloth than this at rest is not pushed [m]."""


def beside(body: BodyModel, chosen: BoolArray) -> BoolArray:
    """The vertices (V,) of all faces that have one of the chosen (V,)."""
    assert body.quads is not None
    out = np.zeros(body.num_vertices, dtype=bool)
    out[body.quads[chosen[body.quads].any(axis=1)]] = True
    return out


def drawn_in(body: BodyModel, posed: Float32Array, under: BoolArray) -> Float32Array:
    """The body (T, V, 3) with some vertices (V,) lowered."""
    faces = body.faces[under[body.faces].any(axis=1)]
    used = np.unique(faces)
    number = np.zeros(body.num_vertices, dtype=np.int32)
    number[used] = np.arange(len(used))
    normals = vertex_normals(posed[:, used], number[faces])
    lowered = posed.copy()
    lowered[:, under] -= DRAWN_IN * normals[:, number[under]]
    return lowered


def keep_below(
    wardrobe: Catalogue,
    body: BodyModel,
    items: Sequence[Item],
    clothes: Sequence[Float32Array],
    skin: Float32Array,
    kept: BoolArray,
) -> None:
    """Pushes kept skin below the clothes that cover it.

    Args:
        wardrobe: theirs.
        body: whose skin it is.
        items: k items.
        clothes: their vertices (T, n, 3) [m].
        skin: (T, V, 3) [m], changed in place.
        kept: (V,) skin vertices that are not left out.
    """
    for item, cloth in zip(items, clothes, strict=True):
        vertices, hooks = _covered(wardrobe, body, item.name)
        chosen = np.flatnonzero(kept[vertices])
        if not len(chosen):
            continue
        vertices = vertices[chosen]
        point, outwards = hooks.of(chosen).points(cloth)
        length = np.linalg.norm(outwards, axis=-1)
        depth = ((point - skin[:, vertices]) * outwards).sum(axis=-1)
        skin[:, vertices] -= np.clip(BELOW * length - depth, 0, FARTHEST)[..., None] * outwards


@lru_cache(maxsize=64)
def _covered(wardrobe: Catalogue, body: BodyModel, name: str) -> tuple[IndexArray, Hooks]:
    """The vertices under an item that are not well inside it, and the points of the cloth over them."""
    geometry = wardrobe.geometry(name)
    cloth = item_layer(wardrobe, name).template.astype(np.float64)
    vertices = np.flatnonzero(geometry.under & beside(body, ~geometry.hidden))
    skin = body.v_template[vertices].astype(np.float64)
    hooks = hang(geometry.faces, cloth, skin)
    point, outwards = (values[0] for values in hooks.points(cloth[None].astype(np.float32)))
    apart = skin - point
    height = (apart * outwards).sum(axis=1)
    straight = np.flatnonzero(np.linalg.norm(apart - height[:, None] * outwards, axis=1) < ASIDE)
    return vertices[straight], hooks.of(straight)
