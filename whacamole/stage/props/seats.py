"""What one sits on: sofas, armchairs, chairs, stools, benches."""

import numpy as np

from whacamole.stage.props.pieces import box_part, cushion, legs, rod
from whacamole.stage.props.prop import Part, Prop, drawn, fitted
from whacamole.stage.shapes import Solid, cylinder

__all__ = ["armchair", "chair", "pouf", "sofa"]

SEAT = 0.44
"""Height of a seat [m]."""


def sofa(rng: np.random.Generator) -> Prop:
    """Two or three seats between arms, with cushions in the corners."""
    seats = int(rng.integers(2, 4))
    return _upholstered("sofa", seats, float(rng.uniform(0.62, 0.72)), rng, pillows=int(rng.integers(1, 4)))


def armchair(rng: np.random.Generator) -> Prop:
    """One seat between arms."""
    return _upholstered("armchair", 1, float(rng.uniform(0.56, 0.66)), rng, pillows=int(rng.integers(0, 2)))


def _upholstered(name: str, seats: int, seat: float, rng: np.random.Generator, pillows: int) -> Prop:
    depth, height, arm, foot, soft = drawn(
        rng, (0.82, 0.95), (0.74, 0.88), (0.12, 0.22), (0.06, 0.14), (0.03, 0.07)
    )
    width, back = seats * seat + 2 * arm, 0.2
    front, rear = -depth / 2, depth / 2
    inner = depth - back
    body: list[Solid] = [cushion((0.0, 0.0, foot), (width - 0.02, depth - 0.02, 0.29 - foot), 0.03)]
    for side in (-1.0, 1.0):
        middle = (side * (width - arm) / 2, 0.0, foot)
        body.append(cushion(middle, (arm, depth, float(rng.uniform(0.56, 0.6)) - foot), min(soft, arm / 2.2)))
    body.append(cushion((0.0, rear - back / 2, foot), (width - 2 * arm, back, height - foot), soft, 0.0))
    for index in range(seats):
        x = (index - (seats - 1) / 2) * seat
        body.append(
            cushion((x, front + inner / 2 + 0.005, 0.27), (seat - 0.008, inner, SEAT - 0.26), 0.05, 0.12)
        )
        body.append(
            cushion(
                (x, rear - back - 0.03, SEAT - 0.02),
                (seat - 0.02, 0.17, height - SEAT + 0.01),
                0.06,
                0.25,
                0.14,
            )
        )
    parts = [Part(solid, "fabric", smooth=True) for solid in body]
    for index in range(pillows):
        side = -1.0 if index % 2 == 0 else 1.0
        x = side * ((width - 2 * arm) / 2 - 0.22 - 0.3 * (index // 2))
        size = (float(rng.uniform(0.4, 0.48)), 0.16, float(rng.uniform(0.38, 0.44)))
        parts.append(
            Part(
                cushion((x, front + inner - 0.26, SEAT - 0.01), size, 0.06, 0.75, 0.3), "accent", smooth=True
            )
        )
    parts += [Part(leg, "wood") for leg in legs(width - 0.06, depth - 0.06, foot + 0.02, 0.022)]
    return fitted(name, parts)


def chair(rng: np.random.Generator) -> Prop:
    """A dining chair: four legs, a seat, a back of slats or a board."""
    width, depth, height = drawn(rng, (0.42, 0.47), (0.44, 0.5), (0.82, 0.94))
    half, rear = width / 2, depth / 2
    parts = [
        Part(cushion((0.0, -0.01, SEAT - 0.025), (width, depth - 0.04, 0.045), 0.02), "seat", smooth=True)
    ]
    for side in (-1.0, 1.0):
        x = side * (half - 0.025)
        parts.append(Part(rod((x, -rear + 0.03, 0.0), (x * 0.94, -rear + 0.06, SEAT), 0.017), "wood"))
        parts.append(Part(rod((x, rear - 0.02, 0.0), (x * 0.96, rear - 0.06, SEAT), 0.018), "wood"))
        parts.append(Part(rod((x * 0.96, rear - 0.06, SEAT - 0.03), (x * 0.96, rear, height), 0.016), "wood"))
    inner = half - 0.03
    if rng.random() < 0.5:
        heights = np.linspace(0.62, height - 0.06, int(rng.integers(2, 4)))
        slats = [
            (-inner, rear - 0.035 + 0.05 * (z - 0.62), z, inner, rear - 0.02 + 0.05 * (z - 0.62), z + 0.05)
            for z in heights
        ]
        parts.append(box_part("wood", *slats))
    else:
        parts.append(
            Part(
                cushion((0.0, rear - 0.03, height - 0.3), (2 * inner, 0.035, 0.3), 0.017, 0.0, 0.08),
                "seat",
                smooth=True,
            )
        )
    return fitted("chair", parts)


def pouf(rng: np.random.Generator) -> Prop:
    """A round upholstered stool without legs."""
    radius, height = drawn(rng, (0.22, 0.32), (0.36, 0.44))
    size = (2 * radius, 2 * radius, height - 0.03)
    return fitted(
        "pouf",
        [
            Part(cushion((0.0, 0.0, 0.03), size, radius * 0.9, 0.0), "accent", smooth=True),
            Part(cylinder((0.0, 0.0, 0.0), radius * 0.8, 0.06), "dark"),
        ],
    )
