"""Colours of people and clothes, and how to recolour a texture without spoiling it."""

from typing import Final

import numpy as np
import numpy.typing as npt

Pixels = npt.NDArray[np.float32]
Colour = tuple[float, float, float]

SKIN_TONES: Final = np.array(
    [
        (217, 178, 156),
        (209, 167, 141),
        (198, 152, 121),
        (180, 133, 102),
        (152, 108, 80),
        (122, 83, 60),
        (96, 65, 48),
        (77, 53, 42),
    ],
    dtype=np.float64,
)
"""Skin from the lightest to the darkest, sRGB 0..255, evenly spaced for the eye. These are colours of the
surface, not of a photograph: even the fairest skin returns at most two thirds of the red light."""

TONE_RANGE: Final = {"african": (0.55, 1.0), "asian": (0.1, 0.6), "caucasian": (0.0, 0.45)}
"""Part of the scale (0 lightest, 1 darkest) that people of an origin span; together they cover all of it."""

HAIR_COLOURS: Final[dict[str, Colour]] = {
    "black": (0.105, 0.092, 0.086),
    "dark brown": (0.175, 0.122, 0.093),
    "brown": (0.27, 0.18, 0.12),
    "light brown": (0.42, 0.30, 0.19),
    "auburn": (0.31, 0.16, 0.11),
    "red": (0.40, 0.21, 0.13),
    "dark blond": (0.53, 0.42, 0.28),
    "blond": (0.66, 0.54, 0.38),
    "grey": (0.38, 0.37, 0.36),
    "white": (0.52, 0.51, 0.49),
}
"""Colours of the surface, sRGB 0..1: what shines on hair comes on top."""

HAIR_CONTRAST: Final = {"grey": 1.25, "black": 1.3}
"""How much of the strands' own light and dark shows, where not 1: grey hair mixes light and dark ones."""

EYE_COLOURS: Final[dict[str, Colour]] = {
    "dark brown": (0.16, 0.09, 0.05),
    "brown": (0.30, 0.17, 0.08),
    "amber": (0.48, 0.31, 0.13),
    "hazel": (0.38, 0.32, 0.15),
    "green": (0.30, 0.40, 0.26),
    "grey": (0.42, 0.47, 0.50),
    "blue": (0.30, 0.40, 0.49),
}

CLOTH_COLOURS: Final[tuple[Colour, ...]] = (
    (0.93, 0.93, 0.91), (0.80, 0.79, 0.76), (0.55, 0.56, 0.58), (0.30, 0.31, 0.33), (0.12, 0.12, 0.13),
    (0.16, 0.20, 0.32), (0.20, 0.32, 0.55), (0.42, 0.57, 0.74), (0.24, 0.46, 0.50), (0.16, 0.33, 0.24),
    (0.36, 0.42, 0.25), (0.62, 0.62, 0.40), (0.84, 0.70, 0.35), (0.80, 0.48, 0.22), (0.66, 0.27, 0.20),
    (0.46, 0.14, 0.17), (0.72, 0.40, 0.46), (0.86, 0.68, 0.68), (0.45, 0.30, 0.48), (0.38, 0.27, 0.20),
    (0.60, 0.47, 0.35), (0.82, 0.74, 0.62),
)  # fmt: skip
"""Plain cloth, sRGB 0..1."""

DENIM_COLOURS: Final[tuple[Colour, ...]] = (
    (0.24, 0.34, 0.50), (0.16, 0.22, 0.36), (0.38, 0.50, 0.66), (0.12, 0.13, 0.16), (0.36, 0.37, 0.39),
    (0.62, 0.56, 0.45), (0.40, 0.36, 0.28), (0.80, 0.79, 0.76), (0.27, 0.30, 0.24),
)  # fmt: skip

_LUMA = np.array([0.299, 0.587, 0.114], dtype=np.float32)


def skin_tone(depth: float) -> npt.NDArray[np.float64]:
    """sRGB 0..255 at ``depth`` on the scale, 0 lightest to 1 darkest."""
    steps = np.linspace(0, 1, len(SKIN_TONES))
    return np.array([np.interp(depth, steps, SKIN_TONES[:, k]) for k in range(3)])


def to_tone(pixels: Pixels, median: npt.ArrayLike, target: npt.ArrayLike) -> Pixels:
    """Brings a skin of ``median`` colour to ``target``: a power a channel, so that black and white stay.

    Eyes, teeth and brows in the picture hardly change; lips and shadows follow.
    """
    start, goal = (np.clip(np.asarray(x, dtype=np.float64) / 255.0, 0.01, 0.99) for x in (median, target))
    power = (np.log(goal) / np.log(start)).astype(np.float32)
    toned: Pixels = 255.0 * np.power(pixels / 255.0, power)
    return toned


def luminance(pixels: Pixels) -> Pixels:
    """(H, W) 0..1 of sRGB pixels (H, W, 3) 0..255."""
    light: Pixels = (pixels[..., :3] @ _LUMA) / 255.0
    return light


def dye(
    pixels: Pixels,
    colour: Colour,
    contrast: float = 1.0,
    level: float | None = None,
    brightest: float = 6.0,
) -> Pixels:
    """Cloth or hair of one colour: keeps the folds and strands, gives up the hue.

    Args:
        pixels: (H, W, 3) sRGB 0..255.
        colour: sRGB 0..1 that the middle brightness becomes.
        contrast: how much of the picture's own light and dark stays.
        level: the brightness that counts as the middle; the median if None.
        brightest: lights count as no more than this many times the middle.
    """
    light = luminance(pixels)
    middle = float(np.median(light)) if level is None else level
    ratio = np.power(np.clip(light / max(middle, 0.02), 0.05, brightest), np.float32(contrast))
    return np.clip(ratio[..., None] * np.array(colour, dtype=np.float32) * 255.0, 0, 255)


def turn_hue(pixels: Pixels, turn: float, saturation: float, value: float) -> Pixels:
    """Rotates hues by ``turn`` (1 is the full circle), about the grey axis, and scales saturation and
    brightness."""
    angle = 2 * np.pi * turn
    cosine, sine = np.cos(angle), np.sin(angle)
    third = np.full((3, 3), 1 / 3)
    cross = np.array([[0, -1, 1], [1, 0, -1], [-1, 1, 0]]) / np.sqrt(3)
    rotation = cosine * np.eye(3) + (1 - cosine) * third + sine * cross
    matrix = third + saturation * (rotation - third)
    turned: Pixels = np.clip(pixels @ (value * matrix).T.astype(np.float32), 0, 255)
    return turned
