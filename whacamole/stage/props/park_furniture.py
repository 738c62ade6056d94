"""What stands in parks: benches, bins, lamp posts, fences."""

import numpy as np

from whacamole.stage.props.prop import Part, Prop, fitted
from whacamole.stage.shapes import Solid, box, joined, lathe, moved, tilted

__all__ = ["bench", "bin_", "fence", "lamp_post"]

SEAT = 0.45
"""Height of a seat [m]."""

SLATS = (5, 3)
"""Of a seat and of a back."""

RECLINE = 0.22
"""How far a back leans [rad]."""

FENCE_LENGTH = (4.0, 9.0)
"""[m]"""


def bench(rng: np.random.Generator) -> Prop:
    """Slats of wood on cast frames, with arm rests."""
    width = float(rng.uniform(1.4, 1.9))
    slats = [box((0.0, -0.2 + 0.1 * index, SEAT - 0.03), (width, 0.085, 0.03)) for index in range(SLATS[0])]
    back = [box((0.0, 0.24, SEAT + 0.1 + 0.13 * index), (width, 0.028, 0.09)) for index in range(SLATS[1])]
    wood = joined([*slats, *(_reclined(slat) for slat in back)])
    frames = joined([moved(_frame(), (side * (width / 2 - 0.16), 0.0, 0.0)) for side in (-1.0, 1.0)])
    return fitted("bench", [Part(*piece) for piece in [(wood, "planks"), (frames, "iron")]])


def _reclined(solid: Solid) -> Solid:
    return tilted(solid, (-RECLINE, 0.0, 0.0), (0.0, 0.24, SEAT))


def _frame() -> Solid:
    """Legs, a bearer under the seat, a back post and an arm rest, in one plane."""
    thick = 0.045
    front = box((0.0, -0.2, 0.0), (thick, thick, SEAT - 0.03))
    rear = box((0.0, 0.2, 0.0), (thick, thick, SEAT - 0.03))
    bearer = box((0.0, 0.0, SEAT - 0.075), (thick, 0.48, 0.045))
    post = _reclined(box((0.0, 0.265, SEAT - 0.05), (thick, 0.03, 0.5)))
    rest = box((0.0, -0.02, SEAT + 0.2), (thick, 0.5, 0.03))
    stay = box((0.0, -0.22, SEAT - 0.03), (thick, 0.035, 0.24))
    return joined([front, rear, bearer, post, rest, stay])


def bin_(rng: np.random.Generator) -> Prop:
    """A litter bin: a barrel of slats or of sheet under a lid."""
    radius, height = float(rng.uniform(0.2, 0.26)), float(rng.uniform(0.7, 0.85))
    lid = lathe([(radius + 0.02, height), (radius + 0.02, height + 0.03), (0.4 * radius, height + 0.09)], 18)
    if rng.random() < 0.5:
        barrel = lathe([(0.85 * radius, 0.03), (radius, height - 0.12), (0.93 * radius, height - 0.1)], 18)
        return fitted(
            "bin",
            [Part(*piece) for piece in [(barrel, "iron"), (_feet(radius, height), "iron"), (lid, "iron")]],
        )
    angles = np.arange(14) * (2.0 * np.pi / 14)
    x, y = radius * np.cos(angles), radius * np.sin(angles)
    slats = [
        box((float(a), float(b), 0.06), (0.02, 0.075, height - 0.2), float(turn))
        for a, b, turn in zip(x, y, angles, strict=True)
    ]
    inside = lathe([(0.9 * radius, 0.05), (0.9 * radius, height - 0.16)], 14)
    return fitted(
        "bin",
        [
            Part(*piece)
            for piece in [
                (joined(slats), "planks"),
                (inside, "iron"),
                (_feet(radius, height), "iron"),
                (lid, "iron"),
            ]
        ],
    )


def _feet(radius: float, height: float) -> Solid:
    """Three posts that carry barrel and lid."""
    angles = np.arange(3) * (2.0 * np.pi / 3.0)
    x, y = 0.8 * radius * np.cos(angles), 0.8 * radius * np.sin(angles)
    return joined([box((float(a), float(b), 0.0), (0.03, 0.03, height)) for a, b in zip(x, y, strict=True)])


def lamp_post(rng: np.random.Generator) -> Prop:
    """A lantern on a cast post, unlit by day."""
    height = float(rng.uniform(3.2, 4.0))
    post = lathe(
        [
            (0.13, 0.0),
            (0.13, 0.12),
            (0.09, 0.2),
            (0.085, 0.7),
            (0.06, 0.78),
            (0.045, height),
            (0.09, height + 0.03),
        ],
        12,
    )
    glass = lathe([(0.09, height + 0.03), (0.16, height + 0.38)], 6)
    cap = lathe(
        [(0.19, height + 0.38), (0.19, height + 0.4), (0.06, height + 0.52), (0.02, height + 0.6)], 12
    )
    return fitted(
        "lamp-post", [Part(*piece) for piece in [(post, "iron"), (glass, "lantern"), (cap, "iron")]]
    )


def fence(rng: np.random.Generator) -> Prop:
    """Posts a metre and a half apart with three rails, or with two rails and pickets."""
    length = float(rng.uniform(*FENCE_LENGTH))
    spots = np.linspace(-length / 2 + 0.05, length / 2 - 0.05, max(2, round(length / 1.5)))
    posts = [box((float(x), 0.0, 0.0), (0.1, 0.1, 1.05)) for x in spots]
    if rng.random() < 0.5:
        rails = [box((0.0, 0.0, z), (length, 0.035, 0.11)) for z in (0.2, 0.5, 0.8)]
        return fitted("fence", [Part(*piece) for piece in [(joined([*posts, *rails]), "planks")]])
    rails = [box((0.0, 0.0, z), (length, 0.035, 0.07)) for z in (0.22, 0.72)]
    pickets = [
        box((float(x), -0.03, 0.06), (0.07, 0.022, 0.86))
        for x in np.arange(-length / 2 + 0.06, length / 2 - 0.05, 0.14)
    ]
    return fitted("fence", [Part(*piece) for piece in [(joined([*posts, *rails, *pickets]), "planks")]])
