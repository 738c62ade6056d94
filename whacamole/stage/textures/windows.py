"""Pictures of what windows show and of what hangs over shops; each picture is a sheet of several."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from PIL import Image as Pictures
from PIL import ImageDraw, ImageFont

from whacamole.stage.textures.painting import Image, clipped, noise

__all__ = ["PANES", "SHOPS", "SIGNS", "posters", "shop_windows", "sign_boards", "window_panes"]

PANES = 4
"""Rows and columns of window panes on their sheet."""

SHOPS = 2
"""Rows and columns of shop windows on theirs."""

SIGNS = 8
"""Boards on their sheet, one above the other."""

TRADES = (
    "BAKERY", "BOOKS", "CAFÉ", "FLOWERS", "OPTICIAN", "PHARMACY", "BICYCLES", "HAIRDRESSER", "WINE",
    "TEA & COFFEE", "SHOES", "TOYS", "RESTAURANT", "GROCER", "TAILOR", "WATCHES", "STATIONER", "HARDWARE",
)  # fmt: skip

BOARDS = (
    ((34, 58, 48), (232, 222, 190)), ((92, 26, 28), (236, 226, 206)), ((28, 42, 74), (230, 232, 236)),
    ((38, 38, 40), (222, 196, 130)), ((226, 218, 200), (52, 44, 38)), ((120, 84, 48), (240, 228, 200)),
    ((198, 204, 200), (128, 32, 30)), ((66, 74, 80), (244, 244, 240)),
)  # fmt: skip
"""Ground and letters, as sRGB bytes."""


def window_panes(rng: np.random.Generator, size: int = 512) -> Image:
    """Sixteen windows seen from outside by day: dark rooms, curtains, nets, blinds, the sky in the glass."""
    return _sheet(_pane, rng, size, PANES)


def _sheet(
    picture: Callable[[np.random.Generator, int], Image], rng: np.random.Generator, size: int, count: int
) -> Image:
    """Lay ``count`` × ``count`` pictures side by side."""
    rows = [np.concatenate([picture(rng, size // count) for _ in range(count)], axis=1) for _ in range(count)]
    return clipped(np.concatenate(rows, axis=0))


def _pane(rng: np.random.Generator, edge: int) -> Image:
    y, x = np.mgrid[0:edge, 0:edge] / edge
    room = rng.uniform(0.05, 0.14) * (1.0 + 0.5 * (0.5 - y))
    image = room[..., None] * np.array([0.92, 1.0, 1.08])
    cloth = rng.uniform(0.42, 0.8) * np.array([1.0, rng.uniform(0.92, 1.0), rng.uniform(0.8, 0.98)])
    folds = 0.85 + 0.15 * np.sin(2.0 * np.pi * (x * rng.uniform(9.0, 16.0) + 0.4 * np.sin(5.0 * y)))
    kind = rng.random()
    if kind < 0.3:  # curtains drawn aside
        hung = np.minimum(x, 1.0 - x) < rng.uniform(0.12, 0.32) + 0.06 * y
        image[hung] = (folds[..., None] * cloth)[hung]
    elif kind < 0.5:  # a net, whole or before the lower half
        veil = 0.65 * (y > rng.choice([0.0, 0.45]))[..., None]
        image = (1.0 - veil) * image + veil * 0.8 * folds[..., None] * cloth
    elif kind < 0.68:  # a blind, part of the way down
        slats = 0.7 + 0.3 * (np.floor(y * 24.0) % 2)
        down = y < rng.uniform(0.25, 1.0)
        image[down] = (slats[..., None] * cloth)[down]
    if rng.random() < 0.35:  # plants on the sill
        for middle in rng.uniform(0.15, 0.85, int(rng.integers(1, 4))):
            leaf = np.hypot((x - middle) * 3.0, y - 0.9) + 0.05 * noise(rng, edge, 0.6, 12.0) < 0.2
            image[leaf] = np.array([0.10, 0.20, 0.08]) * rng.uniform(0.7, 1.4)
    sky = np.clip(1.3 - 1.5 * y - rng.uniform(-0.5, 0.9) * x + 0.10 * noise(rng, edge, 1.8), 0.0, 1.0)
    shine = (rng.uniform(0.0, 0.6) ** 1.5 * sky)[..., None]
    return np.asarray((1.0 - shine) * image + shine * np.array([0.62, 0.72, 0.84]))


def shop_windows(rng: np.random.Generator, size: int = 512) -> Image:
    """Four shops seen through their windows: shelves of goods, lights, a table with what is on offer."""
    return _sheet(_shop, rng, size, SHOPS)


def _shop(rng: np.random.Generator, edge: int) -> Image:
    y, _ = np.mgrid[0:edge, 0:edge] / edge
    image: Image = (0.24 - 0.14 * y)[..., None] * np.array([1.1, 0.98, 0.82]) * rng.uniform(0.7, 1.2)
    shelves = int(rng.integers(2, 5))
    for level in np.linspace(0.28, 0.72, shelves):
        _goods(rng, image, float(level), 0.36 / shelves, 0.55)
        image[int(level * edge) : int((level + 0.02) * edge)] = rng.uniform(0.2, 0.4) * np.array(
            [1.0, 0.85, 0.65]
        )
    _goods(rng, image, 0.92, rng.uniform(0.1, 0.2), 1.0)
    image[int(0.92 * edge) :] = rng.uniform(0.25, 0.6) * np.array([1.0, 0.95, 0.88])
    for middle in (np.arange(4) + rng.uniform(0.2, 0.8)) / 4.0:
        lamp = (
            slice(int(0.05 * edge), int(0.08 * edge)),
            slice(int(middle * edge) - 3, int(middle * edge) + 3),
        )
        image[lamp] = (1.0, 0.92, 0.75)
    return image


def _goods(rng: np.random.Generator, image: Image, level: float, tall: float, light: float) -> None:
    """Stand things of many colours in a row; ``level`` is their underside, ``tall`` the tallest of them."""
    edge, x = len(image), 0.03
    while x < 0.94:
        width, height = rng.uniform(0.02, 0.08), tall * rng.uniform(0.45, 1.0)
        color = light * np.clip(rng.uniform(0.3, 0.8) + rng.normal(0.0, 0.16, 3), 0.05, 1.0)
        rows, columns = ((level - height) * edge, level * edge), (x * edge, min(x + width, 0.97) * edge)
        image[int(rows[0]) : int(rows[1]), int(columns[0]) : int(columns[1])] = color
        x += width + (0.004 if rng.random() < 0.7 else rng.uniform(0.02, 0.09))


def sign_boards(rng: np.random.Generator, size: int = 512) -> Image:
    """Eight boards with the names of trades, each eight times as wide as high."""
    sheet = Pictures.new("RGB", (size, size))
    draw, height = ImageDraw.Draw(sheet), size // SIGNS
    trades, boards = rng.permutation(len(TRADES)), rng.permutation(len(BOARDS))
    for row in range(SIGNS):
        ground, letters = BOARDS[boards[row]]
        top = row * height
        draw.rectangle((0, top, size, top + height), fill=ground)
        draw.rectangle((5, top + 5, size - 6, top + height - 6), outline=letters)
        font = ImageFont.load_default(height * rng.uniform(0.5, 0.66))
        draw.text((size / 2, top + height / 2), TRADES[trades[row]], fill=letters, font=font, anchor="mm")
    return np.asarray(sheet, dtype=np.float64) / 255.0


def posters(rng: np.random.Generator, size: int = 512) -> Image:
    """Bills pasted edge to edge in three rows: grounds of many colours, a figure, a line of large letters."""
    sheet = Pictures.new("RGB", (size, size))
    draw, height = ImageDraw.Draw(sheet), size // 3
    for row in range(3):
        edges = np.concatenate([[0], np.sort(rng.integers(0, size, 3)), [size]])
        for left, right in pairwise(edges.tolist()):
            box = (left, row * height, right, (row + 1) * height)
            ground, ink = (tuple(int(v) for v in rng.integers(low, low + 120, 3)) for low in (110, 20))
            draw.rectangle(box, fill=ground, outline=(225, 222, 214), width=4)
            _bill(draw, box, ink, str(rng.choice(TRADES)))
    return np.asarray(sheet, dtype=np.float64) / 255.0


def _bill(draw: ImageDraw.ImageDraw, box: tuple[int, int, int, int], ink: tuple[int, ...], line: str) -> None:
    left, top, right, bottom = box
    width = right - left
    if width < 40:
        return
    half = min(width, bottom - top) * 0.26
    x, y = (left + right) / 2, top + 0.6 * (bottom - top)
    draw.ellipse((x - half, y - half, x + half, y + half), fill=ink)
    font = ImageFont.load_default(min(30.0, 1.5 * width / len(line)))
    draw.text((x, top + 0.17 * (bottom - top)), line, fill=ink, font=font, anchor="mm")
