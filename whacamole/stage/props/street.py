"""What stands in streets and on squares."""

from typing import Final

import numpy as np

from whacamole.stage.props.plants import potted, shrub_in
from whacamole.stage.props.prop import Part, Prop, PropMaker, drawn, fitted
from whacamole.stage.shapes import bevelled_box, box, boxes, cylinder, joined, lathe, moved, tilted

__all__ = ["STREET", "YARD", "fountain", "lamp_post", "lantern_parts"]

SEAT = 0.45
"""Height of a bench's seat [m]."""

LAMP_HEIGHT = (3.6, 4.4)
"""Of the foot of a lantern over the street [m]."""


def _bench(rng: np.random.Generator) -> Prop:
    """Slats on two cast legs, on most a back that leans."""
    (width,) = drawn(rng, (1.5, 2.0))
    aside = width / 2 - 0.25
    y = np.linspace(-0.2, 0.16, 5)
    seat = boxes(
        np.column_stack([0 * y - width / 2, y, 0 * y + SEAT - 0.035]),
        np.column_stack([0 * y + width / 2, y + 0.07, 0 * y + SEAT]),
    )
    legs = []
    for x in (-aside, aside):
        legs += [
            box((x, -0.17, 0.0), (0.06, 0.06, SEAT - 0.035)),
            box((x, 0.19, 0.0), (0.06, 0.06, SEAT - 0.035)),
            box((x, 0.01, SEAT - 0.09), (0.06, 0.42, 0.055)),
        ]
    parts = [Part(seat, "planks"), Part(joined(legs), "metal")]
    if rng.random() < 0.7:
        z = SEAT + np.array([0.12, 0.24, 0.36])
        back = boxes(
            np.column_stack([0 * z - width / 2, 0 * z + 0.23, z]),
            np.column_stack([0 * z + width / 2, 0 * z + 0.26, z + 0.08]),
        )
        posts = joined([box((x, 0.28, SEAT - 0.1), (0.05, 0.04, 0.56)) for x in (-aside, aside)])
        lean = ((-0.18, 0.0, 0.0), (0.0, 0.25, SEAT))
        parts += [Part(tilted(back, *lean), "planks"), Part(tilted(posts, *lean), "metal")]
    return fitted("bench", parts)


def _bin(rng: np.random.Generator) -> Prop:
    """A litter bin: a can behind upright slats, with a lid on legs."""
    height, radius = drawn(rng, (0.75, 0.95), (0.2, 0.26))
    turn = np.arange(14) * (2 * np.pi / 14)
    slats = [
        box((radius * np.cos(a), radius * np.sin(a), 0.08), (0.02, 0.075, height - 0.18), a) for a in turn
    ]
    can = cylinder((0.0, 0.0, 0.0), radius - 0.03, height - 0.12, 16)
    lid = moved(lathe([(radius + 0.02, 0.0), (radius + 0.02, 0.03), (0.08, 0.1)], 16), (0.0, 0.0, height))
    stays = boxes(
        np.array([[radius - 0.05, -0.02, height - 0.12], [-radius, -0.02, height - 0.12]]),
        np.array([[radius, 0.02, height], [0.05 - radius, 0.02, height]]),
    )
    slat_finish = str(rng.choice(["planks", "paint"]))
    return fitted("bin", [Part(joined(slats), slat_finish), Part(joined([can, lid, stays]), "metal")])


def _bollards(rng: np.random.Generator) -> Prop:
    """A few bollards in a row."""
    count, (gap, height, radius) = int(rng.integers(1, 5)), drawn(rng, (1.2, 1.6), (0.8, 1.0), (0.05, 0.08))
    profile = [
        (1.4 * radius, 0.0),
        (1.4 * radius, 0.08),
        (radius, 0.12),
        (radius, height - 0.16),
        (1.25 * radius, height - 0.14),
        (1.25 * radius, height - 0.1),
        (0.4 * radius, height),
    ]
    post = lathe(profile, 12)
    row = joined([moved(post, (gap * index, 0.0, 0.0)) for index in range(count)])
    return fitted("bollards", [Part(row, str(rng.choice(["metal", "stone"])))])


def _planter(rng: np.random.Generator) -> Prop:
    """A trough of stone, boards or clay with shrubs in it."""
    width, depth, height = drawn(rng, (0.7, 1.8), (0.5, 0.7), (0.4, 0.6))
    trough = bevelled_box((width, depth, height), 0.02)
    rim = moved(bevelled_box((width + 0.06, depth + 0.06, 0.06), 0.01), (0.0, 0.0, height - 0.05))
    parts = [Part(joined([trough, rim]), str(rng.choice(["stone", "planks", "terracotta"])))]
    count = max(1, round(width / 0.55))
    for x in (np.arange(count) + 0.5) * width / count - width / 2:
        tall = float(rng.uniform(0.4, 0.8))
        shrub = shrub_in(rng, (float(x), 0.0, height), 0.3, tall)
        parts += [Part(solid, finish) for solid, finish in shrub]
    return fitted("planter", parts)


def _bicycle_stand(rng: np.random.Generator) -> Prop:
    """Hoops of tube side by side."""
    count, tube = int(rng.integers(3, 7)), 0.05
    x = 0.8 * np.arange(count)
    sides = []
    for y0, y1, z0, z1 in (
        (-0.4, tube - 0.4, 0.0, 0.8),
        (0.4 - tube, 0.4, 0.0, 0.8),
        (-0.4, 0.4, 0.8 - tube, 0.8),
    ):
        low = np.column_stack([x, 0 * x + y0, 0 * x + z0])
        sides.append(boxes(low, np.column_stack([x + tube, 0 * x + y1, 0 * x + z1])))
    return fitted("bicycle-stand", [Part(joined(sides), "steel")])


def _sign(rng: np.random.Generator) -> Prop:
    """A traffic sign: a round or square plate on a pole."""
    (height,) = drawn(rng, (2.3, 2.7))
    pole = cylinder((0.0, 0.0, 0.0), 0.03, height, 10)
    if rng.random() < 0.6:
        disc = tilted(cylinder((0.0, 0.0, 0.0), 0.3, 0.02, 28), (np.pi / 2, 0.0, 0.0))
        inner = tilted(cylinder((0.0, 0.0, 0.0), 0.21, 0.012, 28), (np.pi / 2, 0.0, 0.0))
        rim = str(rng.choice(["sign-red", "sign-blue"]))
        plates = [
            Part(moved(disc, (0.0, -0.035, height - 0.32)), rim),
            Part(moved(inner, (0.0, -0.05, height - 0.32)), "sign-white"),
        ]
    else:
        plates = [
            Part(box((0.0, -0.045, height - 0.6), (0.6, 0.02, 0.6)), "sign-blue"),
            Part(box((-0.1, -0.058, height - 0.5), (0.09, 0.006, 0.4)), "sign-white"),
            Part(box((0.03, -0.058, height - 0.28), (0.2, 0.006, 0.18)), "sign-white"),
        ]
    return fitted("sign", [Part(pole, "steel"), *plates])


def _low_wall(rng: np.random.Generator) -> Prop:
    """A wall of brick or stone under a coping."""
    length, height, depth = drawn(rng, (1.8, 3.4), (0.5, 1.1), (0.24, 0.4))
    wall = box((0.0, 0.0, 0.0), (length, depth, height))
    coping = moved(bevelled_box((length + 0.06, depth + 0.08, 0.08), 0.012), (0.0, 0.0, height))
    return fitted("low-wall", [Part(wall, str(rng.choice(["brick", "stone"]))), Part(coping, "stone")])


def _advertising_column(rng: np.random.Generator) -> Prop:
    """A round column for posters, with a foot and a roof."""
    (height,) = drawn(rng, (2.6, 3.2))
    body = moved(lathe([(0.55, 0.0), (0.55, height - 0.5)], 24), (0.0, 0.0, 0.25))
    foot = lathe([(0.62, 0.0), (0.62, 0.2), (0.56, 0.26)], 24)
    roof = moved(lathe([(0.66, 0.0), (0.66, 0.06), (0.3, 0.28), (0.05, 0.36)], 24), (0.0, 0.0, height - 0.25))
    return fitted("advertising-column", [Part(body, "posters"), Part(joined([foot, roof]), "paint")])


def lantern_parts(height: float) -> tuple[Part, Part, Part]:
    """A post, the cage and roof of the lantern on it ``height`` metres up, and the lamp in that."""
    profile = [
        (0.13, 0.0),
        (0.13, 0.35),
        (0.075, 0.5),
        (0.06, 1.2),
        (0.045, height - 0.1),
        (0.09, height - 0.04),
        (0.09, height),
    ]
    post = lathe(profile, 14)
    bars = joined([box((x, y, height), (0.02, 0.02, 0.42)) for x in (-0.11, 0.11) for y in (-0.11, 0.11)])
    roof = moved(lathe([(0.23, 0.0), (0.2, 0.05), (0.06, 0.18), (0.02, 0.26)], 14), (0.0, 0.0, height + 0.4))
    lamp = cylinder((0.0, 0.0, height + 0.26), 0.08, 0.14, 12)
    return Part(post, "metal"), Part(joined([bars, roof]), "metal"), Part(lamp, "lamp")


def lamp_post(rng: np.random.Generator) -> Prop:
    """A lantern on a post of cast iron."""
    return fitted("lamp-post", lantern_parts(drawn(rng, LAMP_HEIGHT)[0]))


def fountain(rng: np.random.Generator) -> Prop:
    """A round basin with water, a bowl on a shaft in its middle."""
    radius, rim = drawn(rng, (1.2, 1.7), (0.45, 0.6))
    wall = lathe(
        [
            (radius + 0.1, 0.0),
            (radius + 0.1, 0.12),
            (radius, 0.14),
            (radius, rim - 0.08),
            (radius + 0.08, rim - 0.06),
            (radius + 0.08, rim),
            (radius - 0.16, rim),
            (radius - 0.16, rim - 0.12),
        ],
        28,
    )
    water = cylinder((0.0, 0.0, rim - 0.14), radius - 0.14, 0.03, 28)
    shaft = lathe(
        [
            (0.3, rim - 0.1),
            (0.26, rim),
            (0.13, rim + 0.15),
            (0.16, rim + 0.5),
            (0.55, rim + 0.75),
            (0.58, rim + 0.82),
            (0.2, rim + 0.8),
            (0.09, rim + 1.0),
            (0.13, rim + 1.25),
            (0.03, rim + 1.4),
        ],
        20,
    )
    return fitted("fountain", [Part(joined([wall, shaft]), "stone"), Part(water, "water")])


STREET: Final[tuple[PropMaker, ...]] = (
    _bench,
    _bench,
    _bin,
    _bollards,
    _planter,
    _planter,
    _bicycle_stand,
    _sign,
    _low_wall,
    _advertising_column,
    lamp_post,
    lamp_post,
)


def _dustbin(rng: np.random.Generator) -> Prop:
    """A wheeled bin as stands in yards: wider above, with a lid."""
    (height,) = drawn(rng, (0.95, 1.1))
    body = tilted(lathe([(0.33, 0.0), (0.4, height)], 4), (0.0, 0.0, np.pi / 4))
    lid = moved(bevelled_box((0.6, 0.64, 0.08), 0.03), (0.0, -0.02, height))
    grip = box((0.0, 0.31, height - 0.04), (0.5, 0.04, 0.05))
    finish = str(rng.choice(["bin-green", "bin-grey", "bin-blue"]))
    return fitted("dustbin", [Part(joined([body, lid, grip]), finish)])


YARD: Final[tuple[PropMaker, ...]] = (
    _bench,
    _dustbin,
    _dustbin,
    _dustbin,
    potted,
    potted,
    _planter,
    _bicycle_stand,
    _low_wall,
)
