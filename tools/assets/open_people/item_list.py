"""Which items the wardrobe takes, and what each is.

Only MakeHuman's own core assets: their owners released them as CC0. Everything else in the npm package
(community clothes under CC BY or AGPL) stays out, and so does ``male_worksuit01``, whose mesh there is
not the released one. The skirt of ``female_elegantsuit01`` stays out as well: bound to the skin of two legs,
it tears where they part.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Final, Literal

from open_people.strands import Style

Slot = Literal["top", "bottom", "shoes", "hat", "hair", "brows", "lashes"]
Wearer = Literal["female", "male", "any"]
Age = Literal["young", "middle", "old"]
Origin = Literal["african", "asian", "caucasian"]
Gender = Literal["female", "male"]
Colouring = Literal["cloth", "pattern", "denim", "leather", "keep", "hair"]


@dataclass(frozen=True)
class Item:
    """One thing to wear.

    Attributes:
        name: in the catalogue.
        slot: what it is worn as.
        folder, source: place in the npm package.
        part: the pieces of a suit that make this item: those whose middle lies above or below the waist.
        wearer: who may wear it.
        colouring: how colours may vary.
        cut_at: keep only what lies above this height (metres above the ground, neutral body, T-pose).
    """

    name: str
    slot: Slot
    folder: str
    source: str
    part: Literal["whole", "upper", "lower"] = "whole"
    wearer: Wearer = "any"
    colouring: Colouring = "cloth"
    cut_at: float | None = None


def _clothes(name: str, slot: Slot, source: str, **more: object) -> Item:
    return Item(name, slot, "clothes", source, **more)  # type: ignore[arg-type]


ITEMS: Final = (
    _clothes("tee_fitted", "top", "female_casualsuit01", part="upper", wearer="female"),
    _clothes("tee_short", "top", "female_sportsuit01", part="upper", wearer="female"),
    _clothes("blouse", "top", "female_elegantsuit01", part="upper", wearer="female", colouring="pattern"),
    _clothes("shirt", "top", "male_casualsuit01", part="upper", wearer="male"),
    _clothes("pullover", "top", "male_casualsuit02", part="upper"),
    _clothes("shirt_striped", "top", "male_casualsuit03", part="upper", wearer="male", colouring="pattern"),
    _clothes("tee", "top", "male_casualsuit04", part="upper"),
    _clothes("jacket", "top", "male_casualsuit05", part="upper", colouring="pattern"),
    _clothes("tee_loose", "top", "male_casualsuit06", part="upper"),
    _clothes("suit_jacket", "top", "male_elegantsuit01", part="upper", wearer="male", colouring="keep"),
    _clothes(
        "jeans_fitted", "bottom", "female_casualsuit01", part="lower", wearer="female", colouring="denim"
    ),
    _clothes(
        "shorts_denim", "bottom", "female_casualsuit02", part="lower", wearer="female", colouring="denim"
    ),
    _clothes(
        "jeans_cropped",
        "bottom",
        "female_casualsuit01",
        part="lower",
        wearer="female",
        colouring="denim",
        cut_at=0.24,
    ),
    _clothes("track_trousers", "bottom", "female_sportsuit01", part="lower", wearer="female"),
    _clothes("track_shorts", "bottom", "female_sportsuit01", part="lower", wearer="female", cut_at=0.56),
    _clothes("jeans_worn", "bottom", "male_casualsuit01", part="lower", wearer="male", colouring="denim"),
    _clothes("jeans", "bottom", "male_casualsuit04", part="lower", colouring="denim"),
    _clothes(
        "shorts", "bottom", "male_casualsuit04", part="lower", wearer="male", colouring="denim", cut_at=0.54
    ),
    _clothes("suit_trousers", "bottom", "male_elegantsuit01", part="lower", wearer="male", colouring="keep"),
    _clothes("shoes_brown", "shoes", "shoes01", colouring="leather"),
    _clothes("trainers_grey", "shoes", "shoes02", colouring="leather"),
    _clothes("shoes_dress", "shoes", "shoes03", colouring="keep"),
    _clothes("shoes_dark", "shoes", "shoes04", colouring="leather"),
    _clothes("trainers_white", "shoes", "shoes05", colouring="leather"),
    _clothes("trainers_blue", "shoes", "shoes06", colouring="leather"),
    _clothes("fedora", "hat", "fedora"),
    _clothes("fedora_cocked", "hat", "fedora_cocked"),
    Item("hair_afro", "hair", "hair", "afro01", colouring="hair"),
    Item("hair_bob", "hair", "hair", "bob01", wearer="female", colouring="hair"),
    Item("hair_bob_fringe", "hair", "hair", "bob02", wearer="female", colouring="hair"),
    Item("hair_braid", "hair", "hair", "Braid01", wearer="female", colouring="hair"),
    Item("hair_long", "hair", "hair", "long01", wearer="female", colouring="hair"),
    Item("hair_ponytail", "hair", "hair", "ponytail01", wearer="female", colouring="hair"),
    Item("hair_short", "hair", "hair", "short01", colouring="hair"),
    Item("hair_cropped", "hair", "hair", "short02", wearer="male", colouring="hair"),
    Item("hair_parted", "hair", "hair", "short03", wearer="male", colouring="hair"),
    Item("hair_swept", "hair", "hair", "short04", wearer="male", colouring="hair"),
    *(Item(f"brows_{k:02d}", "brows", "eyebrows", f"eyebrow{k:03d}", colouring="hair") for k in range(1, 13)),
    *(
        Item(f"lashes_{k}", "lashes", "eyelashes", source, colouring="keep")
        for k, source in enumerate(("Eyelashes01", "eyelashes02", "eyelashes03", "eyelashes04"), start=1)
    ),
)


@dataclass(frozen=True)
class Skin:
    """One skin texture: ``file`` below ``skins/folder/textures``."""

    name: str
    folder: str
    file: str
    age: Age
    origin: Origin
    gender: Gender


_AGES: Final[dict[Age, str]] = {"young": "young", "middle": "middleage", "old": "old"}
_SHADES: Final[dict[Origin, tuple[str, str]]] = {
    "african": ("darkskinned", ""),
    "asian": ("lightskinned", "2"),
    "caucasian": ("lightskinned", ""),
}
_GENDERS: Final[tuple[Gender, ...]] = ("female", "male")


def _skins() -> tuple[Skin, ...]:
    out = []
    for (age, folder_age), (origin, (shade, number)), gender in product(
        _AGES.items(), _SHADES.items(), _GENDERS
    ):
        # The young light textures are numbered otherwise: 3 is the Asian one, 2 a second Caucasian.
        young_asian = (age, origin) == ("young", "asian")
        names = {f"{age}_{origin}_{gender}": "3" if young_asian else number}
        if (age, origin) == ("young", "caucasian"):
            names[f"{age}_{origin}_{gender}_2"] = "2"
        for name, suffix in names.items():
            file = f"{folder_age}_{shade}_{gender}_diffuse{suffix}.png"
            out.append(Skin(name, f"{folder_age}_{origin}_{gender}", file, age, origin, gender))
    return tuple(out)


SKINS: Final = _skins()


@dataclass(frozen=True)
class Patch:
    """A rectangle (left, top, right, bottom, pixels) overwritten with the cloth ``shift`` pixels away."""

    box: tuple[int, int, int, int]
    shift: tuple[int, int]


LOGOS: Final[dict[str, tuple[Patch, ...]]] = {
    "female_casualsuit01": (Patch((360, 76, 446, 162), (-82, 0)),),
    "female_casualsuit02": (Patch((360, 76, 446, 162), (-82, 0)),),
    "male_casualsuit02": (Patch((252, 52, 322, 122), (0, 70)),),
    "male_casualsuit04": (Patch((252, 50, 322, 120), (0, 69)),),
    "male_casualsuit06": (
        Patch((100, 56, 154, 90), (0, 36)),
        Patch((224, 58, 324, 110), (0, 54)),
        Patch((374, 76, 392, 94), (0, 22)),
    ),
}
"""MakeHuman's mark on the chest of some shirts, by source; a mark of its own is not CC0 material."""

LOCKS: Final[dict[str, Style]] = {
    "hair_afro": Style(1500, length=0.03, width=0.004, lift=0.006, roll=60.0, tangle=1.2),
    "hair_bob": Style(900, length=0.07),
    "hair_bob_fringe": Style(900, length=0.07, parted=True),
    "hair_braid": Style(700, length=0.05, lift=0.0015, floor=0.16),
    "hair_ponytail": Style(700, length=0.05, lift=0.0015, floor=0.16),
    "hair_short": Style(1000, length=0.035),
    "hair_cropped": Style(1100, length=0.03),
    "hair_parted": Style(1000, length=0.05),
    "hair_swept": Style(900, length=0.05),
}
"""The locks laid over the shells of hair, by item. Long hair has strips of its own."""
