"""Who plays: one person from one seed. Shape, skin, hair, clothes, all believable together."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, TypeVar

import numpy as np
import numpy.typing as npt
import scipy.optimize

from whacamole.body import BodyModel
from whacamole.wardrobe.catalogue import (
    AGES,
    GENDERS,
    ORIGINS,
    Age,
    Catalogue,
    Gender,
    Item,
    Origin,
    SkinTexture,
    catalogue,
)
from whacamole.wardrobe.hands import relaxed_hands
from whacamole.wardrobe.palette import CLOTH_COLOURS, DENIM_COLOURS, TONE_RANGE, Colour

FloatArray = npt.NDArray[np.float64]
T = TypeVar("T")

YEARS: Final[dict[Age, tuple[float, float]]] = {"young": (20, 34), "middle": (35, 54), "old": (55, 78)}
"""Years of age that each kind of skin stands for."""

SHAPE_LIMIT: Final = 1.7
"""Individual deviation in standard deviations; beyond it people turn odd."""

BODY_MASS_INDEX: Final[dict[Gender, tuple[float, float]]] = {"female": (23.0, 2.8), "male": (24.8, 2.8)}
"""Mean and deviation in kg/m²; the shape axis for weight is set so that the body has what was drawn."""

WEIGHT_AXIS: Final = 1
WEIGHT_RANGE: Final = (-2.5, 3.0)
"""The beta that follows weight, and how far it may go: the weight of the very tall and small gives way."""

FLESH_DENSITY: Final = 1010.0
"""kg/m³."""

ORIGIN_IN_FACE: Final = 0.7
"""How purely a face shows its origin, 0 mixed to 1."""

HAIR_OF: Final[dict[Origin, dict[str, float]]] = {
    "african": {"black": 0.75, "dark brown": 0.25},
    "asian": {"black": 0.65, "dark brown": 0.30, "brown": 0.05},
    "caucasian": {
        "black": 0.08, "dark brown": 0.27, "brown": 0.22, "light brown": 0.14, "auburn": 0.06, "red": 0.05,
        "dark blond": 0.09, "blond": 0.09,
    },
}  # fmt: skip
GREY_SHARE: Final[dict[Age, float]] = {"young": 0.0, "middle": 0.2, "old": 0.75}

EYES_OF: Final[dict[Origin, dict[str, float]]] = {
    "african": {"dark brown": 0.8, "brown": 0.2},
    "asian": {"dark brown": 0.75, "brown": 0.25},
    "caucasian": {
        "dark brown": 0.12, "brown": 0.25, "amber": 0.08, "hazel": 0.13, "green": 0.10, "grey": 0.10,
        "blue": 0.22,
    },
}  # fmt: skip

NO_HAIR: Final[dict[Gender, dict[Age, float]]] = {
    "female": {"young": 0.0, "middle": 0.0, "old": 0.0},
    "male": {"young": 0.05, "middle": 0.15, "old": 0.3},
}
AFRO: Final = "hair_afro"
AFRO_SHARE: Final[dict[Origin, float]] = {"african": 3.0, "asian": 0.0, "caucasian": 0.3}
"""How often tight curls are chosen, against 1 for every other head of hair."""

HAT_SHARE: Final = 0.12
UNDER_HAT: Final = ("hair_cropped", "hair_short")
"""Hair that is worn with a hat, in place of longer hair."""

SUIT: Final = ("suit_jacket", "suit_trousers", "shoes_dress")
"""Worn together or not at all."""

HIDDEN_BY: Final = {"shorts_denim": ("jacket", "pullover")}
"""Bottoms that end above the hem of these tops, so that whoever wears both seems to wear one."""


@dataclass(frozen=True)
class Worn:
    """One item as worn.

    ``colour`` is what its cloth is dyed, sRGB 0..1; None leaves the colours but turns their hue by
    ``hue`` (1 is the full circle) and scales saturation and brightness.
    """

    item: str
    colour: Colour | None = None
    hue: float = 0.0
    saturation: float = 1.0
    brightness: float = 1.0


@dataclass(frozen=True, eq=False)
class CastMember:
    """One person, fully determined; the same member looks the same in every take.

    Attributes:
        gender, age, origin: what the rest was drawn for.
        years: age in years.
        betas: (10,) shape of the embedded body.
        skin: name of the skin texture; ``tone`` is its depth, 0 lightest to 1 darkest.
        eye_colour, hair_colour: names in the palette.
        worn: clothes, shoes, hat, hair, brows and lashes, from the skin outwards.
        left_hand, right_hand: (15, 3) relaxed hand pose, for motions without hands.
    """

    gender: Gender
    age: Age
    origin: Origin
    years: float
    betas: FloatArray
    skin: str
    tone: float
    eye_colour: str
    hair_colour: str
    worn: tuple[Worn, ...]
    left_hand: FloatArray
    right_hand: FloatArray


def cast(
    seed: int | np.random.Generator,
    *,
    gender: Gender | None = None,
    age: Age | None = None,
    origin: Origin | None = None,
) -> CastMember:
    """One person.

    Genders, ages and origins are equally frequent unless given. The same seed and wishes give the same
    person.
    """
    rng = np.random.default_rng(seed)
    # Always drawn, so that a wish changes nothing else about the order of draws.
    drawn = (_pick(rng, GENDERS), _pick(rng, AGES), _pick(rng, ORIGINS))
    who = (gender or drawn[0], age or drawn[1], origin or drawn[2])
    wardrobe = catalogue()
    years = float(rng.uniform(*YEARS[who[1]]))
    betas = _shape(rng, wardrobe, who[0], years, who[2])
    skin = _skin(rng, wardrobe, *who)
    tone = float(rng.uniform(*TONE_RANGE[who[2]]))
    hair_colour = _hair_colour(rng, who[1], who[2])
    eye_colour = _pick_weighted(rng, EYES_OF[who[2]])
    worn = (*_clothes(rng, wardrobe, who[0]), *_head(rng, wardrobe, *who))
    left, right = relaxed_hands(float(rng.uniform(0.7, 1.3)))
    return CastMember(*who, years, betas, skin.name, tone, eye_colour, hair_colour, worn, left, right)


def _pick(rng: np.random.Generator, options: Sequence[T]) -> T:
    return options[int(rng.integers(len(options)))]


def _pick_weighted(rng: np.random.Generator, weights: Mapping[str, float]) -> str:
    share = np.array(list(weights.values()))
    return list(weights)[int(rng.choice(len(share), p=share / share.sum()))]


def _shape(
    rng: np.random.Generator, wardrobe: Catalogue, gender: Gender, years: float, origin: Origin
) -> FloatArray:
    pure = {name: ORIGIN_IN_FACE * (name == origin) + (1 - ORIGIN_IN_FACE) / 3 for name in ORIGINS}
    x = np.array([1.0, float(gender == "male"), (years - 25) / 65, pure["african"], pure["asian"]])
    own = np.clip(rng.standard_normal(len(wardrobe.shape.matrix)), -SHAPE_LIMIT, SHAPE_LIMIT)
    betas = wardrobe.shape.matrix @ x + wardrobe.shape.deviation @ own
    mean, deviation = BODY_MASS_INDEX[gender]
    wanted = mean + deviation * float(np.clip(rng.standard_normal(), -SHAPE_LIMIT, SHAPE_LIMIT))
    betas[WEIGHT_AXIS] = _weight_beta(betas, wanted)
    rounded: FloatArray = np.round(betas, 4)
    return rounded


def body_mass_index(betas: FloatArray) -> float:
    """kg/m² of the embedded body."""
    body = BodyModel.embedded()
    return FLESH_DENSITY * body.volume(betas) / body.stature(betas) ** 2


def _weight_beta(betas: FloatArray, wanted: float) -> float:
    """The weight axis at which the body mass index is ``wanted``, or the nearer end of its range."""

    def excess(value: float) -> float:
        changed = betas.copy()
        changed[WEIGHT_AXIS] = value
        return body_mass_index(changed) - wanted

    low, high = WEIGHT_RANGE
    if excess(low) >= 0:
        return low
    if excess(high) <= 0:
        return high
    return float(scipy.optimize.brentq(excess, low, high, xtol=0.01))


def _skin(
    rng: np.random.Generator, wardrobe: Catalogue, gender: Gender, age: Age, origin: Origin
) -> SkinTexture:
    fitting = [s for s in wardrobe.skins if (s.gender, s.age, s.origin) == (gender, age, origin)]
    return _pick(rng, fitting)


def _hair_colour(rng: np.random.Generator, age: Age, origin: Origin) -> str:
    natural = _pick_weighted(rng, HAIR_OF[origin])
    grey, white = rng.random() < GREY_SHARE[age], rng.random() < 0.4
    if not grey:
        return natural
    return "white" if white and age == "old" else "grey"


def _clothes(rng: np.random.Generator, wardrobe: Catalogue, gender: Gender) -> tuple[Worn, ...]:
    """Bottom, shoes, top. The parts of a suit are worn together and only so."""
    if gender == "male" and rng.random() < 1 / 8:
        return tuple(Worn(name) for name in (SUIT[1], SUIT[2], SUIT[0]))
    slots = (
        wardrobe.of_slot("bottom", gender),
        wardrobe.of_slot("shoes", gender),
        wardrobe.of_slot("top", gender),
    )
    chosen = [_pick(rng, [i for i in items if i.name not in SUIT]) for items in slots]
    bottom, _, top = chosen
    if top.name in HIDDEN_BY.get(bottom.name, ()):
        chosen[0] = slots[0][(slots[0].index(bottom) + 1) % len(slots[0])]
    return tuple(_coloured(rng, item) for item in chosen)


def _coloured(rng: np.random.Generator, item: Item) -> Worn:
    """The item in one of its possible colours."""
    if item.colouring == "denim":
        return Worn(item.name, colour=_near(rng, _pick(rng, DENIM_COLOURS)))
    if item.colouring == "leather":
        return Worn(
            item.name,
            hue=rng.uniform(-0.04, 0.04),
            saturation=rng.uniform(0.3, 1.1),
            brightness=rng.uniform(0.7, 1.15),
        )
    if item.colouring == "cloth" and rng.random() < 0.5:
        return Worn(item.name, colour=_near(rng, _pick(rng, CLOTH_COLOURS)))
    if item.colouring in ("cloth", "pattern"):
        return Worn(
            item.name,
            hue=rng.uniform(0, 1),
            saturation=rng.uniform(0.35, 1.0),
            brightness=rng.uniform(0.8, 1.2),
        )
    return Worn(item.name)


def _near(rng: np.random.Generator, colour: Colour) -> Colour:
    r, g, b = np.clip(np.array(colour) * rng.uniform(0.88, 1.12) + rng.uniform(-0.015, 0.015, 3), 0, 1)
    return (float(r), float(g), float(b))


def _head(
    rng: np.random.Generator, wardrobe: Catalogue, gender: Gender, age: Age, origin: Origin
) -> tuple[Worn, ...]:
    """Hat or none, hair or none, brows, lashes."""
    heads = [i.name for i in wardrobe.of_slot("hair", gender)]
    hair = _pick_weighted(rng, {name: AFRO_SHARE[origin] if name == AFRO else 1.0 for name in heads})
    bald = rng.random() < NO_HAIR[gender][age]
    hat = _coloured(rng, _pick(rng, wardrobe.of_slot("hat", gender)))
    wears_hat = gender == "male" and rng.random() < HAT_SHARE
    brows = _pick(rng, wardrobe.of_slot("brows", gender)).name
    lashes = _pick(rng, wardrobe.of_slot("lashes", gender)).name
    if wears_hat and hair not in UNDER_HAT:
        hair = UNDER_HAT[heads.index(hair) % len(UNDER_HAT)]
    return (
        *(() if bald else (Worn(hair),)),
        *((hat,) if wears_hat else ()),
        Worn(brows),
        Worn(lashes),
    )
