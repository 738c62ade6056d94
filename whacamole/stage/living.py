"""A home: a large lived-in room, furniture along its walls, by day or in the evening."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from render_jobs import Environment, Lamp, Material
from whacamole.stage.floor import Floor
from whacamole.stage.props import Finishes
from whacamole.stage.props.decoration import floor_lamp, plant
from whacamole.stage.props.seats import armchair, chair, pouf, sofa
from whacamole.stage.props.storage import bookcase, kitchen, sideboard, television
from whacamole.stage.props.tables import coffee_table, desk, dining_table
from whacamole.stage.rooms import (
    Rect,
    Room,
    Wall,
    WindowKind,
    ceiling_lamps,
    clock,
    cornice,
    curtains,
    daylight_lamps,
    radiator,
    room,
    skirting,
    wainscot,
)
from whacamole.stage.rooms.fitting import Piece, door_in, hang_pictures, row_of_windows, stand_against
from whacamole.stage.shapes import Vector, box
from whacamole.stage.stage import SetBuilder, Stage, one_of
from whacamole.stage.textures import TEXTURES
from whacamole.stage.textures.floors import BOARDS_METRES, HERRINGBONE_METRES

__all__ = ["living_room"]

CLEARANCE = 2.2
"""From the people's paths to furniture [m]."""

PAINTS: tuple[Vector, ...] = (
    (0.93, 0.91, 0.87),
    (0.90, 0.89, 0.87),
    (0.86, 0.85, 0.80),
    (0.82, 0.85, 0.80),
    (0.82, 0.85, 0.88),
    (0.90, 0.84, 0.76),
    (0.88, 0.82, 0.80),
    (0.78, 0.80, 0.80),
)
ACCENTS: tuple[Vector, ...] = (
    (0.45, 0.53, 0.50),
    (0.36, 0.43, 0.52),
    (0.66, 0.50, 0.42),
    (0.55, 0.56, 0.48),
    (0.52, 0.50, 0.50),
)
"""Of walls: pale, and of the one wall that is not."""

WOODS: tuple[Vector, ...] = (
    (0.72, 0.56, 0.40),
    (0.84, 0.72, 0.56),
    (0.45, 0.31, 0.22),
    (0.58, 0.42, 0.29),
    (0.30, 0.22, 0.18),
)
FABRICS: tuple[Vector, ...] = (
    (0.62, 0.61, 0.59),
    (0.76, 0.71, 0.63),
    (0.36, 0.38, 0.41),
    (0.28, 0.35, 0.43),
    (0.36, 0.42, 0.35),
    (0.55, 0.40, 0.31),
    (0.48, 0.45, 0.42),
)
CUSHIONS: tuple[Vector, ...] = (
    (0.80, 0.62, 0.25),
    (0.24, 0.46, 0.48),
    (0.70, 0.36, 0.26),
    (0.86, 0.82, 0.75),
    (0.55, 0.28, 0.32),
    (0.45, 0.52, 0.40),
)

FLOORS = (
    ("boards", BOARDS_METRES),
    ("boards", BOARDS_METRES),
    ("herringbone", HERRINGBONE_METRES),
    ("floor-tiles", 1.8),
    ("carpet", 1.6),
)
"""Kinds, and metres after which they repeat."""


def living_room(rng: np.random.Generator, paths: NDArray[np.float64], folder: Path | None) -> Stage:
    """A lived-in room with windows, furniture along the walls, pictures and warm lamps."""
    build, floor = SetBuilder(folder), Floor(paths)
    shell = room(floor, margin=float(rng.uniform(4.2, 5.2)), height=float(rng.uniform(2.7, 3.3)))
    by_day = bool(rng.random() < 0.75)
    ground, walls, trim, finishes = _paint(build, by_day, rng)
    windows = _open_up(shell, floor, rng)
    _furnish(build, floor, shell, finishes, rng)
    _dress(shell, floor, rng)
    kind = str(rng.choice(["bowl", "bowl", "panel"]))
    warm = (1.0, float(rng.uniform(0.90, 0.95)), float(rng.uniform(0.80, 0.88)))
    power = float(rng.uniform(70.0, 110.0))
    lamps: list[Lamp] = list(
        ceiling_lamps(shell.trim, floor, shell.height, power * (0.65 if by_day else 1.0), warm, 3.2, kind)
    )
    if by_day:
        share = power * 0.45 * shell.walls[0].length * shell.walls[1].length / 3.2**2
        for wall, rects in windows:
            lamps += daylight_lamps(wall, rects, share / len(windows), (0.93, 0.96, 1.0))
    shell.finish(build, floor, ground, walls, trim, 0.14)
    return build.stage("living-room", tuple(lamps), Environment(color=(0.5, 0.5, 0.5), strength=0.15))


def _paint(
    build: SetBuilder, by_day: bool, rng: np.random.Generator
) -> tuple[Material, list[Material], dict[str, Material], Finishes]:
    """Return the floor's material, the walls', those of what is fixed, and those of the furniture."""
    name, metres = FLOORS[int(rng.integers(len(FLOORS)))]
    ground = build.material(
        "floor", TEXTURES[name], rng, metres=metres, roughness=float(rng.uniform(0.4, 0.6))
    )
    cover = "wallpaper" if rng.random() < 0.3 else "paint"
    covered = build.material("walls", TEXTURES[cover], rng, metres=1.2 if cover == "wallpaper" else 2.4)
    plain = one_of(rng, PAINTS)
    colors = [plain] * 4
    if rng.random() < 0.5:
        colors[int(rng.integers(4))] = one_of(rng, ACCENTS)
    walls = [build.tinted(covered, f"wall-{index}", color) for index, color in enumerate(colors)]
    timber = build.material("timber", TEXTURES["timber"], rng, metres=0.8, roughness=0.5)
    weave = build.material("weave", TEXTURES["weave"], rng, metres=0.35, roughness=0.95)
    wood, other, white = one_of(rng, WOODS), one_of(rng, WOODS), float(rng.uniform(0.82, 0.92))
    frame = build.plain("frame", (white, white, 0.97 * white), roughness=0.45)
    dark = build.plain("dark", (0.13, 0.13, 0.14), roughness=0.45)
    metal = build.plain("metal", (0.62, 0.61, 0.59), roughness=0.35, metallic=1.0)
    leaf = frame if rng.random() < 0.6 else build.tinted(timber, "leaf", wood)
    art = build.material("art", TEXTURES["art"], rng, metres=1.0, roughness=0.6)
    sky, far, near = _outdoors(build, by_day)
    lit = build.plain("lit", (1.0, 0.95, 0.86), glow=3.0)
    trim = {
        "frame": frame,
        "leaf": leaf,
        "metal": metal,
        "sky": sky,
        "far": far,
        "near": near,
        "lit": lit,
        "art": art,
        "housing": build.plain("housing", (0.82, 0.82, 0.80), roughness=0.5),
        "curtain": build.tinted(weave, "curtain", one_of(rng, (*CUSHIONS, *FABRICS[:2], *PAINTS[:3]))),
        "picture-frame": dark if rng.random() < 0.5 else build.tinted(timber, "picture-frame", other),
        "mat": build.plain("mat", (0.93, 0.92, 0.89), roughness=0.8),
        "rug": build.material("rug", TEXTURES["rug"], rng, metres=1.0, roughness=0.95),
        "ceiling": build.plain("ceiling", (0.92, 0.92, 0.90), roughness=0.9),
    }
    fabrics = [build.tinted(weave, f"fabric-{k}", one_of(rng, FABRICS)) for k in range(2)]
    accents = [build.tinted(weave, f"accent-{k}", one_of(rng, CUSHIONS)) for k in range(2)]
    seat = accents[0] if rng.random() < 0.4 else build.tinted(timber, "seat", wood)
    finishes: Finishes = {
        "wood": (build.tinted(timber, "wood-0", wood), build.tinted(timber, "wood-1", other)),
        "white": (build.plain("white", (0.86, 0.86, 0.84), roughness=0.4),),
        "fabric": tuple(fabrics),
        "accent": tuple(accents),
        "seat": (seat,),
        "dark": (dark,),
        "metal": (metal,),
        "things": (build.material("things", TEXTURES["palette"], rng, metres=1.0, roughness=0.5),),
        "leaves": (build.plain("leaves", (0.20, 0.36, 0.16), roughness=0.5),),
        "screen": (build.plain("screen", (0.02, 0.02, 0.025), roughness=0.12),),
        "shade": (build.plain("shade", (1.0, 0.88, 0.68), glow=1.3),),
    }
    return ground, walls, trim, finishes


def _outdoors(build: SetBuilder, by_day: bool) -> tuple[Material, Material, Material]:
    """Return what is seen through windows: the sky, what is far under it, what is near."""
    if by_day:
        return (
            build.plain("sky", (0.88, 0.94, 1.0), glow=1.5),
            build.plain("far", (0.70, 0.76, 0.80), glow=0.9),
            build.plain("near", (0.50, 0.58, 0.44), glow=0.6),
        )
    return (
        build.plain("sky", (0.10, 0.13, 0.22), roughness=0.15, glow=0.5),
        build.plain("far", (0.05, 0.06, 0.09), roughness=0.15, glow=0.3),
        build.plain("near", (0.03, 0.035, 0.05), roughness=0.15, glow=0.2),
    )


def _open_up(shell: Room, floor: Floor, rng: np.random.Generator) -> list[tuple[Wall, list[Rect]]]:
    """Cut doors and windows; hang curtains and radiators. Returns the windows of the walls that have any."""
    low, skirt = bool(rng.random() < 0.3), float(rng.uniform(0.08, 0.14))
    kind = WindowKind(
        0.1 if low else float(rng.uniform(0.82, 0.95)),
        float(rng.uniform(2.15, 2.35)),
        float(rng.uniform(0.05, 0.075)),
        bool(rng.random() < 0.4),
    )
    first = int(rng.integers(4))
    sides = [first] if rng.random() < 0.4 else [first, (first + int(rng.integers(1, 3))) % 4]
    for wall in (shell.walls[k] for k in range(4) if k not in sides):
        if rng.random() < 0.75:
            door_in(wall, floor, float(rng.uniform(-0.42, 0.42)) * wall.length, int(rng.choice([1, 1, 2])))
    width, gap = float(rng.uniform(1.0, 1.9)), float(rng.uniform(0.9, 1.8))
    windows = [(shell.walls[k], row_of_windows(shell.walls[k], width, gap, kind, rng)) for k in sides]
    with_curtains, panels = bool(rng.random() < 0.75), bool(rng.random() < 0.25) and not low
    for wall, rects in windows:
        for rect in rects:
            if with_curtains:
                curtains(wall, rect, low or bool(rng.random() < 0.7), rng)
            if not low:
                radiator(wall, (rect.left + rect.right) / 2, 0.8 * width)
    molded = bool(rng.random() < 0.5)
    for wall in shell.walls:
        skirting(wall, skirt)
        if panels:
            wainscot(wall, 0.8)
        if molded:
            cornice(wall)
    return [(wall, rects) for wall, rects in windows if rects]


def _seating(rng: np.random.Generator) -> list[Piece]:
    """A sofa, a low table before it, armchairs beside the table, a lamp in the corner."""
    couch, table = sofa(rng), coffee_table(rng)
    wide, deep, _ = couch.size
    middle = deep + 0.4 + table.size[1] / 2.0
    pieces = [Piece(couch), Piece(table, float(rng.uniform(-0.2, 0.2)), middle)]
    side = 1.0 if rng.random() < 0.5 else -1.0
    lamp = floor_lamp(rng)
    pieces.append(Piece(lamp, -side * (wide / 2 + 0.3), 0.35))
    if rng.random() < 0.75:
        easy = armchair(rng)
        away = table.size[0] / 2.0 + 0.45 + easy.size[1] / 2.0
        pieces.append(Piece(easy, side * max(away, 0.9), deep + 0.25, side * float(rng.uniform(-1.5, -0.9))))
    return pieces


def _dining(rng: np.random.Generator) -> list[Piece]:
    """A table with chairs on its long sides."""
    table, seat = dining_table(rng), chair(rng)
    wide, deep, _ = table.size
    away = 0.35 + seat.size[1] + deep / 2
    pieces = [Piece(table, 0.0, away)]
    for x in (-wide / 4, wide / 4):
        for side, turn in ((1.0, 0.0), (-1.0, np.pi)):
            drawn_up = deep / 2 + float(rng.uniform(0.18, 0.34))
            pieces.append(
                Piece(
                    seat,
                    x + float(rng.uniform(-0.06, 0.06)),
                    away - side * drawn_up,
                    turn + float(rng.normal(0.0, 0.08)),
                )
            )
    return pieces


def _reading(rng: np.random.Generator) -> list[Piece]:
    """An armchair askew, a lamp behind it."""
    easy, lamp = armchair(rng), floor_lamp(rng)
    turn = float(rng.uniform(-0.5, 0.5))
    return [Piece(easy, 0.0, 0.75, turn), Piece(lamp, 0.75, 0.32), Piece(pouf(rng), -0.85, 0.95)]


def _work(rng: np.random.Generator) -> list[Piece]:
    """A desk, its chair drawn up."""
    table = desk(rng)
    return [Piece(table), Piece(chair(rng), -0.15, table.size[1] + 0.3, np.pi + float(rng.normal(0.0, 0.2)))]


def _furnish(
    build: SetBuilder, floor: Floor, shell: Room, finishes: Finishes, rng: np.random.Generator
) -> None:
    """Stand groups of furniture along the walls, the largest first."""
    groups = [("seating", _seating(rng)), ("dining", _dining(rng)), ("tv", [Piece(television(rng))])]
    if rng.random() < 0.35:
        groups.append(("kitchen", [Piece(kitchen(rng))]))
    groups += [("books", [Piece(bookcase(rng))]) for _ in range(int(rng.integers(1, 4)))]
    groups += [("board", [Piece(sideboard(rng))]) for _ in range(int(rng.integers(1, 3)))]
    if rng.random() < 0.5:
        groups.append(("work", _work(rng)))
    groups.append(("reading", _reading(rng)))
    if rng.random() < 0.5:
        groups.append(("lounge", _seating(rng)))
    groups += [("plant", [Piece(plant(rng))]) for _ in range(int(rng.integers(3, 7)))]
    for index, (name, pieces) in enumerate(groups):
        for wall in rng.permutation(4):
            side = shell.walls[int(wall)]
            middle = stand_against(
                build, floor, side, f"{name}-{index}", pieces, finishes, rng, clearance=CLEARANCE
            )
            if middle is not None:
                if name in ("seating", "lounge"):
                    _lay_rug(side, pieces[1], middle, rng)
                break


def _lay_rug(wall: Wall, table: Piece, middle: float, rng: np.random.Generator) -> None:
    wide, deep = float(rng.uniform(2.0, 2.8)), float(rng.uniform(1.3, 1.7))
    at = (middle + table.x, -table.distance, 0.0)
    wall.trim.add("rug", box(at, (wide, deep, 0.006)))


def _dress(shell: Room, floor: Floor, rng: np.random.Generator) -> None:
    """Hang pictures and a clock, and lay a rug under the people where they keep to one place."""
    for wall in shell.walls:
        hang_pictures(wall, int(wall.length / float(rng.uniform(1.6, 3.0))), rng)
    wall = shell.walls[int(rng.integers(4))]
    x = wall.spot(rng, 0.4, 1.8, 2.2, 0.5)
    if x is not None:
        clock(wall, x, 2.0)
    size = floor.high - floor.low
    if size.max() < 3.0 and rng.random() < 0.5:
        middle = (floor.low + floor.high) / 2.0
        wide, deep = size + rng.uniform(1.2, 2.0, 2)
        shell.trim.add(
            "rug", box((float(middle[0]), float(middle[1]), 0.0), (float(wide), float(deep), 0.004))
        )
