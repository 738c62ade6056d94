"""Rooms: floor, walls, ceiling and the lamps below it."""

import numpy as np

from render_jobs import Lamp
from whacamole.stage.floor import Floor
from whacamole.stage.shapes import ground_grid
from whacamole.stage.stage import SetBuilder
from whacamole.stage.textures import TEXTURES

__all__ = ["ceiling_lamps", "room"]


def room(
    build: SetBuilder,
    floor: Floor,
    *,
    margin: float,
    height: float,
    floor_texture: tuple[str, float],
    wall_texture: tuple[str, float],
    rng: np.random.Generator,
) -> None:
    """Build floor, four walls and a ceiling around the paths, and bound the camera by them.

    Args:
        margin: from the people's paths to a wall [m].
        height: of the ceiling [m].
        floor_texture, wall_texture: name, and metres after which it repeats.
    """
    low, high = floor.low - margin, floor.high + margin
    floor.bounds = np.stack([low, high])
    build.bounds = ((float(low[0]), float(low[1]), 0.0), (float(high[0]), float(high[1]), height))
    ground_material = build.material("floor", TEXTURES[floor_texture[0]], rng, metres=floor_texture[1])
    build.add("floor", ground_grid(float(np.abs(floor.bounds).max()) + 1.0), ground_material)
    thick = 0.3
    (x0, y0), (x1, y1) = low, high
    middle, length = (low + high) / 2.0, high - low
    walls = {
        "wall-x": ((float(x1 + thick / 2), float(middle[1])), (thick, float(length[1]) + 2 * thick)),
        "wall-y": ((float(middle[0]), float(y1 + thick / 2)), (float(length[0]) + 2 * thick, thick)),
        "wall-minus-x": ((float(x0 - thick / 2), float(middle[1])), (thick, float(length[1]) + 2 * thick)),
        "wall-minus-y": ((float(middle[0]), float(y0 - thick / 2)), (float(length[0]) + 2 * thick, thick)),
    }
    for name, (place, footprint) in walls.items():
        # Each wall has its own grain, so that odometry cannot take one for another.
        material = build.material(name, TEXTURES[wall_texture[0]], rng, metres=wall_texture[1])
        build.add_box(name, (*place, 0.0), (*footprint, height), material)
    ceiling = build.material("ceiling", TEXTURES["plaster"], rng, metres=3.0)
    top = (float(middle[0]), float(middle[1]), height)
    build.add_box("ceiling", top, (float(length[0]) + 0.6, float(length[1]) + 0.6, 0.2), ceiling)


def ceiling_lamps(
    floor: Floor, height: float, power: float, color: tuple[float, float, float], spacing: float
) -> tuple[Lamp, ...]:
    """Hang square lamps below a ceiling, one every ``spacing`` metres, ``power`` watts each."""
    assert floor.bounds is not None, "lamps hang in a room"
    low, high = floor.bounds
    columns, rows = np.maximum(np.round((high - low) / spacing), 1).astype(int)
    lamps = []
    for x in low[0] + (np.arange(columns) + 0.5) * (high[0] - low[0]) / columns:
        for y in low[1] + (np.arange(rows) + 0.5) * (high[1] - low[1]) / rows:
            position = (float(x), float(y), height - 0.05)
            target = (float(x), float(y), 0.0)
            lamps.append(Lamp(position=position, target=target, power_w=power, size=1.2, color=color))
    return tuple(lamps)
