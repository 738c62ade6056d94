"""Clothes for any body in the SMPL-X schema: shells cut from its own surface.

The wardrobe is bound to the embedded body. On another model (a licensed SMPL-X file) a person wears what
can be derived from the body itself: shirt, trousers, shoes and hair as parts of the skin, lifted off it.
Or, where the user has textures for that model's UV map, one of those.
"""

import hashlib
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Final

import numpy as np
import numpy.typing as npt

from render_jobs.scene import Material, Mesh
from whacamole.body import JOINT_INDEX, BodyModel, vertex_normals
from whacamole.errors import TakeError
from whacamole.wardrobe import palette
from whacamole.wardrobe.cast import CastMember
from whacamole.wardrobe.catalogue import catalogue
from whacamole.wardrobe.clipping import Part, clip_surface

Float32Array = npt.NDArray[np.float32]
FloatArray = npt.NDArray[np.float64]

SUFFIXES: Final = (".jpg", ".jpeg", ".png")

LIFT: Final = {"top": 0.010, "bottom": 0.007, "shoes": 0.014, "hair": 0.012, "iris": 0.0004}
"""How far each shell stands off the skin [m]; a shirt hangs over trousers."""

SMOOTHING: Final = {"top": 5, "bottom": 4, "shoes": 30, "hair": 6}
"""Rounds of smoothing: cloth shows no navel, a shoe no toes."""

ROUGH: Final = {"skin": 0.55, "top": 0.85, "bottom": 0.9, "shoes": 0.5, "hair": 0.5, "iris": 0.1, "eyes": 0.1}
SHOE_COLOURS: Final = ((0.10, 0.09, 0.09), (0.32, 0.20, 0.12), (0.85, 0.84, 0.82), (0.30, 0.31, 0.34))
UNDER: Final = 0.03
"""Skin this far inside a garment's edge [m] is left out."""


def dress_in_shells(
    member: CastMember, body: BodyModel, posed: Float32Array, *, track_id: int, name: str, subdivision: int
) -> list[Mesh]:
    """A person on any SMPL-X body.

    Args:
        member: whose colours, hair and kind of clothes are worn; the shape plays no part.
        posed: vertices (T, V, 3) of the frames to draw.
    """
    colours = _colours(member)
    parts = _parts(
        body,
        _long(member, "top"),
        _long(member, "bottom"),
        any(w.item.startswith("hair") for w in member.worn),
    )
    normals = vertex_normals(posed, body.faces)
    out = []
    for kind, part in parts.items():
        vertices = part.apply(posed)
        if kind in LIFT:
            vertices += np.float32(LIFT[kind]) * part.apply(normals)
        material = Material(
            name=f"{name}-{kind}",
            base_color=colours[kind],
            roughness=ROUGH[kind],
            specular=0.4,
            subsurface=0.08 if kind == "skin" else 0.0,
        )
        level = subdivision if kind not in ("iris", "eyes") else 0
        out.append(
            Mesh(f"{name}-{kind}", vertices, part.faces, material, track_id=track_id, subdivision=level)
        )
    return out


def dress_in_texture(
    member: CastMember,
    body: BodyModel,
    posed: Float32Array,
    folder: Path,
    *,
    track_id: int,
    name: str,
    subdivision: int,
) -> list[Mesh]:
    """A person whose skin and clothes are one picture on the model's UV map, chosen from a folder by the
    member.

    Files whose path says "female" or "male" are worn by that gender, unless there are no others.

    Raises:
        TakeError: the folder has no pictures, or the model no UV map.
    """
    files = checked_textures(body, folder)
    fitting = [f for f in files if _gender_of(f.relative_to(folder)) in ("", member.gender)] or files
    chosen = fitting[_number(member) % len(fitting)]
    material = Material(name=f"{name}-skin", base_color_texture=chosen, roughness=0.65, specular=0.35)
    mesh = Mesh(
        f"{name}-skin",
        posed,
        body.faces,
        material,
        uv=body.uv[body.uv_faces],
        track_id=track_id,
        subdivision=subdivision,
    )
    return [mesh]


def checked_textures(body: BodyModel, folder: Path) -> list[Path]:
    """The pictures of a folder that people on ``body`` may wear.

    Raises:
        TakeError: the folder has no pictures, or the model no UV map.
    """
    if len(body.uv) < 3:
        raise TakeError(f"{body.name}: the body model has no UV map (vt, ft); leave --textures out")
    files = texture_files(folder)
    if not files:
        raise TakeError(f"{folder}: no .png or .jpg pictures in it; check --textures")
    return files


def texture_files(folder: Path) -> list[Path]:
    """All pictures below a folder, sorted."""
    return sorted(path for path in folder.rglob("*") if path.suffix.lower() in SUFFIXES and path.is_file())


def _gender_of(path: Path) -> str:
    text = path.as_posix().lower()
    return next((gender for gender in ("female", "male") if gender in text), "")


def _number(member: CastMember) -> int:
    """A number that follows from who the member is."""
    return int.from_bytes(
        hashlib.sha256(member.betas.tobytes() + member.skin.encode()).digest()[:8], "little"
    )


def _long(member: CastMember, slot: str) -> bool:
    """Whether the member's own top has long sleeves, or trousers long legs."""
    short = ("tee", "tee_fitted", "tee_short", "tee_loose", "shorts", "shorts_denim", "track_shorts")
    return all(w.item not in short for w in member.worn if catalogue().items[w.item].slot == slot)


def _colours(member: CastMember) -> dict[str, palette.Colour]:
    number = _number(member)
    slots = {catalogue().items[worn.item].slot: worn.colour for worn in member.worn}
    red, green, blue = palette.skin_tone(member.tone) / 255
    return {
        "skin": (float(red), float(green), float(blue)),
        "top": slots["top"] or palette.CLOTH_COLOURS[number % len(palette.CLOTH_COLOURS)],
        "bottom": slots["bottom"] or palette.DENIM_COLOURS[number % len(palette.DENIM_COLOURS)],
        "shoes": SHOE_COLOURS[number % len(SHOE_COLOURS)],
        "hair": palette.HAIR_COLOURS[member.hair_colour],
        "eyes": (0.86, 0.83, 0.80),
        "iris": tuple(0.6 * c for c in palette.EYE_COLOURS[member.eye_colour]),  # type: ignore[dict-item]
    }


@lru_cache(maxsize=16)
def _parts(body: BodyModel, long_sleeves: bool, long_legs: bool, with_hair: bool) -> dict[str, Part]:
    """Skin left bare, eyes, and the shells."""
    rest = body.v_template.astype(np.float64)
    joints = body.rest_joints(np.zeros(10))
    eyeball = body.weights[:, [JOINT_INDEX["left_eye"], JOINT_INDEX["right_eye"]]].sum(axis=1) > 0.5
    of_eye = eyeball[body.faces].all(axis=1)
    head = body.weights[:, [JOINT_INDEX["head"], JOINT_INDEX["jaw"]]].sum(axis=1)
    fields = dict(_fields(rest, joints, head, long_sleeves, long_legs))
    if not with_hair:
        del fields["hair"]
    bare = np.min([UNDER - field for kind, field in fields.items() if kind != "hair"], axis=0)
    skin, eyes = body.faces[~of_eye], body.faces[of_eye]
    out = {"skin": clip_surface(skin, bare), "eyes": clip_surface(eyes, np.ones(len(rest)))}
    out |= {kind: clip_surface(skin, field).smoothed(SMOOTHING[kind]) for kind, field in fields.items()}
    if len(eyes):
        out["iris"] = clip_surface(eyes, _iris_field(rest, eyeball))
    return {kind: part for kind, part in out.items() if len(part.faces)}


def _fields(
    rest: FloatArray, joints: FloatArray, head: Float32Array, long_sleeves: bool, long_legs: bool
) -> Iterator[tuple[str, FloatArray]]:
    """Signed distances [m] to the edges of each garment on the rest surface, positive inside.

    In the T-pose heights part the legs and the trunk, x parts the arms. ``head (V,)`` is the skinning
    weight of the head, which keeps a collar off the chin.
    """
    at = {name: joints[index] for name, index in JOINT_INDEX.items()}
    x, y, z = np.abs(rest[:, 0]), rest[:, 1], rest[:, 2]
    elbow, wrist = (abs(at[f"left_{name}"][0]) for name in ("elbow", "wrist"))
    sleeve = (wrist - 0.02 if long_sleeves else elbow - 0.07) - x
    pelvis, neck = at["pelvis"], at["neck"]
    collar = np.linalg.norm(rest - neck - [0, 0.03, 0.03], axis=1) - 0.085
    chin = 0.1 * (0.5 - head)
    yield "top", np.min([sleeve, y - (pelvis[1] - 0.05), neck[1] + 0.05 - y, collar, chin], axis=0)
    knee, ankle = at["left_knee"][1], at["left_ankle"][1]
    yield "bottom", np.minimum(pelvis[1] + 0.06 - y, y - (ankle + 0.02 if long_legs else knee + 0.08))
    yield "shoes", ankle + 0.045 - y
    eye = (at["left_eye"] + at["right_eye"]) / 2
    of_head = y > at["head"][1] - 0.05
    front = z[of_head].max()
    forward = np.clip((z - at["head"][2]) / (front - at["head"][2]), 0, 1)
    line = eye[1] - 0.07 + 0.135 * forward
    yield "hair", np.where(of_head, y - line, -1.0)


def _iris_field(rest: FloatArray, eyeball: npt.NDArray[np.bool_]) -> FloatArray:
    """Positive within the iris of either eye, seen from the front at rest."""
    field = np.full(len(rest), -1.0)
    for sign in (-1, 1):
        eye = eyeball & (np.sign(rest[:, 0]) == sign)
        if not eye.any():
            continue
        low, high = rest[eye].min(axis=0), rest[eye].max(axis=0)
        middle, radius = (low + high) / 2, (high - low)[:2].mean() / 2
        across = np.linalg.norm(rest[eye, :2] - middle[:2], axis=1)
        field[eye] = np.where(rest[eye, 2] > middle[2], 0.44 * radius - across, -radius)
    return field
