"""Windows: a frame with bars set back into the wall, a pane, and what is about the opening."""

import numpy as np

from whacamole.stage.pile import Pile
from whacamole.stage.textures.windows import PANES
from whacamole.stage.town.house import House
from whacamole.stage.town.walls import Rectangles, bars, panes

__all__ = ["glaze", "set_windows"]

FRAME = 0.06
"""Width of a window's frame [m]."""

BACK = (0.11, 0.17)
"""Of a frame, behind the face of the wall [m]."""

PANE = 0.15
"""Of the glass, behind the face of the wall [m]."""


def set_windows(pile: Pile, house: House, holes: Rectangles, rng: np.random.Generator) -> None:
    """Set a window into each hole."""
    _frames(pile, house.frame, holes)
    _bars(pile, house, holes)
    glaze(pile, holes, house.lit, rng)
    _surrounds(pile, house, holes)
    if house.shutters:
        _shutters(pile, house.shutters, holes)


def glaze(pile: Pile, holes: Rectangles, lit: float, rng: np.random.Generator) -> None:
    """Put a pane into each hole, a share of them with light behind."""
    pictures = rng.integers(PANES**2, size=len(holes))
    warm = rng.random(len(holes))
    for finish, some in (
        ("lit", warm < 0.7 * lit), ("lit-cool", (warm >= 0.7 * lit) & (warm < lit)), ("pane", warm >= lit),
    ):  # fmt: skip
        if some.any():
            pile.add(finish, panes(holes[some], PANE, pictures[some], (PANES, PANES)))


def _frames(pile: Pile, finish: str, holes: Rectangles) -> None:
    left, bottom, right, top = holes.T
    sides = [
        (left, bottom, left + FRAME, top), (right - FRAME, bottom, right, top),
        (left + FRAME, bottom, right - FRAME, bottom + FRAME),
        (left + FRAME, top - FRAME, right - FRAME, top),
    ]  # fmt: skip
    bars(pile, finish, np.concatenate([np.stack(side, axis=1) for side in sides]), BACK)


def _bars(pile: Pile, house: House, holes: Rectangles) -> None:
    left, bottom, right, top = holes.T
    middle, wide = (left + right) / 2, 0.045
    uprights = [middle] if house.glazing else []
    levels = {2: [0.68], 3: [0.36, 0.68]}.get(house.glazing, [])
    for x in uprights:
        bars(pile, house.frame, np.stack([x - wide, bottom, x + wide, top], axis=1), BACK)
    for share in levels:
        z = bottom + share * (top - bottom)
        bars(
            pile, house.frame, np.stack([left, z - 0.03, right, z + 0.03], axis=1), (BACK[0] + 0.01, BACK[1])
        )


def _surrounds(pile: Pile, house: House, holes: Rectangles) -> None:
    left, bottom, right, top = holes.T
    bars(
        pile, house.trim, np.stack([left - 0.07, bottom - 0.08, right + 0.07, bottom], axis=1), (-0.09, 0.12)
    )
    if house.surround == 1:
        bars(pile, house.trim, np.stack([left - 0.12, top, right + 0.12, top + 0.2], axis=1), (-0.02, 0.02))
    elif house.surround >= 2:
        edge = 0.13
        for side in ((left - edge, bottom, left, top + edge), (right, bottom, right + edge, top + edge),
                     (left, top, right, top + edge)):  # fmt: skip
            bars(pile, house.trim, np.stack(side, axis=1), (-0.035, 0.02))
    if house.surround == 3:
        over = top + 0.13
        bars(pile, house.trim, np.stack([left - 0.2, over, right + 0.2, over + 0.07], axis=1), (-0.12, 0.0))


def _shutters(pile: Pile, finish: str, holes: Rectangles) -> None:
    """Folded open on both sides of a window: two leaves with rails."""
    left, bottom, right, top = holes.T
    wide, gap = (right - left) / 2, 0.16
    for inner, outer in ((left - gap, left - gap - wide), (right + gap, right + gap + wide)):
        x0, x1 = np.minimum(inner, outer), np.maximum(inner, outer)
        bars(pile, finish, np.stack([x0, bottom, x1, top], axis=1), (-0.03, 0.0))
        for share in np.linspace(0.04, 0.9, 9):
            z = bottom + share * (top - bottom)
            bars(pile, finish, np.stack([x0 + 0.05, z, x1 - 0.05, z + 0.06], axis=1), (-0.045, -0.03))
