"""Doors and windows: cut into a wall, framed, with what is seen through them."""

from dataclasses import dataclass

import numpy as np

from whacamole.stage.props.pieces import rod
from whacamole.stage.rooms.wall import Rect, Wall
from whacamole.stage.shapes import Solid

__all__ = ["WindowKind", "curtains", "door", "radiator", "ring", "window"]

DOOR = (0.9, 2.08)
"""Width and height of a door [m]."""

DEEP = 0.14
"""From the wall's surface to a window's glass [m]."""

PANE = 0.62
"""Widest pane without a bar beside it [m]."""


@dataclass(frozen=True)
class WindowKind:
    """The windows of one house.

    Attributes:
        bottom, top: above the floor [m].
        frame: width of its bars [m].
        transom: whether a bar crosses it at two thirds.
        clear: whether the outside is seen through it, or just light.
    """

    bottom: float
    top: float
    frame: float = 0.06
    transom: bool = False
    clear: bool = True


def ring(rect: Rect, bar: float, near: float, far: float) -> tuple[list[list[float]], list[list[float]]]:
    """Return the corners of four bars just inside a rectangle, from y ``near`` to ``far``."""
    left, right, bottom, top = rect
    spans = [
        (left, left + bar, bottom, top),
        (right - bar, right, bottom, top),
        (left + bar, right - bar, bottom, bottom + bar),
        (left + bar, right - bar, top - bar, top),
    ]
    return [[a, near, c] for a, _, c, _ in spans], [[b, far, d] for _, b, _, d in spans]


def _grown(rect: Rect, by: float) -> Rect:
    return Rect(rect.left - by, rect.right + by, rect.bottom - by, rect.top + by)


def window(wall: Wall, x: float, width: float, kind: WindowKind, rng: np.random.Generator) -> Rect:
    """Cut a window with its middle at ``x``: casing, sill, bars, and daylight behind."""
    rect = Rect(x - width / 2.0, x + width / 2.0, kind.bottom, kind.top)
    wall.cut(rect, 0.12)
    trim, bar = wall.trim, kind.frame
    trim.add_boxes("frame", *ring(rect, bar, DEEP - 0.04, DEEP + 0.03))
    inner = _grown(rect, -bar)
    count = max(1, round((inner.right - inner.left) / PANE))
    for at in np.linspace(inner.left, inner.right, count + 1)[1:-1]:
        trim.add_boxes(
            "frame", [at - bar / 2, DEEP - 0.03, inner.bottom], [at + bar / 2, DEEP + 0.03, inner.top]
        )
    if kind.transom:
        at = rect.bottom + 0.66 * (rect.top - rect.bottom)
        trim.add_boxes(
            "frame", [inner.left, DEEP - 0.025, at - bar / 3], [inner.right, DEEP + 0.03, at + bar / 3]
        )
    sill = (
        [rect.left - 0.06, -0.05, rect.bottom - 0.03],
        [rect.right + 0.06, DEEP - 0.03, rect.bottom + 0.005],
    )
    trim.add_boxes("frame", *sill)
    trim.add_boxes("sky", [rect.left, DEEP + 0.1, rect.bottom], [rect.right, DEEP + 0.12, rect.top])
    if kind.clear:
        _outside(wall, rect, rng)
    return rect


def _outside(wall: Wall, rect: Rect, rng: np.random.Generator) -> None:
    """Stand a pale row of houses and trees behind the glass."""
    tall, at = rect.top - rect.bottom, rect.left
    for layer, (finish, share) in enumerate((("far", 0.55), ("near", 0.32))):
        at, y = rect.left, DEEP + 0.09 - 0.02 * layer
        while at < rect.right - 1e-6:
            end = min(at + float(rng.uniform(0.12, 0.4)), rect.right)
            top = rect.bottom + tall * share * float(rng.uniform(0.6, 1.2))
            wall.trim.add_boxes(finish, [at, y, rect.bottom], [end, y + 0.01, top])
            at = end


def door(wall: Wall, x: float, leaves: int = 1, finish: str = "leaf") -> Rect:
    """Cut a door of one or two leaves with its middle at ``x``: casing, panels, handles."""
    width, top = DOOR[0] * leaves, DOOR[1]
    rect = Rect(x - width / 2.0, x + width / 2.0, 0.0, top)
    wall.cut(rect, 0.15)
    trim, casing = wall.trim, 0.08
    sides = [(rect.left - casing, rect.left, top + casing), (rect.right, rect.right + casing, top + casing)]
    trim.add_boxes("frame", [[a, -0.02, 0.0] for a, _, _ in sides], [[b, 0.06, c] for _, b, c in sides])
    trim.add_boxes("frame", [rect.left, -0.02, top], [rect.right, 0.06, top + casing])
    for leaf in range(leaves):
        left = rect.left + leaf * DOOR[0]
        right = left + DOOR[0]
        trim.add_boxes(finish, [left + 0.004, 0.03, 0.008], [right - 0.004, 0.07, top - 0.004])
        for low, high in ((0.22, 0.92), (1.08, top - 0.16)):
            panel = Rect(left + 0.14, right - 0.14, low, high)
            trim.add_boxes(finish, *ring(panel, 0.03, 0.018, 0.03))
        hinge_left = leaf == 0
        at = right - 0.07 if hinge_left else left + 0.07
        turn = -0.12 if hinge_left else 0.12
        trim.add("metal", rod((at, 0.03, 1.04), (at, -0.025, 1.04), 0.011))
        trim.add("metal", rod((at, -0.025, 1.04), (at + turn, -0.025, 1.04), 0.010))
        trim.add_boxes("metal", [at - 0.02, 0.024, 0.92], [at + 0.02, 0.03, 1.12])
    return rect


def curtains(wall: Wall, rect: Rect, floor_length: bool, rng: np.random.Generator) -> None:
    """Hang curtains on both sides of a window from a rod above it."""
    width, top = float(rng.uniform(0.3, 0.5)), rect.top + 0.16
    bottom = 0.02 if floor_length else rect.bottom - 0.15
    for side in (-1.0, 1.0):
        edge = rect.left if side < 0 else rect.right
        wall.trim.add("curtain", _folds(edge - side * 0.12, edge + side * (width - 0.12), bottom, top, rng))
    wall.trim.add("metal", rod((rect.left - width, -0.05, top), (rect.right + width, -0.05, top), 0.012))
    wall.take(Rect(rect.left - width + 0.1, rect.right + width - 0.1, bottom, top))


def _folds(start: float, end: float, bottom: float, top: float, rng: np.random.Generator) -> Solid:
    """Return a sheet in folds, which open a little towards the floor."""
    count = 33
    share = np.linspace(0.0, 1.0, count)
    x = min(start, end) + abs(end - start) * share
    phase = float(rng.uniform(0.0, 6.0)) + 2.0 * np.pi * share * max(3.0, abs(end - start) / 0.11)
    rows = [
        np.column_stack([x, -0.05 + wide * np.sin(phase), np.full(count, z)])
        for z, wide in ((bottom, 0.028), (top, 0.016))
    ]
    here = np.arange(count - 1)
    faces = np.stack([here, here + 1, here + 1 + count, here + count], axis=1)
    vertices = np.concatenate(rows)
    uv = np.column_stack([np.tile(2.0 * (x - x[0]), 2), vertices[:, 2]])
    return Solid(vertices.astype(np.float32), faces.astype(np.int32), uv[faces].astype(np.float32))


def radiator(wall: Wall, x: float, width: float) -> None:
    """Hang a ribbed radiator on the wall."""
    ribs = np.arange(x - width / 2.0, x + width / 2.0 - 0.03, 0.05)
    low = np.column_stack([ribs, np.full(len(ribs), -0.075), np.full(len(ribs), 0.14)])
    wall.trim.add_boxes("frame", low, low + np.array([0.035, 0.055, 0.54]))
    wall.trim.add_boxes(
        "frame",
        [[x - width / 2, -0.06, z] for z in (0.17, 0.60)],
        [[x + width / 2, -0.02, z + 0.05] for z in (0.17, 0.60)],
    )
    wall.take(Rect(x - width / 2, x + width / 2, 0.0, 0.75))
