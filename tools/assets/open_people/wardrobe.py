"""The wardrobe pack: items bound to the body in the T-pose, their textures, the skins, the catalogue."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from open_people import strands, textures
from open_people.base_mesh import BODY_VERTICES, BaseMesh
from open_people.covering import INSIDE_EDGE, Cover, cover
from open_people.fine_rig import FineRig
from open_people.item_list import ITEMS, LOCKS, LOGOS, SKINS, Item
from open_people.proxies import Proxy, face_pieces, read_proxy, rest_positions, tpose_offsets
from open_people.skeleton import INDEX
from open_people.sources import Sources

WAIST: Final = 0.10
"""Height (metres, modelled pose) that parts the pieces of a suit into top and bottom."""

SHOE_LINE: Final = -0.70
"""Pieces whose middle is lower are shoes modelled with a suit; the wardrobe has its own."""

COVERING: Final = ("top", "bottom", "shoes")
"""Slots that cover skin beyond what MakeHuman lists."""

NO_VERTEX: Final = 65535

UV_UNIT: Final = 16384
"""Texture coordinates are stored as whole parts of this: 0.03 pixels, range −2 to 2."""


@dataclass(frozen=True, eq=False)
class Piece:
    """One item, cut from its proxy and bound in the T-pose."""

    item: Item
    proxy: Proxy
    offsets: NDArray[np.float64]
    cover: Cover


@dataclass(eq=False)
class TextureStore:
    """Texture files by content: items that share a picture share the file."""

    files: dict[str, bytes] = field(default_factory=dict)

    def add(self, name: str, pixels: NDArray[np.float64]) -> str:
        """Stores a picture under ``name`` and returns the file's name."""
        suffix, data = textures.encode(pixels)
        same = next((known for known, bytes_ in self.files.items() if bytes_ == data), None)
        if same is not None:
            return same
        self.files[name + suffix] = data
        return name + suffix


def cut_pieces(sources: Sources, mesh: BaseMesh, fine: FineRig) -> list[Piece]:
    """Reads every item of the list, takes the part it stands for and binds it."""
    out = []
    for item in ITEMS:
        whole = read_proxy(sources.proxies / item.folder, item.source)
        vertices = rest_positions(whole, fine.modelled)
        part = whole.with_faces(_chosen_faces(item, whole, vertices))
        if item.cut_at is not None:
            part = _cut(part, fine.modelled, item.cut_at)
        offsets = tpose_offsets(part, fine.rig, fine.modelled, fine.tpose)
        listed = _listed(item, whole, part, fine.modelled)
        covered = Cover(listed, listed)
        if item.slot in COVERING:
            cloth = np.einsum("nk,nkc->nc", part.weights, fine.tpose.vertices[part.refs]) + offsets
            neck = fine.joints[INDEX["neck"]]
            covered = cover(mesh, fine.tpose.vertices, neck, part.faces, cloth, listed)
        piece = Piece(item, part, offsets, covered)
        out.append(_with_locks(piece, fine) if item.name in LOCKS else piece)
    return out


def _with_locks(piece: Piece, fine: FineRig) -> Piece:
    """The hair and the locks over it, each of whose vertices hangs where one of the hair's does."""
    proxy = piece.proxy
    bound = np.einsum("nk,nkc->nc", proxy.weights, fine.tpose.vertices[proxy.refs])
    locks = strands.grow(
        LOCKS[piece.item.name],
        bound + piece.offsets,
        proxy.faces,
        proxy.uv,
        proxy.uv_faces,
        textures.read_rgba(proxy.textures["diffuse"]),
    )
    carrier = locks.carrier
    grown = replace(
        proxy,
        refs=np.concatenate([proxy.refs, proxy.refs[carrier]]),
        weights=np.concatenate([proxy.weights, proxy.weights[carrier]]),
        offsets=np.concatenate([proxy.offsets, proxy.offsets[carrier]]),
        faces=np.concatenate([proxy.faces, _after(len(proxy.refs), locks.faces)]),
        uv=np.concatenate([proxy.uv, locks.uv]),
        uv_faces=np.concatenate([proxy.uv_faces, _after(len(proxy.uv), locks.faces)]),
    )
    return replace(
        piece, proxy=grown, offsets=np.concatenate([piece.offsets, locks.vertices - bound[carrier]])
    )


def _after(count: int, faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """Faces whose vertices are numbered after ``count`` others."""
    return np.where(faces < 0, -1, faces + count)


def _chosen_faces(item: Item, proxy: Proxy, vertices: NDArray[np.float64]) -> NDArray[np.bool_]:
    """``(F,)`` the faces of the suit that belong to the item."""
    if item.part == "whole":
        return np.ones(len(proxy.faces), bool)
    # One suit is a single piece; its texture islands part where its seams are.
    pieces = face_pieces(proxy.faces)
    if pieces.max() == 0:
        pieces = face_pieces(proxy.uv_faces)
    height = vertices[np.where(proxy.faces < 0, proxy.faces[:, :1], proxy.faces), 1].mean(axis=1)
    middle = (np.bincount(pieces, height) / np.bincount(pieces))[pieces]
    return middle > WAIST if item.part == "upper" else (middle <= WAIST) & (middle >= SHOE_LINE)


def _cut(proxy: Proxy, modelled: NDArray[np.float64], height: float) -> Proxy:
    """What lies above ``height`` over the ground; faces across the cut end at it, so that the hem is even."""
    level = modelled[:BODY_VERTICES, 1].min() + height
    y = rest_positions(proxy, modelled)[:, 1]
    corners = np.where(proxy.faces < 0, proxy.faces[:, :1], proxy.faces)
    offsets = proxy.offsets + np.outer(np.clip(level - y, 0, None), [0, 1, 0])
    return replace(proxy, offsets=offsets).with_faces((y[corners] > level).any(axis=1))


def _listed(item: Item, whole: Proxy, part: Proxy, modelled: NDArray[np.float64]) -> NDArray[np.int64]:
    """Of the skin that the whole suit hides by its own list, what is nearer to this part than to the rest."""
    if len(part.refs) == len(whole.refs):
        return whole.hidden
    skin = modelled[whole.hidden]
    here, _ = cKDTree(rest_positions(part, modelled)).query(skin)
    anywhere, _ = cKDTree(rest_positions(whole, modelled)).query(skin)
    covered = here <= anywhere + 1e-6
    if item.cut_at is not None:
        covered &= skin[:, 1] > modelled[:BODY_VERTICES, 1].min() + item.cut_at + INSIDE_EDGE
    return whole.hidden[covered]


def support_vertices(pieces: list[Piece]) -> NDArray[np.int64]:
    """Base-mesh vertices that any item hangs on, sorted."""
    return np.unique(np.concatenate([piece.proxy.refs.ravel() for piece in pieces]))


def item_arrays(
    pieces: list[Piece], support: NDArray[np.int64], fine: FineRig, model_order: NDArray[np.int64]
) -> dict[str, NDArray[Any]]:
    """Geometry of all items; keys are ``item/array``.

    Two weights are stored, the third is what is missing to 1. Offsets are taken after rounding the
    weights, so that rounding does not add up.
    """
    out: dict[str, NDArray[Any]] = {"body_vertices": np.array(len(model_order), np.uint32)}
    for piece in pieces:
        proxy, name = piece.proxy, piece.item.name
        weights = proxy.weights[:, :2].astype(np.float16)
        exact = np.concatenate(
            [weights.astype(float), 1 - weights.astype(float).sum(axis=1, keepdims=True)], axis=1
        )
        at = np.einsum("nk,nkc->nc", proxy.weights, fine.tpose.vertices[proxy.refs]) + piece.offsets
        offsets = at - np.einsum("nk,nkc->nc", exact, fine.tpose.vertices[proxy.refs])
        out |= {
            f"{name}/refs": np.searchsorted(support, proxy.refs).astype(np.uint16),
            f"{name}/weights": weights,
            f"{name}/offsets": offsets.astype(np.float16),
            f"{name}/faces": np.where(proxy.faces < 0, NO_VERTEX, proxy.faces).astype(np.uint16),
            f"{name}/uv": np.rint(proxy.uv * UV_UNIT).astype(np.int16),
            f"{name}/uv_faces": np.where(proxy.uv_faces < 0, NO_VERTEX, proxy.uv_faces).astype(np.uint16),
        }
        for key, vertices in (("hidden", piece.cover.hidden), ("under", piece.cover.under)):
            if len(vertices):
                out[f"{name}/{key}"] = np.packbits(np.isin(model_order, vertices))
    return out


def item_entries(pieces: list[Piece], store: TextureStore) -> list[dict[str, Any]]:
    """Catalogue entries of all items; their textures go to ``store``."""
    used = _used_by_source(pieces)
    entries = []
    for piece in pieces:
        item = piece.item
        entry: dict[str, Any] = {
            "name": item.name,
            "slot": item.slot,
            "wearer": item.wearer,
            "colouring": item.colouring,
        }
        alpha = item.slot in ("hair", "brows", "lashes")
        for kind in ("diffuse", "normal"):
            path = piece.proxy.textures.get(kind)
            if path is None or (alpha and kind == "normal"):
                continue
            pixels = textures.read_rgba(path) if alpha else textures.read_rgb(path)
            if kind == "diffuse" and not alpha:
                pixels = textures.paint_out(pixels, LOGOS.get(item.source, ()))
                if (shading := piece.proxy.textures.get("ao")) is not None:
                    pixels = textures.bake_shading(pixels, textures.read_rgb(shading))
            if alpha:
                pixels = textures.cut_out(pixels, used[item.source])
            else:
                pixels = textures.fill_unused(pixels, used[item.source])
            if item.slot == "hair":
                pixels = textures.strands_only(pixels)
            entry[kind] = store.add(path.stem, pixels)
        entries.append(entry)
    return entries


def _used_by_source(pieces: list[Piece]) -> dict[str, NDArray[np.bool_]]:
    used: dict[str, NDArray[np.bool_]] = {}
    for piece in pieces:
        mask = textures.used_pixels(piece.proxy.uv, piece.proxy.uv_faces, (512, 512))
        source = piece.item.source
        used[source] = used[source] | mask if source in used else mask
    return used


def skin_entries(sources: Sources, mesh: BaseMesh, store: TextureStore) -> list[dict[str, Any]]:
    """Catalogue entries of the skins; their textures go to ``store``."""
    faces = mesh.uv_quads[mesh.faces_of("body")]
    used = textures.used_pixels(mesh.uv, faces, (512, 512))
    entries = []
    for skin in SKINS:
        pixels = textures.read_rgb(sources.skins / skin.folder / "textures" / skin.file)
        file = store.add(f"skin_{skin.name}", textures.fill_unused(pixels, used))
        tone = [round(float(x), 1) for x in np.median(pixels[used], axis=0)]
        entries.append(
            {
                "name": skin.name,
                "age": skin.age,
                "origin": skin.origin,
                "gender": skin.gender,
                "diffuse": file,
                "tone": tone,
            }
        )
    return entries


def write_textures(store: TextureStore, folder: Path) -> dict[str, str]:
    """Writes the stored files and returns their SHA-256 by name."""
    folder.mkdir(parents=True, exist_ok=True)
    for stale in folder.iterdir():
        stale.unlink()
    for name, data in store.files.items():
        (folder / name).write_bytes(data)
    return {name: hashlib.sha256(data).hexdigest() for name, data in sorted(store.files.items())}
