"""What lies under a stage outdoors and lights it: the ground, daylight."""

import numpy as np

from render_jobs import Environment, Sun
from whacamole.stage.floor import Floor
from whacamole.stage.shapes import ground_grid
from whacamole.stage.stage import SetBuilder
from whacamole.stage.textures import TEXTURES

__all__ = ["daylight", "ground"]

HORIZON = 260.0
"""How far the ground reaches beyond the people's paths [m]: under the foot of the farthest hills."""


def ground(
    build: SetBuilder,
    floor: Floor,
    texture: str,
    metres: float,
    rng: np.random.Generator,
    beyond: float = HORIZON,
) -> None:
    """Lay the ground, ``beyond`` metres farther than the people's paths reach.

    Args:
        texture, metres: name, and metres after which it repeats.
    """
    material = build.material("ground", TEXTURES[texture], rng, metres=metres)
    build.add("ground", ground_grid(floor.reach + beyond), material)


def daylight(rng: np.random.Generator, elevation: tuple[float, float]) -> tuple[Sun, Environment]:
    """Draw a sun between two elevations [degrees] and the sky that goes with it; a low sun is warmer."""
    height, azimuth = float(rng.uniform(*elevation)), float(rng.uniform(0.0, 360.0))
    up, around = np.radians(height), np.radians(azimuth)
    warmth = float(np.clip((40.0 - height) / 40.0, 0.0, 1.0))
    sun = Sun(
        direction=(-np.cos(up) * np.cos(around), -np.cos(up) * np.sin(around), -np.sin(up)),
        strength=float(rng.uniform(2.2, 3.6)),
        angle=1.0,
        color=(1.0, 0.97 - 0.07 * warmth, 0.92 - 0.2 * warmth),
    )
    sky = Environment(
        kind="sky", sun_elevation=height, rotation=azimuth, strength=float(rng.uniform(1.0, 1.5))
    )
    return sun, sky
