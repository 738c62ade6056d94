"""What stands in a warehouse: pallets, crates of boards, cartons, barrels, racks, columns."""

import itertools

import numpy as np

from whacamole.stage.props.pieces import box_part, rod
from whacamole.stage.props.prop import Part, Prop, drawn, fitted
from whacamole.stage.shapes import Solid, bevelled_box, boxes, joined, lathe, moved, turned

__all__ = ["barrels", "cartons", "column", "cone", "crates", "pallet_rack", "pallets", "trolley"]

PALLET = (1.2, 0.8, 0.144)
"""Length, depth and height of a pallet [m]."""

Corners = tuple[float, float, float, float, float, float]


def _pallet(z: float = 0.0) -> Solid:
    """Return a pallet: nine blocks, boards below, boards across, slats on top."""
    x, y = PALLET[0] / 2, PALLET[1] / 2
    blocks = [
        (a - 0.05, b - 0.05, 0.022, a + 0.05, b + 0.05, 0.1)
        for a in (-x + 0.05, 0.0, x - 0.05)
        for b in (-y + 0.05, 0.0, y - 0.05)
    ]
    low = [(-x, b - 0.05, 0.0, x, b + 0.05, 0.022) for b in (-y + 0.05, 0.0, y - 0.05)]
    across = [(a - 0.05, -y, 0.1, a + 0.05, y, 0.122) for a in (-x + 0.05, 0.0, x - 0.05)]
    slats = [
        (-x, float(b) - 0.055, 0.122, x, float(b) + 0.055, 0.144)
        for b in np.linspace(-y + 0.055, y - 0.055, 5)
    ]
    corners = np.asarray([*blocks, *low, *across, *slats]) + np.array([0, 0, z, 0, 0, z])
    return boxes(corners[:, :3], corners[:, 3:])


def pallets(rng: np.random.Generator) -> Prop:
    """A stack of empty pallets, none quite straight."""
    count = int(rng.integers(3, 11))
    stack = [
        turned(
            _pallet(),
            (float(rng.normal(0, 0.012)), float(rng.normal(0, 0.012)), k * PALLET[2]),
            float(rng.normal(0, 0.02)),
        )
        for k in range(count)
    ]
    return fitted("pallets", [Part(joined(stack), "timber")])


def _cartons(rng: np.random.Generator, width: float, depth: float, tallest: float) -> Solid:
    """Return layers of cartons on a rectangle, up to a height; the top layer is not full."""
    nx, ny = int(rng.integers(2, 4)), int(rng.integers(1, 3))
    high = float(rng.uniform(0.24, 0.42))
    layers = max(1, int(min(tallest, float(rng.uniform(0.5, 1.4))) / high))
    sx, sy = width / nx, depth / ny
    low = [
        (-width / 2 + i * sx, -depth / 2 + j * sy, k * high)
        for k in range(layers)
        for i in range(nx)
        for j in range(ny)
        if k < layers - 1 or k == 0 or rng.random() < 0.7
    ]
    corners = (
        np.asarray(low)
        + 0.004
        + np.column_stack([rng.uniform(0, 0.006, (len(low), 2)), np.full(len(low), -0.004)])
    )
    return boxes(corners, corners + np.array([sx - 0.014, sy - 0.014, high - 0.002]))


def cartons(rng: np.random.Generator) -> Prop:
    """A pallet of cartons."""
    load = moved(_cartons(rng, 1.16, 0.76, 1.5), (0.0, 0.0, PALLET[2]))
    return fitted("cartons", [Part(_pallet(), "timber"), Part(load, "cardboard")])


def _crate(size: tuple[float, float, float]) -> list[Corners]:
    """Boards with gaps on four sides and the top, battens at the corners and round the edges."""
    x, y, h = size[0] / 2, size[1] / 2, size[2]
    rows = max(3, round(h / 0.13))
    tall = (h - 0.04) / rows
    found: list[Corners] = [(-x + 0.03, -y + 0.03, 0.02, x - 0.03, y - 0.03, h - 0.02)]
    for k in range(rows):
        z0, z1 = 0.02 + k * tall + 0.004, 0.02 + (k + 1) * tall - 0.004
        found += [
            (-x + 0.018, -y + 0.018, z0, x - 0.018, -y + 0.034, z1),
            (-x + 0.018, y - 0.034, z0, x - 0.018, y - 0.018, z1),
            (-x + 0.018, -y + 0.034, z0, -x + 0.034, y - 0.034, z1),
            (x - 0.034, -y + 0.034, z0, x - 0.018, y - 0.034, z1),
        ]
    for sx in (-1, 1):
        for sy in (-1, 1):
            a, b = sorted((sx * x, sx * (x - 0.09)))
            c, d = sorted((sy * y, sy * (y - 0.018)))
            e, f = sorted((sx * x, sx * (x - 0.018)))
            g, i = sorted((sy * (y - 0.018), sy * (y - 0.09)))
            found += [(a, c, 0.0, b, d, h), (e, g, 0.0, f, i, h)]
    for z in (0.0, h - 0.09):
        found += [
            (-x + 0.09, -y, z, x - 0.09, -y + 0.018, z + 0.09),
            (-x + 0.09, y - 0.018, z, x - 0.09, y, z + 0.09),
        ]
    slats = np.linspace(-y + 0.01, y - 0.01, max(3, round(2 * y / 0.14)) + 1)
    found += [
        (-x + 0.018, float(a) + 0.004, h - 0.018, x - 0.018, float(b) - 0.004, h)
        for a, b in itertools.pairwise(slats)
    ]
    return found


def crates(rng: np.random.Generator) -> Prop:
    """One crate of boards, or two or three stacked."""
    parts, z = [], 0.0
    width, depth = drawn(rng, (0.7, 1.2), (0.6, 0.9))
    for _ in range(int(rng.integers(1, 4))):
        high = float(rng.uniform(0.45, 0.75))
        corners = np.asarray(_crate((width, depth, high)))
        solid = boxes(corners[:, :3], corners[:, 3:])
        parts.append(Part(turned(solid, (0.0, 0.0, z), float(rng.normal(0.0, 0.04))), "timber"))
        z, width, depth = (
            z + high,
            width * float(rng.uniform(0.75, 1.0)),
            depth * float(rng.uniform(0.75, 1.0)),
        )
    return fitted("crates", parts)


def barrels(rng: np.random.Generator) -> Prop:
    """One to four steel drums, with two hoops and a rim each."""
    r, h = 0.29, 0.88
    profile = [
        (r - 0.012, 0.0),
        (r, 0.008),
        (r - 0.008, 0.02),
        (r - 0.008, 0.28),
        (r + 0.008, 0.295),
        (r - 0.008, 0.31),
        (r - 0.008, 0.57),
        (r + 0.008, 0.585),
        (r - 0.008, 0.6),
        (r - 0.008, h - 0.02),
        (r, h - 0.008),
        (r - 0.012, h),
        (r - 0.02, h - 0.015),
    ]
    count = int(rng.integers(1, 5))
    spots = [(0.0, 0.0), (0.62, 0.0), (0.31, 0.54), (0.93, 0.54)][:count]
    drum = lathe(profile, 28)
    parts = [
        Part(moved(drum, (a, b, 0.0)), ("drum", "drum-other")[int(rng.random() < 0.25)]) for a, b in spots
    ]
    bungs = [moved(lathe([(0.03, 0.0), (0.03, 0.012)], 10), (a + 0.16, b - 0.1, h - 0.016)) for a, b in spots]
    return fitted("barrels", [*parts, Part(joined(bungs), "metal")])


def pallet_rack(rng: np.random.Generator) -> Prop:
    """Two to four bays of beams between uprights, with loads on their pallets."""
    bays, levels = int(rng.integers(1, 4)), int(rng.integers(2, 4))
    bay, depth, rise = 2.7, 1.05, float(rng.uniform(1.35, 1.6))
    height, x, y = rise * levels + 0.5, bays * bay / 2, depth / 2
    parts, posts, braces, loads, wood = [], [], [], [], []
    for k in range(bays + 1):
        at = -x + k * bay
        posts += [
            (at - 0.045, s * (y - 0.04) - 0.04, 0.0, at + 0.045, s * (y - 0.04) + 0.04, height)
            for s in (-1, 1)
        ]
        zigzag = np.arange(0.2, height - 0.2, 0.6)
        braces += [
            rod(
                (at, (-1) ** n * (y - 0.06), float(z)),
                (at, -((-1) ** n) * (y - 0.06), float(z) + 0.55),
                0.014,
                6,
            )
            for n, z in enumerate(zigzag)
            if z + 0.55 < height
        ]
    beams = [
        (
            -x + k * bay + 0.045,
            s * (y - 0.03) - 0.025,
            rise * (n + 1) - 0.11,
            -x + (k + 1) * bay - 0.045,
            s * (y - 0.03) + 0.025,
            rise * (n + 1),
        )
        for k in range(bays)
        for n in range(levels)
        for s in (-1, 1)
    ]
    for k in range(bays):
        for n in range(levels + 1):
            for slot in (-0.65, 0.65):
                if rng.random() < 0.8:
                    across, z = -x + (k + 0.5) * bay + slot + float(rng.normal(0.0, 0.03)), rise * n
                    wood.append(moved(_pallet(), (across, 0.0, z)))
                    load = _cartons(rng, 1.14, 0.76, rise - 0.4)
                    loads.append(moved(load, (across, 0.0, z + PALLET[2])))
    parts += [box_part("upright", *posts), Part(joined(braces), "upright"), box_part("beam", *beams)]
    if wood:
        parts += [Part(joined(wood), "timber"), Part(joined(loads), "cardboard")]
    return fitted("pallet-rack", parts)


def column(height: float) -> Prop:
    """A steel column of wide flanges on a foot plate, a guard in yellow and black around it."""
    h = 0.12
    steel = [
        (-h, -h, 0.0, h, -h + 0.015, height),
        (-h, h - 0.015, 0.0, h, h, height),
        (-0.006, -h, 0.0, 0.006, h, height),
        (-0.18, -0.18, 0.0, 0.18, 0.18, 0.02),
    ]
    parts = [box_part("steel", *steel)]
    for k in range(8):
        z = 0.02 + 0.14 * k
        parts.append(
            box_part(
                "yellow" if k % 2 == 0 else "black", (-h - 0.02, -h - 0.02, z, h + 0.02, h + 0.02, z + 0.14)
            )
        )
    return fitted("column", parts)


def cone(rng: np.random.Generator) -> Prop:
    """A traffic cone with a white band."""
    high = float(rng.uniform(0.45, 0.72))
    r = 0.3 * high
    radius = [r, 0.7 * r, 0.42 * r, 0.12 * r]
    z = [0.025, 0.35 * high, 0.65 * high, high]
    parts = [Part(bevelled_box((2.6 * r, 2.6 * r, 0.025), 0.005), "orange")]
    for k, finish in enumerate(("orange", "white", "orange")):
        parts.append(Part(lathe([(radius[k], z[k]), (radius[k + 1], z[k + 1])], 20), finish))
    return fitted("cone", parts)


def trolley(rng: np.random.Generator) -> Prop:
    """A flat trolley with a push bar, and what is on it."""
    x, y = 0.55, 0.33
    parts = [box_part("steel", (-x, -y, 0.18, x, y, 0.22))]
    wheels = [
        rod(
            (sx * (x - 0.12), sy * (y - 0.05) - 0.02, 0.08),
            (sx * (x - 0.12), sy * (y - 0.05) + 0.02, 0.08),
            0.08,
            14,
        )
        for sx in (-1, 1)
        for sy in (-1, 1)
    ]
    bar = [rod((-x + 0.03, s * (y - 0.05), 0.2), (-x - 0.06, s * (y - 0.05), 0.95), 0.016) for s in (-1, 1)]
    bar.append(rod((-x - 0.06, -y + 0.05, 0.95), (-x - 0.06, y - 0.05, 0.95), 0.016))
    parts += [Part(joined(wheels), "black"), Part(joined(bar), "beam")]
    parts.append(Part(moved(_cartons(rng, 0.9, 0.56, 0.7), (0.06, 0.0, 0.22)), "cardboard"))
    return fitted("trolley", parts)
