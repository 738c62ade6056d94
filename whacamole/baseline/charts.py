"""Plain line charts as SVG: a loss curve, paths seen from above."""

from collections.abc import Sequence
from dataclasses import dataclass
from xml.sax.saxutils import escape

import numpy as np

from whacamole.baseline.rigid import FloatArray

WIDTH, HEIGHT, MARGIN = 480, 320, 46
_COLOURS = ("#1f5fa8", "#c8501e", "#3a8a4d", "#7a4fa3", "#8a6d1f")


@dataclass(frozen=True, eq=False)
class Line:
    """A line of a chart.

    Attributes:
        name: in the legend.
        points: (n, 2); a row that is not finite breaks the line.
        dashed: drawn so.
    """

    name: str
    points: FloatArray
    dashed: bool = False


def chart(lines: Sequence[Line], title: str, x_name: str, y_name: str, *, equal: bool = False) -> str:
    """An SVG chart.

    Args:
        equal: one unit is as long on both axes, as on a map.
    """
    known = [line.points[np.isfinite(line.points).all(axis=1)] for line in lines]
    every = np.concatenate([*known, np.zeros((0, 2))])
    low, high = (every.min(axis=0), every.max(axis=0)) if len(every) else (np.zeros(2), np.ones(2))
    span = np.maximum(high - low, 1e-9) * 1.08
    middle = (low + high) / 2.0
    room = np.array([WIDTH - 1.5 * MARGIN, HEIGHT - 1.9 * MARGIN])
    if equal:
        span = np.full(2, (span / room).max()) * room
    low = middle - span / 2.0
    parts = [_frame(low, span, room, title, x_name, y_name)]
    for number, line in enumerate(lines):
        parts.append(_drawn(line, number, low, span, room))
    style = "font-family='sans-serif' font-size='11'"
    head = f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {WIDTH} {HEIGHT}' {style}>"
    return "\n".join([head, f"<rect width='{WIDTH}' height='{HEIGHT}' fill='white'/>", *parts, "</svg>\n"])


def _place(points: FloatArray, low: FloatArray, span: FloatArray, room: FloatArray) -> FloatArray:
    share = (points - low) / span
    return np.stack([MARGIN + share[:, 0] * room[0], HEIGHT - MARGIN - share[:, 1] * room[1]], axis=1)


def _drawn(line: Line, number: int, low: FloatArray, span: FloatArray, room: FloatArray) -> str:
    colour = _COLOURS[number % len(_COLOURS)]
    steps, pen = [], "M"
    for x, y in _place(line.points, low, span, room):
        if np.isfinite(x) and np.isfinite(y):
            steps.append(f"{pen}{x:.1f} {y:.1f}")
            pen = "L"
        else:
            pen = "M"
    dash = " stroke-dasharray='5 4'" if line.dashed else ""
    path = f"<path d='{' '.join(steps)}' fill='none' stroke='{colour}' stroke-width='1.6'{dash}/>"
    x, y = MARGIN + 8, MARGIN - 4 + 14 * number
    legend = (
        f"<path d='M{x} {y} h18' stroke='{colour}' stroke-width='1.6'{dash}/>"
        f"<text x='{x + 23}' y='{y + 4}'>{escape(line.name)}</text>"
    )
    return path + legend


def _frame(low: FloatArray, span: FloatArray, room: FloatArray, title: str, x_name: str, y_name: str) -> str:
    bottom = HEIGHT - MARGIN
    parts = [
        f"<rect x='{MARGIN}' y='{bottom - room[1]:.1f}' width='{room[0]:.1f}' height='{room[1]:.1f}' "
        "fill='none' stroke='#999'/>",
        f"<text x='{WIDTH / 2}' y='18' text-anchor='middle' font-size='13'>{escape(title)}</text>",
        f"<text x='{WIDTH / 2}' y='{HEIGHT - 10}' text-anchor='middle'>{escape(x_name)}</text>",
        f"<text transform='translate(13 {HEIGHT / 2}) rotate(-90)' text-anchor='middle'>{escape(y_name)}"
        "</text>",
    ]
    for axis in (0, 1):
        for tick in _ticks(float(low[axis]), float(span[axis])):
            point = low.copy()
            point[axis] = tick
            x, y = _place(point[None], low, span, room)[0]
            place, anchor = ((x, bottom + 15), "middle") if axis == 0 else ((MARGIN - 5, y + 4), "end")
            parts.append(
                f"<text x='{place[0]:.1f}' y='{place[1]:.1f}' text-anchor='{anchor}'>{tick:g}</text>"
            )
    return "\n".join(parts)


def _ticks(low: float, span: float) -> FloatArray:
    """About five round numbers."""
    rough = span / 5.0
    power = 10.0 ** np.floor(np.log10(rough))
    step = power * min((1.0, 2.0, 5.0, 10.0), key=lambda factor: abs(factor * power - rough))
    first = np.ceil(low / step) * step
    count = int((low + span - first) / step) + 1
    ticks: FloatArray = np.round(first + step * np.arange(count, dtype=np.float64), 10)
    return ticks
