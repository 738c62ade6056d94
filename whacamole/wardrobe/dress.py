"""Dresses a cast member: the meshes of one person over time, ready for a render job."""

import hashlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from render_jobs.scene import Material, Mesh
from whacamole.body import BodyModel, BodyParams
from whacamole.wardrobe.cast import CastMember
from whacamole.wardrobe.catalogue import Catalogue, catalogue
from whacamole.wardrobe.layer import item_layer, join
from whacamole.wardrobe.layering import wear_all
from whacamole.wardrobe.shells import dress_in_shells, dress_in_texture
from whacamole.wardrobe.skin import beside, drawn_in, keep_below
from whacamole.wardrobe.textures import TextureFolder, eye_texture, item_texture, skin_texture

Float32Array = npt.NDArray[np.float32]
Int32Array = npt.NDArray[np.int32]
BoolArray = npt.NDArray[np.bool_]

SKIN_PART, EYE_PARTS, TEETH_PARTS, TONGUE_PART = 0, (1, 2), (3, 4), 5
"""Values of the body file's ``vertex_part``."""

ROUGHNESS: Final = {"leather": 0.5, "hair": 0.7, "cloth": 0.9, "pattern": 0.9, "denim": 0.9, "keep": 0.8}
SPECULAR: Final = {"leather": 0.3, "hair": 0.12, "cloth": 0.15, "pattern": 0.15, "denim": 0.15, "keep": 0.25}
"""How surfaces shine. Strands of hair scatter: one even gloss over all of them makes a helmet of a head."""


@dataclass(frozen=True, eq=False)
class _Look:
    """What all meshes of one person share."""

    name: str
    track_id: int
    subdivision: int

    def mesh(
        self,
        part: str,
        vertices: Float32Array,
        faces: Int32Array,
        material: Material,
        uv: Float32Array | None = None,
        *,
        fine: bool = False,
    ) -> Mesh:
        return Mesh(
            name=f"{self.name}-{part}",
            vertices=vertices,
            faces=faces,
            uv=uv,
            material=material.model_copy(update={"name": f"{self.name}-{part}"}),
            track_id=self.track_id,
            subdivision=0 if fine else self.subdivision,
        )


def fits(body: BodyModel) -> bool:
    """Whether the wardrobe was cut for this body."""
    if body.quads is None or "vertex_part" not in body.extras:
        return False
    return hashlib.sha256(body.quads.astype(np.int32).tobytes()).hexdigest() == catalogue().topology


def dress(
    member: CastMember,
    body: BodyModel,
    params: BodyParams,
    *,
    textures: Path,
    track_id: int = 1,
    name: str = "person",
    subdivision: int = 0,
    uv_textures: Path | None = None,
) -> list[Mesh]:
    """One person as meshes: skin, eyes, mouth, clothes, hair.

    On the embedded body a person wears the wardrobe. On another SMPL-X model a person wears a picture from
    ``uv_textures`` if given, else garments derived from the body's surface.

    Args:
        member: who.
        body: the body model.
        params: every frame to be drawn, the neighbours −1 and T included.
        textures: folder for textures made to order; people may share it.
        uv_textures: the user's folder of pictures for the UV map of the body model.
        track_id: what the mask says; all meshes of the person carry it.
        name: prefix of the meshes' names, unique in the job.
        subdivision: levels for skin and clothes; 1 for people the camera sees closely.

    Raises:
        TakeError: ``uv_textures`` has no fitting picture, or the body model no UV map.
    """
    posed = body.pose(params).vertices
    if uv_textures is not None:
        return dress_in_texture(
            member, body, posed, uv_textures, track_id=track_id, name=name, subdivision=subdivision
        )
    if not fits(body):
        return dress_in_shells(member, body, posed, track_id=track_id, name=name, subdivision=subdivision)
    wardrobe, folder = catalogue(), TextureFolder(textures)
    look = _Look(name, track_id, subdivision)
    items = [wardrobe.items[worn.item] for worn in member.worn]
    geometries = [wardrobe.geometry(item.name) for item in items]
    hidden = np.any([geometry.hidden for geometry in geometries], axis=0)
    under = np.any([geometry.under for geometry in geometries], axis=0) & beside(body, ~hidden)
    layers = [item_layer(wardrobe, item.name) for item in items]
    ends = np.cumsum([layer.num_vertices for layer in layers])[:-1]
    clothes = np.split(join(layers).pose(body, params), ends, axis=1)
    unseen = wear_all(wardrobe, items, [layer.rest(params.betas) for layer in layers], clothes)
    lowered = drawn_in(body, posed, under)
    keep_below(wardrobe, body, items, clothes, lowered, under)
    skin = skin_texture(wardrobe, member, folder)
    eyes = eye_texture(member.eye_colour, folder)
    return [
        *_body_meshes(look, body, lowered, hidden, skin, eyes),
        *_item_meshes(look, wardrobe, member, clothes, unseen, folder),
    ]


def _body_meshes(
    look: _Look, body: BodyModel, posed: Float32Array, hidden: BoolArray, skin: Path, eyes: Path
) -> Iterator[Mesh]:
    assert body.quads is not None
    assert body.uv_quads is not None
    part = body.extras["vertex_part"]
    of_face = part[body.quads[:, 0]]
    uv = body.uv[body.uv_quads]
    seen = (of_face == SKIN_PART) & ~hidden[body.quads].all(axis=1)
    skin_like = Material(base_color_texture=skin, roughness=0.55, specular=0.4, subsurface=0.08)
    yield look.mesh("skin", *_cut(posed, body.quads[seen]), skin_like, uv[seen])
    for number, side in zip(EYE_PARTS, ("left", "right"), strict=True):
        chosen = of_face == number
        quads = body.quads[chosen]
        eye_like = Material(base_color_texture=eyes, roughness=0.1)
        yield look.mesh(f"{side}-eye", *_cut(posed, quads), eye_like, _eye_uv(body, number, quads))
    teeth, tongue = np.isin(of_face, TEETH_PARTS), of_face == TONGUE_PART
    yield look.mesh(
        "teeth", *_cut(posed, body.quads[teeth]), Material(base_color=(0.83, 0.79, 0.71), roughness=0.3)
    )
    yield look.mesh(
        "tongue", *_cut(posed, body.quads[tongue]), Material(base_color=(0.60, 0.27, 0.26), roughness=0.4)
    )


def _cut(vertices: Float32Array, faces: Int32Array) -> tuple[Float32Array, Int32Array]:
    """The vertices (T, n, 3) that some faces use, and the faces in their numbers."""
    used = np.unique(faces[faces >= 0])
    number = np.full(vertices.shape[1] + 1, -1, dtype=np.int32)  # the last is for the −1 of triangles
    number[used] = np.arange(len(used))
    return vertices[:, used], number[faces]


def _eye_uv(body: BodyModel, part: int, quads: Int32Array) -> Float32Array:
    """(F, 4, 2) the picture laid on the eyeball from the front, at rest."""
    rest = body.v_template
    eye = rest[body.extras["vertex_part"] == part]
    low, high = eye[:, :2].min(axis=0), eye[:, :2].max(axis=0)
    flat: Float32Array = (0.5 + 0.49 * (2 * rest[:, :2] - low - high) / (high - low)).astype(np.float32)
    return flat[quads]


def _item_meshes(
    look: _Look,
    wardrobe: Catalogue,
    member: CastMember,
    clothes: list[Float32Array],
    unseen: tuple[BoolArray, ...],
    folder: TextureFolder,
) -> Iterator[Mesh]:
    for worn, vertices, left_out in zip(member.worn, clothes, unseen, strict=True):
        item, geometry = wardrobe.items[worn.item], wardrobe.geometry(worn.item)
        seen = ~left_out[geometry.corners].all(axis=1)
        material = Material(
            base_color_texture=item_texture(wardrobe, item, worn, member.hair_colour, folder),
            alpha_mode="clip" if item.see_through else "opaque",
            roughness=ROUGHNESS[item.colouring],
            specular=SPECULAR[item.colouring],
            normal_texture=wardrobe.texture(item.normal) if item.normal else None,
        )
        fine = item.see_through or len(geometry.faces) > 3500
        yield look.mesh(
            item.name, *_cut(vertices, geometry.faces[seen]), material, geometry.uv[seen], fine=fine
        )
