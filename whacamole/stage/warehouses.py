"""A warehouse: gates, racks, goods on pallets, a concrete floor."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from render_jobs import Environment, Lamp, Material
from whacamole.stage.floor import Floor
from whacamole.stage.props import Finishes, furnish, put
from whacamole.stage.props.store import (
    barrels,
    cartons,
    column,
    cone,
    crates,
    pallet_rack,
    pallets,
    trolley,
)
from whacamole.stage.rooms import (
    Rect,
    Room,
    Wall,
    WindowKind,
    beams,
    ceiling_lamps,
    daylight_lamps,
    room,
)
from whacamole.stage.rooms.fitting import Piece, door_in, row_of_windows, stand_against
from whacamole.stage.rooms.lamps import FIXTURES
from whacamole.stage.shapes import Vector
from whacamole.stage.stage import SetBuilder, Stage, one_of
from whacamole.stage.textures import TEXTURES

__all__ = ["warehouse"]

Paths = NDArray[np.float64]


STEELS: tuple[Vector, ...] = ((0.20, 0.32, 0.50), (0.36, 0.40, 0.42), (0.22, 0.36, 0.30))
BEAMS: tuple[Vector, ...] = ((0.86, 0.42, 0.12), (0.86, 0.66, 0.14), (0.72, 0.20, 0.14))
DRUMS: tuple[Vector, ...] = ((0.14, 0.28, 0.50), (0.60, 0.16, 0.12), (0.16, 0.36, 0.26), (0.25, 0.25, 0.26))


def warehouse(rng: np.random.Generator, paths: Paths, folder: Path | None) -> Stage:
    """A store with a concrete floor, pallet racks, crates, barrels, and cold, uneven light."""
    build, floor = SetBuilder(folder), Floor(paths)
    shell = room(floor, margin=float(rng.uniform(5.5, 8.0)), height=float(rng.uniform(5.2, 6.6)))
    windows = _store_shell(shell, floor, rng)
    beam = (0.18, 0.32)
    beams(shell, floor, beam, float(rng.uniform(3.5, 5.0)))
    ground, walls, trim, finishes = _store_materials(build, rng)
    _store_goods(build, floor, shell, finishes, rng)
    kind = str(rng.choice(["bay", "bay", "tubes"]))
    power = float(rng.uniform(240.0, 340.0))
    lamps: list[Lamp] = list(
        ceiling_lamps(shell.trim, floor, shell.height - beam[1], 0.85 * power, (0.88, 0.94, 1.0), 6.0, kind)
    )
    share = 0.25 * power * shell.walls[0].length * shell.walls[1].length / 6.0**2
    for wall, rects in windows:
        lamps += daylight_lamps(wall, rects, share / len(windows), (0.90, 0.95, 1.0))
    shell.finish(build, floor, ground, walls, trim, beam[1] + FIXTURES[kind][1])
    return build.stage("warehouse", tuple(lamps), Environment(color=(0.4, 0.45, 0.5), strength=0.12))


def _store_shell(shell: Room, floor: Floor, rng: np.random.Generator) -> list[tuple[Wall, list[Rect]]]:
    """Cut gates, a door and a band of windows; clad a wall or two with sheet; paint the aisle."""
    gates = int(rng.integers(4))
    wall = shell.walls[gates]
    for x in (-0.25, 0.25) if wall.length > 12.0 and rng.random() < 0.6 else (float(rng.uniform(-0.2, 0.2)),):
        _roller_door(wall, floor, x * wall.length, float(rng.uniform(3.0, 3.6)), float(rng.uniform(3.2, 3.8)))
    side = shell.walls[(gates + 1) % 4]
    door_in(side, floor, float(rng.choice([-0.4, 0.4])) * side.length)
    top = shell.height - 0.7
    kind = WindowKind(top - float(rng.uniform(0.8, 1.2)), top, 0.05, clear=False)
    lit = [shell.walls[(gates + 1) % 4], shell.walls[(gates + 3) % 4]][: int(rng.integers(1, 3))]
    windows = [(wall, row_of_windows(wall, float(rng.uniform(1.6, 2.6)), 0.6, kind, rng)) for wall in lit]
    if rng.random() < 0.5:
        for wall in shell.walls:
            _cladding(wall, kind.bottom - 0.1, rng)
    for wall in shell.walls:
        half = wall.length / 2 - 2.0
        wall.trim.add_boxes("yellow", [-half, -2.05, 0.0], [half, -1.95, 0.0015])
    return [(wall, rects) for wall, rects in windows if rects]


def _roller_door(wall: Wall, floor: Floor, x: float, width: float, height: float) -> None:
    """Cut a gate closed by slats between rails, its edges banded, its drum above."""
    rect = Rect(x - width / 2, x + width / 2, 0.0, height)
    wall.cut(rect, 0.35)
    z = np.arange(0.0, height, 0.1)
    low = np.column_stack([np.full(len(z), rect.left), 0.05 + 0.0 * z, z])
    high = np.column_stack([np.full(len(z), rect.right), 0.09 + 0.0 * z, np.minimum(z + 0.085, height)])
    wall.trim.add_boxes("slat", low, high)
    wall.trim.add_boxes("dark", [rect.left, 0.075, 0.0], [rect.right, 0.12, height])
    wall.trim.add_boxes("dark", [rect.left, 0.035, 0.0], [rect.right, 0.05, 0.1])
    for k in range(int(height / 0.25)):
        for left in (rect.left - 0.14, rect.right):
            finish = "yellow" if k % 2 == 0 else "dark"
            wall.trim.add_boxes(finish, [left, -0.05, 0.25 * k], [left + 0.14, 0.05, 0.25 * (k + 1)])
    wall.trim.add_boxes("slat", [rect.left - 0.14, -0.08, height], [rect.right + 0.14, 0.05, height + 0.3])
    floor.reserve(np.asarray(wall.place(x, 1.0)[:2]), width / 2)


def _cladding(wall: Wall, top: float, rng: np.random.Generator) -> None:
    """Clad the wall with ribbed sheet between its openings."""
    pitch = float(rng.choice([0.2, 0.25, 0.33]))
    edge = wall.length / 2
    for a, b in wall.gaps(0.0, top):
        left, right = a + (0.15 if a > -edge else 0.0), b - (0.15 if b < edge else 0.0)
        if right - left < pitch:
            continue
        wall.trim.add_boxes("sheet", [left, -0.008, 0.1], [right, 0.0, top])
        ribs = np.arange(left, right - 0.4 * pitch, pitch)
        low = np.column_stack([ribs, np.full(len(ribs), -0.035), np.full(len(ribs), 0.1)])
        wall.trim.add_boxes("sheet", low, low + np.array([0.4 * pitch, 0.035, top - 0.1]))
    for hole in wall.openings:
        above = hole.top + 0.3
        if hole.bottom < top and above < top:
            wall.trim.add_boxes("sheet", [hole.left - 0.15, -0.008, above], [hole.right + 0.15, 0.0, top])


def _store_materials(
    build: SetBuilder, rng: np.random.Generator
) -> tuple[Material, list[Material], dict[str, Material], Finishes]:
    poured = build.material(
        "floor", TEXTURES["poured"], rng, metres=3.2, roughness=float(rng.uniform(0.45, 0.7))
    )
    grey = float(rng.uniform(0.66, 0.84))
    ground = build.tinted(poured, "floor-tinted", (grey, grey, 0.98 * grey))
    cover = str(rng.choice(["blockwork", "blockwork", "concrete", "brick"]))
    covered = build.material(
        "walls", TEXTURES[cover], rng, metres={"blockwork": 1.6, "concrete": 2.6, "brick": 1.2}[cover]
    )
    pale = one_of(rng, ((0.84, 0.84, 0.82), (0.74, 0.76, 0.76), (0.80, 0.77, 0.70)))
    walls = [build.tinted(covered, "wall", pale) if cover == "blockwork" else covered] * 4
    planks = build.material("timber", TEXTURES["timber"], rng, metres=0.6, roughness=0.8)
    board = build.material("cardboard", TEXTURES["cardboard"], rng, metres=0.5, roughness=0.85)
    steel = build.plain("steel", one_of(rng, STEELS), roughness=0.45)
    dark, yellow = (
        build.plain("dark", (0.10, 0.10, 0.11), roughness=0.5),
        build.plain("yellow", (0.86, 0.68, 0.12)),
    )
    sheet = float(rng.uniform(0.62, 0.78))
    white = build.plain("white", (0.85, 0.85, 0.84), roughness=0.5)
    trim = {
        "frame": build.plain("frame", (0.50, 0.52, 0.54), roughness=0.5),
        "metal": build.plain("metal", (0.6, 0.6, 0.6), roughness=0.4, metallic=1.0),
        "leaf": build.plain("leaf", (0.45, 0.48, 0.50), roughness=0.5),
        "slat": build.plain("slat", (sheet, sheet, sheet), roughness=0.4),
        "sheet": build.plain("sheet", (sheet, sheet, 1.02 * sheet), roughness=0.45),
        "dark": dark,
        "yellow": yellow,
        "beam": steel,
        "sky": build.plain("sky", (0.86, 0.93, 1.0), glow=1.2),
        "lit": build.plain("lit", (0.92, 0.97, 1.0), glow=4.0),
        "housing": build.plain("housing", (0.55, 0.56, 0.57), roughness=0.4),
        "ceiling": build.plain("ceiling", (0.60, 0.61, 0.62), roughness=0.8),
    }
    finishes: Finishes = {
        "timber": tuple(
            build.tinted(planks, f"planks-{k}", c)
            for k, c in enumerate(((0.84, 0.68, 0.47), (0.68, 0.54, 0.38), (0.62, 0.57, 0.50)))
        ),
        "cardboard": (board, build.tinted(board, "cardboard-pale", (0.95, 0.93, 0.90))),
        "upright": (steel,),
        "steel": (steel,),
        "beam": (build.plain("rack-beam", one_of(rng, BEAMS), roughness=0.45),),
        "drum": tuple(build.plain(f"drum-{k}", c, roughness=0.4) for k, c in enumerate(DRUMS)),
        "drum-other": (build.plain("drum-other", DRUMS[int(rng.integers(len(DRUMS)))], roughness=0.4),),
        "metal": (trim["metal"],),
        "yellow": (yellow,),
        "black": (dark,),
        "white": (white,),
        "orange": (build.plain("orange", (0.90, 0.36, 0.10), roughness=0.6),),
    }
    return ground, walls, trim, finishes


def _store_goods(
    build: SetBuilder, floor: Floor, shell: Room, finishes: Finishes, rng: np.random.Generator
) -> None:
    """Columns and racks along the walls, goods before them and about."""
    index = 0
    for wall in shell.walls[:: int(rng.choice([1, 2]))]:
        for x in np.linspace(-0.5, 0.5, max(2, round(wall.length / 5.5)) + 1)[1:-1]:
            pieces = [Piece(column(shell.height - 0.35))]
            at = float(x) * wall.length
            rect = Rect(at - 0.2, at + 0.2, 0.0, 3.0)
            if wall.is_free(rect):
                wall.take(rect)
                base = wall.place(at, pieces[0].distance)
                floor.reserve(np.asarray(base[:2]), 0.3)
                put(build, f"column-{index}", pieces[0].prop, base, wall.yaw, finishes, rng)
                index += 1
    makers = [pallet_rack] * int(rng.integers(3, 6)) + [
        cartons,
        pallets,
        crates,
        barrels,
        cartons,
        crates,
        barrels,
        trolley,
    ]
    for index, make in enumerate(makers):
        for k in rng.permutation(4):
            pieces = [Piece(make(rng))]
            if (
                stand_against(
                    build, floor, shell.walls[int(k)], f"goods-{index}", pieces, finishes, rng, clearance=2.6
                )
                is not None
            ):
                break
    loose = (crates, barrels, cartons, pallets, trolley, cone, cone)
    furnish(build, floor, loose, int(rng.integers(4, 9)), finishes, rng, beyond=6.0, clearance=2.6)
