"""The job's lights and surroundings as what a shader can take: a few lights, two ambient colours, a sky
image.

Units follow Blender's: a sun's strength is irradiance; a lamp of P watts has the radiant intensity P/4π all
around, or P/π along the axis of a flat one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render_jobs.colour import linear
from render_jobs.raster.surroundings import Surroundings
from render_jobs.scene import Lamp, Sun

Floats = NDArray[np.float32]

MAX_LIGHTS = 16
AROUND = -2.0
"""The cosine that stands for a lamp that shines all around."""


@dataclass(frozen=True)
class LightArrays:
    """Uniforms of the picture shader, one row a light; the shadow is that of the first one at infinity."""

    position: Floats
    color: Floats
    axis: Floats
    flat: list[bool]

    @property
    def shadow_of(self) -> int:
        """The index of the light with a shadow, −1 for none."""
        distant = np.flatnonzero(self.position[:, 3] == 0.0)
        return int(distant[0]) if len(distant) else -1


def light_arrays(lights: tuple[Sun | Lamp, ...], surroundings: Surroundings) -> LightArrays:
    """All lights and the environment's sun; the brightest sun comes first, as it gets the shadow."""
    rows = [_row(light) for light in lights]
    if surroundings.sun is not None:
        towards, irradiance = surroundings.sun
        rows.append(((*towards, 0.0), irradiance, (0.0, 0.0, -1.0, AROUND), False))
    rows.sort(key=lambda row: (row[0][3], -float(np.sum(row[1]))))
    rows = rows[:MAX_LIGHTS]
    return LightArrays(
        np.array([row[0] for row in rows], np.float32).reshape(-1, 4),
        np.array([row[1] for row in rows], np.float32).reshape(-1, 3),
        np.array([row[2] for row in rows], np.float32).reshape(-1, 4),
        [row[3] for row in rows],
    )


Row = tuple[tuple[float, ...], Floats, tuple[float, ...], bool]


def _row(light: Sun | Lamp) -> Row:
    color = np.asarray(linear(light.color), np.float32)
    if isinstance(light, Sun):
        towards = -_unit(light.direction)
        return (*towards, 0.0), color * np.float32(light.strength), (*-towards, AROUND), False
    axis = _unit(np.subtract(light.target, light.position))
    flat = light.kind == "area"
    intensity = light.power_w / (math.pi if flat else 4 * math.pi)
    opening = {"area": 0.0, "point": AROUND, "spot": math.cos(math.radians(light.spot_angle / 2))}[light.kind]
    return (*light.position, 1.0), color * np.float32(intensity), (*axis, opening), flat


def _unit(vector: object) -> NDArray[np.float64]:
    value = np.asarray(vector, np.float64)
    unit: NDArray[np.float64] = value / np.linalg.norm(value)
    return unit
