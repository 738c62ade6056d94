"""What stands in a sports hall: wall bars, benches, mats, vaulting boxes, goals, hoops."""

import itertools

import numpy as np

from whacamole.stage.props.pieces import box_part, cushion, rod
from whacamole.stage.props.prop import Part, Prop, fitted
from whacamole.stage.shapes import Solid, Vector, bevelled_box, boxes, joined, lathe, moved, tilted

__all__ = ["ball_cage", "goal", "gym_bench", "hoop", "mats", "vaulting_box", "wall_bars"]

RING = 3.05
"""Height of a basketball ring [m]."""


def wall_bars(rng: np.random.Generator) -> Prop:
    """Two to five bays of round bars between uprights."""
    bays, bay, height, depth = int(rng.integers(2, 6)), 0.9, float(rng.uniform(2.4, 2.6)), 0.14
    x = bays * bay / 2
    uprights = [
        (-x + k * bay - 0.02, -depth / 2, 0.0, -x + k * bay + 0.02, depth / 2, height)
        for k in range(bays + 1)
    ]
    bars: list[Solid] = [
        rod((-x, -0.01, z), (x, -0.01, z), 0.018) for z in np.arange(0.12, height - 0.15, 0.15)
    ]
    bars.append(rod((-x, -0.05, height - 0.05), (x, -0.05, height - 0.05), 0.018))
    return fitted("wall-bars", [box_part("wood", *uprights), Part(joined(bars), "wood", smooth=True)])


def gym_bench(rng: np.random.Generator) -> Prop:
    """A long low bench on feet, a beam below."""
    width = float(rng.uniform(2.4, 3.6))
    x = width / 2
    seat = moved(bevelled_box((width, 0.24, 0.035), 0.008), (0.0, 0.0, 0.27))
    feet = [(s * x * 0.78 - 0.02, -0.17, 0.0, s * x * 0.78 + 0.02, 0.17, 0.05) for s in (-1, 0, 1)]
    posts = [(s * x * 0.78 - 0.018, -0.1, 0.05, s * x * 0.78 + 0.018, 0.1, 0.27) for s in (-1, 0, 1)]
    beam = (-x + 0.06, -0.03, 0.1, x - 0.06, 0.03, 0.19)
    return fitted("gym-bench", [Part(seat, "wood"), box_part("wood", *feet, *posts, beam)])


def vaulting_box(rng: np.random.Generator) -> Prop:
    """Sections that narrow upwards under a leather top."""
    sections = int(rng.integers(3, 6))
    parts = []
    for k in range(sections):
        low, high = 0.2 * k, 0.2 * (k + 1) - 0.008
        half_x, half_y = 0.74 - 0.026 * k, 0.37 - 0.026 * k
        outline = boxes([-half_x, -half_y, low], [half_x, half_y, high])
        lean = outline.vertices.copy()
        lean[lean[:, 2] > (low + high) / 2, :2] *= 0.975
        parts.append(Part(Solid(lean, outline.faces, outline.uv), "wood"))
        grip = (-0.14, -half_y - 0.002, low + 0.09, 0.14, -half_y + 0.05, low + 0.125)
        parts.append(box_part("dark", grip))
    top, wide, deep = 0.2 * sections - 0.008, 1.48 - 0.052 * sections, 0.74 - 0.052 * sections
    parts.append(
        Part(cushion((0.0, 0.0, top), (wide + 0.04, deep + 0.04, 0.14), 0.06), "leather", smooth=True)
    )
    return fitted("vaulting-box", parts)


def mats(rng: np.random.Generator) -> Prop:
    """A stack of gymnastic mats, or one soft landing mat."""
    if rng.random() < 0.4:
        thick = float(rng.uniform(0.25, 0.4))
        slab = cushion((0.0, 0.0, 0.0), (3.0, 2.0, thick), 0.04)
        return fitted(
            "landing-mat",
            [Part(slab, "mat", smooth=True), box_part("dark", (-1.49, -1.005, 0.04, 1.49, 1.005, 0.09))],
        )
    count = int(rng.integers(3, 9))
    shift = rng.uniform(-0.03, 0.03, (count, 2))
    slabs = [
        cushion((float(dx), float(dy), 0.062 * k), (2.0, 1.0, 0.06), 0.012)
        for k, (dx, dy) in enumerate(shift)
    ]
    return fitted("mats", [Part(joined(slabs), "mat", smooth=True)])


def goal(rng: np.random.Generator) -> Prop:
    """A handball goal, 3 × 2 m, its posts banded, with a frame behind it."""
    del rng
    parts = []
    x, half = 1.54, 0.04
    for k in range(10):
        finish, z = ("band" if k % 2 == 0 else "white"), 0.2 * k
        parts.append(
            box_part(finish, *[(s * x - half, -0.44, z, s * x + half, -0.36, z + 0.2) for s in (-1, 1)])
        )
    edges = np.linspace(-x - half, x + half, 17)
    for k in range(16):
        bar = (float(edges[k]), -0.44, 2.0, float(edges[k + 1]), -0.36, 2.08)
        parts.append(box_part("white" if k % 2 == 0 else "band", bar))
    frame = []
    for s in (-1.0, 1.0):
        frame += [
            rod((s * x, -0.4, 0.03), (s * x, 0.42, 0.03), 0.02),
            rod((s * x, -0.4, 2.02), (s * x, 0.15, 1.98), 0.02),
            rod((s * x, 0.15, 1.98), (s * x, 0.42, 0.03), 0.02),
        ]
    frame += [rod((-x, 0.42, 0.03), (x, 0.42, 0.03), 0.02), rod((-x, 0.15, 1.98), (x, 0.15, 1.98), 0.02)]
    cords = [
        rod((float(at), 0.15, 1.98), (float(at), 0.42, 0.03), 0.004, 4) for at in np.linspace(-x, x, 22)[1:-1]
    ]
    cords += [
        rod(
            (-x, 0.15 + 0.27 * k / 14, 1.98 - 1.95 * k / 14),
            (x, 0.15 + 0.27 * k / 14, 1.98 - 1.95 * k / 14),
            0.004,
            4,
        )
        for k in range(1, 14)
    ]
    return fitted("goal", [*parts, Part(joined(frame), "white"), Part(joined(cords), "white")])


def ball_cage(rng: np.random.Generator) -> Prop:
    """Balls in an open cage on wheels."""
    x, y, low, high = 0.5, 0.3, 0.2, 0.85
    wires = [
        rod((float(a), s * y, low), (float(a), s * y, high), 0.008, 6)
        for s in (-1, 1)
        for a in np.linspace(-x, x, 7)
    ]
    wires += [
        rod((s * x, float(b), low), (s * x, float(b), high), 0.008, 6)
        for s in (-1, 1)
        for b in np.linspace(-y, y, 5)
    ]
    for z in (low, (low + high) / 2, high):
        wires += [rod((-x, s * y, z), (x, s * y, z), 0.01, 6) for s in (-1, 1)]
        wires += [rod((s * x, -y, z), (s * x, y, z), 0.01, 6) for s in (-1, 1)]
    wheels = [
        tilted(moved(lathe([(0.06, -0.02), (0.06, 0.02)], 12), (0.0, 0.0, 0.0)), (np.pi / 2, 0.0, 0.0))
        for _ in range(4)
    ]
    feet = [
        moved(w, (sx * (x - 0.06), sy * (y - 0.06), 0.06))
        for w, (sx, sy) in zip(wheels, [(-1, -1), (-1, 1), (1, -1), (1, 1)], strict=True)
    ]
    parts = [
        Part(joined(wires), "metal"),
        Part(joined(feet), "dark"),
        box_part("metal", (-x, -y, 0.12, x, y, low)),
    ]
    for ix in range(4):
        for iy in range(2):
            for iz in range(2):
                at = (-0.36 + 0.24 * ix, -0.13 + 0.26 * iy, low + 0.24 * iz)
                parts.append(Part(_ball(at, 0.115), ("ball", "white")[int(rng.integers(2))], smooth=True))
    return fitted("ball-cage", parts)


def _ball(base: Vector, radius: float) -> Solid:
    return cushion(base, (2 * radius, 2 * radius, 2 * radius), radius)


def hoop(rng: np.random.Generator) -> Prop:
    """A backboard on a bracket with ring and net; its underside is the net's hem."""
    reach = float(rng.uniform(0.7, 1.2))
    board = box_part("white", (-0.9, -0.015, RING - 0.15, 0.9, 0.015, RING + 0.9))
    square = [
        (-0.295, -0.018, RING, -0.245, -0.015, RING + 0.45),
        (0.245, -0.018, RING, 0.295, -0.015, RING + 0.45),
        (-0.295, -0.018, RING, 0.295, -0.015, RING + 0.05),
        (-0.295, -0.018, RING + 0.4, 0.295, -0.015, RING + 0.45),
    ]
    edge = [
        (-0.9, -0.018, RING - 0.15, 0.9, -0.015, RING - 0.1),
        (-0.9, -0.018, RING + 0.85, 0.9, -0.015, RING + 0.9),
        (-0.9, -0.018, RING - 0.15, -0.85, -0.015, RING + 0.9),
        (0.85, -0.018, RING - 0.15, 0.9, -0.015, RING + 0.9),
    ]
    angles = np.linspace(0.0, 2.0 * np.pi, 17)
    middle, radius = -0.375, 0.225
    ring = [
        rod(
            (radius * np.cos(a), middle + radius * np.sin(a), RING),
            (radius * np.cos(b), middle + radius * np.sin(b), RING),
            0.01,
            6,
        )
        for a, b in itertools.pairwise(angles)
    ]
    cords = []
    for a in angles[:-1]:
        for twist in (-0.4, 0.4):
            foot = (0.14 * np.cos(a + twist), middle + 0.14 * np.sin(a + twist), RING - 0.42)
            cords.append(rod((radius * np.cos(a), middle + radius * np.sin(a), RING), foot, 0.004, 4))
    arms = [
        rod((s * 0.5, 0.015, z), (s * 0.7, reach, z + 0.1), 0.03) for s in (-1, 1) for z in (RING, RING + 0.7)
    ]
    parts = [
        board,
        box_part("dark", *square, *edge),
        Part(joined(ring), "ball"),
        Part(joined(cords), "white"),
        Part(joined(arms), "dark"),
    ]
    return fitted("hoop", parts)
