"""Court lines on the floor of a hall, in the measures of the rule books."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from whacamole.stage.shapes import Solid, boxes, joined, turned

__all__ = ["COURTS", "court_lines"]

LINE = 0.05
"""Width of a line [m]."""

HEIGHT = 0.0015
"""Of the paint over the floor [m], so that neither engine mixes the two."""

COURTS: Final[dict[str, tuple[float, float]]] = {
    "basketball": (28.0, 15.0), "volleyball": (18.0, 9.0), "badminton": (13.4, 6.1),
}  # fmt: skip
"""Length and width of each [m], outer edges of the lines."""


def court_lines(kind: str, middle: NDArray[np.float64], yaw: float) -> Solid:
    """Return the lines of a court about a place, its length turned from x by ``yaw`` [rad]."""
    length, width = COURTS[kind]
    x, y = length / 2, width / 2
    bars = [(-x, -y, x, -y + LINE), (-x, y - LINE, x, y), (-x, -y, -x + LINE, y), (x - LINE, -y, x, y),
            (-LINE / 2, -y, LINE / 2, y)]  # fmt: skip
    curves: list[Solid] = []
    if kind == "basketball":
        curves.append(_arc((0.0, 0.0), 1.8, 0.0, 2 * np.pi))
        for side in (-1, 1):
            for edge in (-2.45, 2.45 - LINE):  # the restricted area, 5.8 m deep
                a, b = sorted((side * x, side * (x - 5.8)))
                bars.append((a, edge, b, edge + LINE))
            a, b = sorted((side * (x - 5.8), side * (x - 5.8 + LINE)))
            bars.append((a, -2.45, b, 2.45))
            turn = 0.0 if side < 0 else np.pi
            curves.append(_arc((side * (x - 5.8), 0.0), 1.8, turn - np.pi / 2, turn + np.pi / 2))
            open_ = np.arccos(0.0) - 0.2
            curves.append(_arc((side * (x - 1.575), 0.0), 6.75, turn - open_, turn + open_))
    elif kind == "volleyball":
        bars += [(s * 3.0 - LINE / 2, -y, s * 3.0 + LINE / 2, y) for s in (-1, 1)]
    else:
        bars += [(-x, s * 2.59 - LINE / 2, x, s * 2.59 + LINE / 2) for s in (-1, 1)]
        for side in (-1, 1):
            bars += [(side * at - LINE / 2, -y, side * at + LINE / 2, y) for at in (1.98, x - 0.76)]
            a, b = sorted((side * 1.98, side * x))
            bars.append((a, -LINE / 2, b, LINE / 2))
    flat = np.asarray(bars)
    low = np.column_stack([flat[:, :2], np.zeros(len(flat))])
    high = np.column_stack([flat[:, 2:], np.full(len(flat), HEIGHT)])
    return turned(joined([boxes(low, high), *curves]), (float(middle[0]), float(middle[1]), 0.0), yaw)


def _arc(middle: tuple[float, float], radius: float, start: float, end: float) -> Solid:
    """Return a level arc, its outer edge at ``radius``."""
    angle = np.linspace(start, end, 25)
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    outer, inner = middle + radius * ring, middle + (radius - LINE) * ring
    vertices = np.column_stack([np.concatenate([outer, inner]), np.full(50, HEIGHT)])
    here = np.arange(24)
    faces = np.stack([here + 25, here, here + 1, here + 26], axis=1)
    return Solid(
        vertices.astype(np.float32), faces.astype(np.int32), vertices[faces][:, :, :2].astype(np.float32)
    )
