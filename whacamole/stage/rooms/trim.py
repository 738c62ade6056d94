"""What runs along walls and hangs on them: skirting, wainscot, cornice, pictures, clocks."""

import itertools

import numpy as np

from whacamole.stage.props.pieces import in_cells
from whacamole.stage.rooms.openings import ring
from whacamole.stage.rooms.wall import Rect, Wall
from whacamole.stage.shapes import boxes, lathe, moved, tilted
from whacamole.stage.textures.interiors import CELLS

__all__ = ["clock", "cornice", "picture", "skirting", "wainscot"]


def skirting(wall: Wall, height: float) -> None:
    """Run a board along the foot of the wall, but for its doors."""
    gaps = [
        (a + (0.08 if a > -wall.length / 2 else 0.0), b - (0.08 if b < wall.length / 2 else 0.0))
        for a, b in wall.gaps(0.0, height)
    ]
    wall.trim.add_boxes("frame", [[a, -0.016, 0.0] for a, _ in gaps], [[b, 0.0, height] for _, b in gaps])


def cornice(wall: Wall) -> None:
    """Run a moulding along the ceiling."""
    half = wall.length / 2.0
    low, high = (
        [[-half, -0.05, wall.height - 0.06], [-half, -0.025, wall.height - 0.1]],
        [[half, 0.0, wall.height], [half, 0.0, wall.height - 0.06]],
    )
    wall.trim.add_boxes("frame", low, high)


def wainscot(wall: Wall, height: float, finish: str = "frame") -> None:
    """Clad the lower part of the wall with framed panels under a rail."""
    for a, b in wall.gaps(0.0, height):
        left = a + (0.08 if a > -wall.length / 2 else 0.0)
        right = b - (0.08 if b < wall.length / 2 else 0.0)
        if right - left < 0.05:
            continue
        wall.trim.add_boxes(finish, [left, -0.012, 0.0], [right, 0.0, height])
        wall.trim.add_boxes(finish, [left, -0.035, height - 0.03], [right, 0.0, height])
        edges = np.linspace(left, right, max(1, round((right - left) / 0.7)) + 1)
        for one, other in itertools.pairwise(edges):
            if other - one > 0.25:
                panel = Rect(one + 0.06, other - 0.06, 0.18, height - 0.1)
                wall.trim.add_boxes(finish, *ring(panel, 0.025, -0.026, -0.012))


def picture(wall: Wall, rect: Rect, rng: np.random.Generator) -> None:
    """Hang a framed picture."""
    bar, mat = float(rng.uniform(0.015, 0.035)), float(rng.choice([0.0, 0.05, 0.08]))
    wall.trim.add_boxes("picture-frame", *ring(rect, bar, -0.028, 0.0))
    wall.trim.add_boxes(
        "mat", [rect.left + bar, -0.012, rect.bottom + bar], [rect.right - bar, 0.0, rect.top - bar]
    )
    inset = bar + mat
    canvas = boxes(
        [rect.left + inset, -0.016, rect.bottom + inset], [rect.right - inset, -0.012, rect.top - inset]
    )
    wall.trim.add("art", in_cells(canvas, np.array([rng.integers(CELLS * CELLS)]), 6))


def clock(wall: Wall, x: float, z: float) -> None:
    """Hang a round clock that shows ten past ten."""
    rim = moved(tilted(lathe([(0.16, 0.0), (0.16, 0.04)], 24), (np.pi / 2, 0.0, 0.0)), (x, 0.0, z))
    face = moved(tilted(lathe([(0.145, 0.0), (0.145, 0.042)], 24), (np.pi / 2, 0.0, 0.0)), (x, 0.0, z))
    wall.trim.add("picture-frame", rim)
    wall.trim.add("mat", face)
    for angle, long in ((-1.05, 0.08), (1.05, 0.12)):
        hand = tilted(boxes([-0.006, -0.046, 0.0], [0.006, -0.043, long]), (0.0, angle, 0.0))
        wall.trim.add("picture-frame", moved(hand, (x, 0.0, z)))
