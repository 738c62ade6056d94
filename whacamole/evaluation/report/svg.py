"""Small charts as SVG text: lines with axes and a legend, nothing else."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np
import numpy.typing as npt

Curve = npt.NDArray[np.float64]

COLOURS = ("#1b6ca8", "#d1495b", "#2e8b57", "#8a5a9e", "#c77d0a", "#3a9ba6", "#7a7a7a")


@dataclass(frozen=True, eq=False)
class Line:
    """One curve.

    Attributes:
        label: in the legend; "" to leave it out.
        x, y: (N,), broken where either is NaN.
        colour: of the stroke.
        dashed: a dashed stroke.
        width: of the stroke [px].
    """

    label: str
    x: Curve
    y: Curve
    colour: str
    dashed: bool = False
    width: float = 1.6


@dataclass(frozen=True)
class Frame:
    """Size and place of a chart [px]."""

    width: int = 460
    height: int = 320
    left: int = 54
    right: int = 12
    top: int = 26
    bottom: int = 40


def chart(
    lines: Sequence[Line],
    title: str,
    x_label: str,
    y_label: str,
    *,
    equal: bool = False,
    frame: Frame | None = None,
) -> str:
    """Draw lines over labelled axes.

    Args:
        equal: one unit is as long on both axes, as a map needs.
    """
    box = frame or Frame()
    plot_width, plot_height = box.width - box.left - box.right, box.height - box.top - box.bottom
    x_range, y_range = _range([line.x for line in lines]), _range([line.y for line in lines])
    if equal:
        x_range, y_range = _equal(x_range, y_range, plot_width / plot_height)

    def to_x(value: float) -> float:
        return box.left + (value - x_range[0]) / (x_range[1] - x_range[0]) * plot_width

    def to_y(value: float) -> float:
        return box.top + plot_height - (value - y_range[0]) / (y_range[1] - y_range[0]) * plot_height

    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {box.width} {box.height}" '
        f'width="{box.width}" height="{box.height}" font-family="sans-serif" font-size="11" '
        f'role="img" aria-label="{escape(title)}">',
        f'<rect width="{box.width}" height="{box.height}" fill="white"/>',
        f'<text x="{box.left}" y="16" font-size="12" font-weight="bold">{escape(title)}</text>',
    ]
    bottom = box.top + plot_height
    for value in ticks(*x_range):
        x = to_x(value)
        parts.append(f'<path d="M{x:.1f} {box.top}V{bottom}" stroke="#e4e4e4"/>')
        parts.append(f'<text x="{x:.1f}" y="{bottom + 14}" text-anchor="middle">{value:g}</text>')
    for value in ticks(*y_range):
        y = to_y(value)
        parts.append(f'<path d="M{box.left} {y:.1f}H{box.width - box.right}" stroke="#e4e4e4"/>')
        parts.append(f'<text x="{box.left - 5}" y="{y + 4:.1f}" text-anchor="end">{value:g}</text>')
    across, middle = box.left + plot_width / 2, box.top + plot_height / 2
    below = f'<text x="{across:.0f}" y="{box.height - 8}" text-anchor="middle">'
    beside = f'<text transform="translate(13 {middle:.0f}) rotate(-90)" text-anchor="middle">'
    parts += [f"{below}{escape(x_label)}</text>", f"{beside}{escape(y_label)}</text>"]
    for line in lines:
        dash = ' stroke-dasharray="5 3"' if line.dashed else ""
        path = _path(np.array([to_x(v) for v in line.x]), np.array([to_y(v) for v in line.y]))
        if path:
            parts.append(
                f'<path d="{path}" fill="none" stroke="{line.colour}" stroke-width="{line.width:g}"{dash}/>'
            )
    parts += _legend(lines, box)
    return "".join([*parts, "</svg>"])


def _legend(lines: Sequence[Line], box: Frame) -> list[str]:
    named = [line for line in lines if line.label]
    parts = []
    for number, line in enumerate(named):
        y = box.top + 12 + 14 * number
        x = box.width - box.right - 8
        dash = ' stroke-dasharray="5 3"' if line.dashed else ""
        parts.append(f'<path d="M{x - 18} {y - 4}h18" stroke="{line.colour}" stroke-width="2"{dash}/>')
        parts.append(f'<text x="{x - 23}" y="{y}" text-anchor="end">{escape(line.label)}</text>')
    return parts


def _path(x: Curve, y: Curve) -> str:
    """Move and line commands, a new stroke after every gap."""
    parts, pen_down = [], False
    for a, b in zip(x, y, strict=True):
        if np.isfinite(a) and np.isfinite(b):
            parts.append(f"{'L' if pen_down else 'M'}{a:.1f} {b:.1f}")
        pen_down = bool(np.isfinite(a) and np.isfinite(b))
    return "".join(parts)


def _range(values: Sequence[Curve]) -> tuple[float, float]:
    finite = [v[np.isfinite(v)] for v in values]
    every = np.concatenate(finite) if finite else np.zeros(0)
    if not len(every):
        return 0.0, 1.0
    low, high = float(every.min()), float(every.max())
    margin = 0.04 * (high - low) or max(abs(low) * 0.05, 0.5)
    return low - margin, high + margin


def _equal(
    x: tuple[float, float], y: tuple[float, float], aspect: float
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Widen one range so that both have the same scale in a box of this width by height."""
    width, height = x[1] - x[0], y[1] - y[0]
    if width < height * aspect:
        add = 0.5 * (height * aspect - width)
        return (x[0] - add, x[1] + add), y
    add = 0.5 * (width / aspect - height)
    return x, (y[0] - add, y[1] + add)


def ticks(low: float, high: float, wanted: int = 5) -> list[float]:
    """Round numbers, about ``wanted`` of them, inside a range."""
    raw = (high - low) / wanted
    power = 10.0 ** np.floor(np.log10(raw))
    step = next(float(m * power) for m in (1.0, 2.0, 5.0, 10.0) if m * power >= raw * 0.999)
    first = np.ceil(low / step) * step
    count = int(np.floor((high - first) / step + 1e-9)) + 1
    return [float(np.round(first + i * step, 10)) + 0.0 for i in range(count)]
