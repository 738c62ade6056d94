"""Small charts as SVG text: lines with axes and a legend, nothing else."""

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape

import numpy as np
import numpy.typing as npt

Curve = npt.NDArray[np.float64]

COLOURS = ("#1b6ca8", "#d1495b", "#2e8b57", "#8a5a9e", "#c77d0a", "#3a9ba6", "#7a7a7a")

_LONGEST = 16
"""Characters of a name in the legend."""


@dataclass(frozen=True, eq=False)
class Line:
    """One curve.

    Attributes:
        label: in the legend; "" to leave it out.
        x, y: (N,), broken where either is NaN.
        colour: of the stroke.
        dashed: a dashed stroke.
        dotted: a dot where it begins.
        width: of the stroke [px].
    """

    label: str
    x: Curve
    y: Curve
    colour: str
    dashed: bool = False
    width: float = 1.6
    dotted: bool = False


@dataclass(frozen=True)
class _Axes:
    """A box of the page and the ranges it shows."""

    x: tuple[float, float]
    y: tuple[float, float]
    width: int = 590
    height: int = 320
    left: int = 54
    right: int = 458
    top: int = 26
    bottom: int = 280

    def to_x(self, value: Curve) -> Curve:
        """Pixels from the left of values."""
        return self.left + (value - self.x[0]) / (self.x[1] - self.x[0]) * (self.right - self.left)

    def to_y(self, value: Curve) -> Curve:
        """Pixels from the top of values."""
        return self.bottom - (value - self.y[0]) / (self.y[1] - self.y[0]) * (self.bottom - self.top)

    def drawn(self, x_label: str, y_label: str) -> list[str]:
        """Grid, numbers and labels."""
        parts = []
        for value in ticks(*self.x):
            x = float(self.to_x(np.array(value)))
            parts.append(f'<path d="M{x:.1f} {self.top}V{self.bottom}" stroke="#e4e4e4"/>')
            parts.append(f'<text x="{x:.1f}" y="{self.bottom + 14}" text-anchor="middle">{value:g}</text>')
        for value in ticks(*self.y):
            y = float(self.to_y(np.array(value)))
            parts.append(f'<path d="M{self.left} {y:.1f}H{self.right}" stroke="#e4e4e4"/>')
            parts.append(f'<text x="{self.left - 5}" y="{y + 4:.1f}" text-anchor="end">{value:g}</text>')
        across, middle = (self.left + self.right) / 2, (self.top + self.bottom) / 2
        below = f'<text x="{across:.0f}" y="{self.height - 8}" text-anchor="middle">'
        beside = f'<text transform="translate(13 {middle:.0f}) rotate(-90)" text-anchor="middle">'
        return [*parts, f"{below}{escape(x_label)}</text>", f"{beside}{escape(y_label)}</text>"]


def chart(lines: Sequence[Line], title: str, x_label: str, y_label: str, *, equal: bool = False) -> str:
    """Draw lines over labelled axes.

    Args:
        lines: the curves; later ones lie on top.
        title, x_label, y_label: texts.
        equal: one unit is as long on both axes, as a map needs.
    """
    axes = _Axes(_range([line.x for line in lines]), _range([line.y for line in lines]))
    if equal:
        x, y = _equal(axes.x, axes.y, (axes.right - axes.left) / (axes.bottom - axes.top))
        axes = _Axes(x, y)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {axes.width} {axes.height}" '
        f'width="{axes.width}" height="{axes.height}" font-family="sans-serif" font-size="11" '
        f'role="img" aria-label="{escape(title)}">',
        f'<rect width="{axes.width}" height="{axes.height}" fill="white"/>',
        f'<text x="{axes.left}" y="16" font-size="12" font-weight="bold">{escape(title)}</text>',
        *axes.drawn(x_label, y_label),
    ]
    for line in lines:
        path = _path(axes.to_x(line.x), axes.to_y(line.y))
        if path:
            stroke = f'stroke="{line.colour}" stroke-width="{line.width:g}"{_dash(line)}'
            parts.append(f'<path d="{path}" fill="none" {stroke}/>')
            parts += _start(line, axes) if line.dotted else []
    return "".join([*parts, *_legend(lines, axes), "</svg>"])


def _dash(line: Line) -> str:
    return ' stroke-dasharray="5 3"' if line.dashed else ""


def _start(line: Line, axes: _Axes) -> list[str]:
    """A dot at the first point of a line."""
    at = np.flatnonzero(np.isfinite(line.x) & np.isfinite(line.y))[:1]
    x, y = axes.to_x(line.x[at]), axes.to_y(line.y[at])
    return [
        f'<circle cx="{a:.1f}" cy="{b:.1f}" r="3.5" fill="{line.colour}"/>' for a, b in zip(x, y, strict=True)
    ]


def _legend(lines: Sequence[Line], axes: _Axes) -> list[str]:
    """Names beside the box, where no line runs."""
    parts = []
    for number, line in enumerate(line for line in lines if line.label):
        x, y = axes.right + 10, axes.top + 12 + 16 * number
        stroke = f'stroke="{line.colour}" stroke-width="2"{_dash(line)}'
        parts.append(f'<path d="M{x} {y - 4}h18" {stroke}/>')
        name = line.label if len(line.label) <= _LONGEST else f"{line.label[: _LONGEST - 1]}…"
        parts.append(f'<text x="{x + 23}" y="{y}">{escape(name)}</text>')
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
