"""What hangs in the wardrobe: items, skins and how people vary, read from the package's assets."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.resources import files
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np
import numpy.typing as npt

from whacamole.body.lean import unpack
from whacamole.body.schema import BodyArrays

Slot = Literal["top", "bottom", "shoes", "hat", "hair", "brows", "lashes"]
Gender = Literal["female", "male"]
Age = Literal["young", "middle", "old"]
Origin = Literal["african", "asian", "caucasian"]

AGES: Final[tuple[Age, ...]] = ("young", "middle", "old")
ORIGINS: Final[tuple[Origin, ...]] = ("african", "asian", "caucasian")
GENDERS: Final[tuple[Gender, ...]] = ("female", "male")

_UV_UNIT = 16384
_NO_VERTEX = 65535


@dataclass(frozen=True)
class Item:
    """One thing to wear.

    Attributes:
        name: unique in the catalogue.
        slot: what it is worn as.
        wearer: "female", "male" or "any".
        colouring: how its colours may vary: "cloth", "pattern", "denim", "leather", "hair" or "keep".
        diffuse: texture file; with an alpha channel for hair, brows and lashes.
        normal: normal map file, or None.
    """

    name: str
    slot: Slot
    wearer: str
    colouring: str
    diffuse: str
    normal: str | None = None

    @property
    def see_through(self) -> bool:
        """Whether the texture's alpha cuts the surface."""
        return self.slot in ("hair", "brows", "lashes")


@dataclass(frozen=True, eq=False)
class ItemGeometry:
    """How an item hangs on the support vertices, in the T-pose.

    vertex k = Σ weights[k, i] · support[refs[k, i]] + offsets[k]

    Attributes:
        refs: (n, 3) support vertices.
        weights: (n, 3), rows sum to 1; may be negative.
        offsets: (n, 3) [m].
        faces: (F, 4), −1 in the last column of a triangle.
        uv: (F, 4, 2) one coordinate a face corner, v up.
        hidden: (V,) body vertices that cannot be seen under the item.
        under: (V,) all body vertices under the item, the hidden ones among them.
    """

    refs: npt.NDArray[np.int32]
    weights: npt.NDArray[np.float64]
    offsets: npt.NDArray[np.float64]
    faces: npt.NDArray[np.int32]
    uv: npt.NDArray[np.float32]
    hidden: npt.NDArray[np.bool_]
    under: npt.NDArray[np.bool_]

    @property
    def corners(self) -> npt.NDArray[np.int32]:
        """(F, 4) vertices of the faces; a triangle has its last twice."""
        return np.where(self.faces < 0, self.faces[:, 2:3], self.faces)


@dataclass(frozen=True)
class SkinTexture:
    """One skin. ``tone`` is the median sRGB colour, 0 to 255."""

    name: str
    age: Age
    origin: Origin
    gender: Gender
    diffuse: str
    tone: tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class ShapeModel:
    """How body shape goes with gender, age and origin: betas ~ N(matrix · x, deviation · deviationᵀ).

    x = (1, male, years past 25 as a share of 65, African, Asian); fitted to the adults of the asset build.

    Attributes:
        matrix: (10, 5).
        deviation: (10, 10) lower triangular.
    """

    matrix: npt.NDArray[np.float64]
    deviation: npt.NDArray[np.float64]


class Catalogue:
    """The wardrobe of the package, read once; see :func:`catalogue`."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        data: dict[str, Any] = json.loads((folder / "catalogue.json").read_text(encoding="utf-8"))
        self.items: Mapping[str, Item] = {entry["name"]: Item(**entry) for entry in data["items"]}
        self.skins = tuple(SkinTexture(**{**e, "tone": tuple(e["tone"])}) for e in data["skins"])
        self.shape = ShapeModel(np.array(data["shape"]["matrix"]), np.array(data["shape"]["deviation"]))
        self.topology = str(data["topology"])
        self._geometry: dict[str, ItemGeometry] = {}

    def of_slot(self, slot: Slot, gender: Gender) -> tuple[Item, ...]:
        """The items of one slot that ``gender`` may wear, in the order of the catalogue."""
        return tuple(i for i in self.items.values() if i.slot == slot and i.wearer in (gender, "any"))

    def texture(self, name: str) -> Path:
        """Path of a texture file."""
        return self._folder / "textures" / name

    @cached_property
    def support(self) -> BodyArrays:
        """The vertices that items hang on, in the form of a body model without joints of its own."""
        with np.load(self._folder / "support.npz", allow_pickle=False) as lean:
            return unpack(lean, "support.npz")

    def geometry(self, name: str) -> ItemGeometry:
        """Geometry of an item."""
        if name not in self._geometry:
            self._geometry[name] = self._read_geometry(name)
        return self._geometry[name]

    @cached_property
    def _arrays(self) -> Mapping[str, npt.NDArray[Any]]:
        with np.load(self._folder / "items.npz", allow_pickle=False) as arrays:
            return {key: arrays[key] for key in arrays.files}

    def _read_geometry(self, name: str) -> ItemGeometry:
        def get(key: str) -> npt.NDArray[Any]:
            return self._arrays[f"{name}/{key}"]

        weights = get("weights").astype(np.float64)
        faces, uv_faces = (
            np.where(get(key) == _NO_VERTEX, -1, get(key).astype(np.int32)) for key in ("faces", "uv_faces")
        )
        count = int(self._arrays["body_vertices"])

        def flags(key: str) -> npt.NDArray[np.bool_]:
            packed = self._arrays.get(f"{name}/{key}")
            if packed is None:
                return np.zeros(count, bool)
            return np.unpackbits(packed, count=count).astype(bool)

        return ItemGeometry(
            refs=get("refs").astype(np.int32),
            weights=np.concatenate([weights, 1 - weights.sum(axis=1, keepdims=True)], axis=1),
            offsets=get("offsets").astype(np.float64),
            faces=faces.astype(np.int32),
            uv=(get("uv").astype(np.float32) / _UV_UNIT)[uv_faces],
            hidden=flags("hidden"),
            under=flags("under"),
        )


@cache
def catalogue() -> Catalogue:
    """The wardrobe of the package."""
    return Catalogue(Path(str(files("whacamole"))) / "assets" / "wardrobe")
