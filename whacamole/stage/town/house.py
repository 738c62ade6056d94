"""The measures of a house, and drawing them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["House", "Town", "draw_house"]

SHOP_STOREY = (3.5, 4.1)
GROUND_STOREY = (3.0, 3.4)
STOREY = (2.8, 3.3)
"""Heights of storeys [m]."""

BAY = (2.1, 3.1)
"""From window to window [m]."""

WINDOW_WIDTH = (0.95, 1.3)
WINDOW_HEIGHT = (1.35, 1.8)
SILL = (0.75, 0.95)
"""A window's sill over the floor [m]."""


@dataclass(frozen=True)
class Town:
    """What the houses around a place have in common.

    Attributes:
        storeys: fewest and most.
        shops: share of houses with one.
        lit: share of windows with light behind.
        pitched: share of houses with a pitched roof.
    """

    storeys: tuple[int, int] = (2, 4)
    shops: float = 0.5
    lit: float = 0.0
    pitched: float = 0.65


@dataclass(frozen=True)
class House:
    """A house; its front stands on y = 0 and looks along −y, its left corner is at x = 0. Metres.

    Attributes:
        width, depth: of the ground plan.
        ground, storey: height of the ground floor, and of each above it.
        upper: storeys over the ground floor.
        bays: windows side by side.
        window: width and height of a window.
        sill: from floor to sill.
        glazing: bars of a window: 0 none, 1 a mullion, 2 a mullion and a transom, 3 six panes.
        shop: whether the ground floor is one.
        pitched: whether the roof is, or flat behind a parapet.
        wall, base: finishes of the upper storeys and of the ground floor.
        trim, frame, door, shutters: finishes of what is on the front; shutters "" for none.
        surround: what is about a window: 0 a sill, 1 sill and lintel, 2 a frame of stone,
            3 a frame and a ledge over it.
        balcony: bay with balconies; −1 none.
        quoins: whether cut stones stand at the corners.
        lit: share of windows with light behind.
    """

    width: float
    depth: float
    ground: float
    storey: float
    upper: int
    bays: int
    window: tuple[float, float]
    sill: float
    glazing: int
    shop: bool
    pitched: bool
    wall: str
    base: str
    trim: str
    frame: str
    door: str
    shutters: str
    surround: int
    balcony: int
    quoins: bool
    lit: float

    @property
    def height(self) -> float:
        """To the eaves [m]."""
        return self.ground + self.upper * self.storey

    @property
    def middles(self) -> NDArray[np.float64]:
        """(bays,) x of the middle of each bay [m]."""
        return (np.arange(self.bays) + 0.5) * (self.width - 0.6) / self.bays + 0.3

    @property
    def bay(self) -> float:
        """Width of a bay [m]."""
        return (self.width - 0.6) / self.bays

    @property
    def floors(self) -> NDArray[np.float64]:
        """(upper,) heights of the floors over the ground floor [m]."""
        return self.ground + self.storey * np.arange(self.upper)


def draw_house(rng: np.random.Generator, width: float, town: Town) -> House:
    """Draw a house ``width`` metres wide."""
    shop = bool(rng.random() < town.shops)
    bays = max(2, round(width / float(rng.uniform(*BAY))))
    window = (
        min(float(rng.uniform(*WINDOW_WIDTH)), (width - 0.6) / bays - 0.5),
        float(rng.uniform(*WINDOW_HEIGHT)),
    )
    wall = str(rng.choice(["stucco", "stucco", "stucco", "brick", "ashlar"]))
    base = str(rng.choice([wall, "ashlar", "stucco-dark"])) if wall != "ashlar" else wall
    return House(
        width=width,
        depth=float(rng.uniform(8.0, 11.0)),
        ground=float(rng.uniform(*(SHOP_STOREY if shop else GROUND_STOREY))),
        storey=float(rng.uniform(*STOREY)),
        upper=int(rng.integers(town.storeys[0], town.storeys[1] + 1)) - 1,
        bays=bays,
        window=window,
        sill=float(rng.uniform(*SILL)),
        glazing=int(rng.choice(4, p=[0.1, 0.3, 0.4, 0.2])),
        shop=shop,
        pitched=bool(rng.random() < town.pitched),
        wall=wall,
        base=base,
        trim=str(rng.choice(["trim-pale", "trim-sand", "trim-grey"])),
        frame=str(rng.choice(["frame-white", "frame-white", "frame-dark", "frame-wood"])),
        door=str(rng.choice(["door-0", "door-1", "door-2"])),
        shutters=str(rng.choice(["", "", "", "door-0", "door-1", "door-2"])),
        surround=int(rng.choice(4, p=[0.2, 0.3, 0.3, 0.2])),
        balcony=int(rng.integers(bays)) if rng.random() < 0.35 else -1,
        quoins=bool(rng.random() < 0.25),
        lit=town.lit,
    )  # fmt: skip
