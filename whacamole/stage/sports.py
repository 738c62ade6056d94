"""A sports hall: a marked floor, what stands along its walls, high windows."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from render_jobs import Environment, Lamp, Material
from whacamole.stage.courts import COURTS, court_lines
from whacamole.stage.floor import CLEARANCE, Floor
from whacamole.stage.props import Finishes, furnish, put
from whacamole.stage.props.sports import ball_cage, goal, gym_bench, hoop, mats, vaulting_box, wall_bars
from whacamole.stage.rooms import (
    Rect,
    Room,
    Wall,
    WindowKind,
    beams,
    ceiling_lamps,
    clock,
    daylight_lamps,
    room,
    skirting,
)
from whacamole.stage.rooms.fitting import Piece, door_in, row_of_windows, stand_against
from whacamole.stage.rooms.lamps import FIXTURES
from whacamole.stage.shapes import Vector
from whacamole.stage.stage import SetBuilder, Stage, one_of
from whacamole.stage.textures import TEXTURES
from whacamole.stage.textures.floors import BOARDS_METRES

__all__ = ["sports_hall"]

Paths = NDArray[np.float64]

SPORT_FLOORS: tuple[Vector, ...] = (
    (0.45, 0.58, 0.66),
    (0.42, 0.55, 0.48),
    (0.78, 0.58, 0.38),
    (0.62, 0.62, 0.60),
)
PANELS: tuple[Vector, ...] = ((0.86, 0.70, 0.50), (0.78, 0.60, 0.42), (0.42, 0.52, 0.62), (0.75, 0.76, 0.74))
PALE: tuple[Vector, ...] = ((0.92, 0.91, 0.88), (0.86, 0.87, 0.86), (0.90, 0.86, 0.78))
LINES: tuple[Vector, ...] = (
    (0.92, 0.92, 0.90),
    (0.85, 0.20, 0.16),
    (0.90, 0.75, 0.20),
    (0.15, 0.25, 0.50),
    (0.12, 0.12, 0.12),
)
MATS: tuple[Vector, ...] = ((0.16, 0.32, 0.58), (0.14, 0.42, 0.36), (0.62, 0.18, 0.16))


def sports_hall(rng: np.random.Generator, paths: Paths, folder: Path | None) -> Stage:
    """A hall with a marked floor, wall bars, benches, mats and hoops under high windows."""
    build, floor = SetBuilder(folder), Floor(paths)
    shell = room(floor, margin=float(rng.uniform(6.0, 9.0)), height=float(rng.uniform(5.8, 7.0)))
    windows = _hall_shell(shell, floor, rng)
    _mark_court(shell, floor, rng)
    beam = (0.2, float(rng.uniform(0.4, 0.6)))
    beams(shell, floor, beam, float(rng.uniform(3.5, 5.0)))
    ground, walls, trim, finishes = _hall_materials(build, rng)
    _hall_furniture(build, floor, shell, finishes, rng)
    kind = str(rng.choice(["tubes", "tubes", "panel", "bay"]))
    power = float(rng.uniform(260.0, 380.0))
    lamps: list[Lamp] = list(
        ceiling_lamps(shell.trim, floor, shell.height - beam[1], 0.75 * power, (1.0, 0.98, 0.95), 5.0, kind)
    )
    share = 0.35 * power * shell.walls[0].length * shell.walls[1].length / 5.0**2
    for wall, rects in windows:
        lamps += daylight_lamps(wall, rects, share / len(windows), (0.93, 0.96, 1.0))
    shell.finish(build, floor, ground, walls, trim, beam[1] + FIXTURES[kind][1])
    return build.stage("sports-hall", tuple(lamps), Environment(color=(0.6, 0.65, 0.7), strength=0.15))


def _hall_shell(shell: Room, floor: Floor, rng: np.random.Generator) -> list[tuple[Wall, list[Rect]]]:
    """Cut doors and high windows, and panel the walls as high as balls fly."""
    first = int(rng.integers(2))
    top = shell.height - float(rng.uniform(0.7, 1.0))
    kind = WindowKind(top - float(rng.uniform(1.0, 1.6)), top, 0.07, clear=bool(rng.random() < 0.5))
    for wall in (shell.walls[1 - first], shell.walls[3 - first]):
        door_in(wall, floor, float(rng.uniform(-0.35, 0.35)) * wall.length, 2)
    sides = [shell.walls[first], shell.walls[first + 2]][: int(rng.integers(1, 3))]
    width, gap = float(rng.uniform(1.8, 2.8)), float(rng.uniform(0.25, 1.0))
    windows = [(wall, row_of_windows(wall, width, gap, kind, rng)) for wall in sides]
    panel = float(rng.uniform(2.2, 2.8))
    for wall in shell.walls:
        _panelling(wall, panel)
        skirting(wall, 0.1)
    wall = shell.walls[1 - first]
    clock(wall, 0.3 * wall.length, 3.4)
    return [(wall, rects) for wall, rects in windows if rects]


def _panelling(wall: Wall, height: float) -> None:
    """Clad the wall with boards a metre and a bit wide, with joints between them."""
    for a, b in wall.gaps(0.0, height):
        edges = np.linspace(a, b, max(1, round((b - a) / 1.1)) + 1)
        low = np.column_stack([edges[:-1] + 0.004, np.full(len(edges) - 1, -0.012), np.zeros(len(edges) - 1)])
        high = np.column_stack([edges[1:] - 0.004, np.zeros(len(edges) - 1), np.full(len(edges) - 1, height)])
        inside = high[:, 0] > low[:, 0]
        if inside.any():
            wall.trim.add_boxes("panel", low[inside], high[inside])
    for hole in wall.openings:
        if hole.bottom < height:
            wall.trim.add_boxes("panel", [hole.left, -0.012, hole.top + 0.08], [hole.right, 0.0, height])


def _mark_court(shell: Room, floor: Floor, rng: np.random.Generator) -> None:
    """Paint the largest court that fits, and a smaller one in another colour."""
    assert floor.bounds is not None
    middle = floor.bounds.mean(axis=0)
    size = floor.bounds[1] - floor.bounds[0] - 1.6
    yaw = 0.0 if size[0] >= size[1] else np.pi / 2
    long, short = float(size.max()), float(size.min())
    fitting = [kind for kind, (length, width) in COURTS.items() if length <= long and width <= short]
    for index, kind in enumerate(fitting[:2]):
        shell.trim.add(f"line-{index}", court_lines(kind, middle, yaw))
    if not fitting:
        shell.trim.add("line-0", court_lines("badminton", middle + rng.uniform(-1.0, 1.0, 2), yaw))


def _hall_materials(
    build: SetBuilder, rng: np.random.Generator
) -> tuple[Material, list[Material], dict[str, Material], Finishes]:
    if rng.random() < 0.55:
        ground = build.material("floor", TEXTURES["boards"], rng, metres=0.6 * BOARDS_METRES, roughness=0.35)
    else:
        ground = build.material("floor", TEXTURES["poured"], rng, metres=3.0, roughness=0.4)
        ground = build.tinted(ground, "floor-tinted", one_of(rng, SPORT_FLOORS))
    cover = str(rng.choice(["blockwork", "blockwork", "paint", "brick"]))
    covered = build.material(
        "walls", TEXTURES[cover], rng, metres={"blockwork": 1.6, "paint": 2.4, "brick": 1.2}[cover]
    )
    walls = [covered if cover == "brick" else build.tinted(covered, "wall", one_of(rng, PALE))] * 4
    timber = build.material("timber", TEXTURES["timber"], rng, metres=0.9, roughness=0.5)
    wood = build.tinted(timber, "wood", (0.82, 0.64, 0.44))
    white = build.plain("white", (0.86, 0.86, 0.85), roughness=0.5)
    dark = build.plain("dark", (0.12, 0.12, 0.13), roughness=0.5)
    metal = build.plain("metal", (0.6, 0.6, 0.6), roughness=0.4, metallic=1.0)
    picks = rng.permutation(len(LINES))
    door_color = one_of(rng, ((0.30, 0.42, 0.52), (0.66, 0.24, 0.18), (0.70, 0.70, 0.68), (0.36, 0.46, 0.40)))
    trim = {
        "frame": white,
        "metal": metal,
        "picture-frame": dark,
        "mat": white,
        "leaf": build.plain("leaf", door_color, roughness=0.5),
        "panel": build.tinted(timber, "panel", one_of(rng, PANELS)),
        "beam": build.tinted(timber, "beam", (0.86, 0.70, 0.50)) if rng.random() < 0.6 else white,
        "sky": build.plain("sky", (0.90, 0.95, 1.0), glow=1.5),
        "far": build.plain("far", (0.70, 0.78, 0.82), glow=0.9),
        "near": build.plain("near", (0.48, 0.56, 0.42), glow=0.6),
        "lit": build.plain("lit", (1.0, 0.98, 0.94), glow=4.0),
        "housing": build.plain("housing", (0.75, 0.75, 0.74)),
        "ceiling": build.plain("ceiling", (0.84, 0.84, 0.83), roughness=0.9),
        "line-0": build.plain("line-0", LINES[picks[0]], roughness=0.4),
        "line-1": build.plain("line-1", LINES[picks[1]], roughness=0.4),
    }
    mat = one_of(rng, MATS)
    weave = build.material("weave", TEXTURES["weave"], rng, metres=0.3, roughness=0.6)
    finishes: Finishes = {
        "wood": (wood,),
        "white": (white,),
        "dark": (dark,),
        "metal": (metal,),
        "leather": (build.plain("leather", (0.50, 0.33, 0.20), roughness=0.45),),
        "mat": (build.tinted(weave, "mat-0", mat), build.tinted(weave, "mat-1", one_of(rng, MATS))),
        "band": (build.plain("band", (0.75, 0.14, 0.12)),),
        "ball": (build.plain("ball", (0.80, 0.38, 0.14), roughness=0.7),),
    }
    return ground, walls, trim, finishes


def _hall_furniture(
    build: SetBuilder, floor: Floor, shell: Room, finishes: Finishes, rng: np.random.Generator
) -> None:
    """Hoops on the end walls; bars, benches, mats and goals along all of them; a few things about."""
    ends = sorted(range(4), key=lambda k: shell.walls[k].length)[:2]
    for k in ends:
        wall = shell.walls[k]
        prop = hoop(rng)
        below = prop.size[2]
        base = wall.place(0.0, prop.size[1] / 2 + 0.015, 3.05 + 0.9 - below)
        put(build, f"hoop-{k}", prop, base, wall.yaw, finishes, rng)
    groups = [
        ("bars", wall_bars),
        ("bars", wall_bars),
        ("goal", goal),
        ("mats", mats),
        ("bench", gym_bench),
        ("balls", ball_cage),
        ("bench", gym_bench),
        ("box", vaulting_box),
        ("bars", wall_bars),
        ("mats", mats),
    ]
    for index, (name, make) in enumerate(groups):
        for k in rng.permutation(4):
            pieces = [Piece(make(rng))]
            wall = shell.walls[int(k)]
            if (
                stand_against(
                    build, floor, wall, f"{name}-{index}", pieces, finishes, rng, clearance=CLEARANCE
                )
                is not None
            ):
                break
    furnish(build, floor, (gym_bench, vaulting_box, mats), int(rng.integers(2, 5)), finishes, rng, beyond=7.0)
