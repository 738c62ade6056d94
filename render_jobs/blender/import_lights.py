"""Lamps and surroundings of a Blender scene as plain values."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from render_jobs.blender.import_images import Images
from render_jobs.blender.lights import SKY_STRENGTH
from render_jobs.colour import srgb
from render_jobs.scene import Environment, Lamp, Sun

DULL = 0.06
"""A plain grey world up to this radiance is what Blender starts with, and no light anybody chose."""


def read_light(data: Any, matrix: NDArray[np.float64], unit: float) -> Sun | Lamp | None:
    """A lamp or sun, or None where it is dark.

    Args:
        data: Blender's light.
        matrix: (4, 4) light to world [m].
        unit: metres a Blender unit.
    """
    strongest = max(*data.color, 1e-9)
    energy = float(data.energy) * strongest * 2.0 ** float(getattr(data, "exposure", 0.0))
    if energy <= 0.0:
        return None
    color = srgb([channel / strongest for channel in data.color])
    axis = -matrix[:3, 2] / np.linalg.norm(matrix[:3, 2])
    direction = (float(axis[0]), float(axis[1]), float(axis[2]))
    if data.type == "SUN":
        return Sun(direction=direction, strength=energy, angle=math.degrees(data.angle), color=color)
    position, target = matrix[:3, 3], matrix[:3, 3] + axis
    kind = {"AREA": "area", "SPOT": "spot"}.get(data.type, "point")
    return Lamp(
        kind=kind,  # type: ignore[arg-type]
        position=(float(position[0]), float(position[1]), float(position[2])),
        target=(float(target[0]), float(target[1]), float(target[2])),
        power_w=energy,
        size=max(_size(data, matrix, unit), 0.01),
        color=color,
        spot_angle=min(max(math.degrees(data.spot_size), 1.0), 179.0) if kind == "spot" else 60.0,
    )


def _size(data: Any, matrix: NDArray[np.float64], unit: float) -> float:
    """Diameter [m] of the disc or ball as large as the light."""
    if data.type != "AREA":
        return 2.0 * float(data.shadow_soft_size) * unit
    across, along = np.linalg.norm(matrix[:3, 0]) * data.size, np.linalg.norm(matrix[:3, 1]) * data.size
    if data.shape in ("RECTANGLE", "ELLIPSE"):
        along = np.linalg.norm(matrix[:3, 1]) * data.size_y
    area = across * along * (1.0 if data.shape in ("SQUARE", "RECTANGLE") else math.pi / 4)
    return float(math.sqrt(area * 4 / math.pi))


def read_world(world: Any, images: Images) -> Environment | None:
    """The surroundings, or None where the scene has none that anybody chose."""
    if world is None:
        return None
    tree = world.node_tree if world.use_nodes else None
    background = next((node for node in tree.nodes if node.type == "BACKGROUND"), None) if tree else None
    if background is None:
        return _one_color(world.color, 1.0)
    strength = float(background.inputs["Strength"].default_value)
    socket = background.inputs["Color"]
    if not socket.is_linked:
        return _one_color(socket.default_value[:3], strength)
    source = socket.links[0].from_node
    if source.type == "TEX_ENVIRONMENT" and source.image is not None:
        copied = images.surroundings(source.image)
        if copied is not None:
            return Environment(kind="hdri", hdri=copied, strength=strength, rotation=_rotation(source))
    if source.type == "TEX_SKY":
        elevation = min(max(math.degrees(source.sun_elevation), -10.0), 90.0)
        turn = 90.0 - math.degrees(source.sun_rotation)
        return Environment(
            kind="sky", sun_elevation=elevation, rotation=turn, strength=strength / SKY_STRENGTH
        )
    images.note("the world's nodes are too involved; the surroundings are left out")
    return None


def _one_color(color: Any, strength: float) -> Environment | None:
    if max(color) * strength <= DULL:
        return None
    brightest = max(*color, 1e-9)
    shown = srgb([channel / brightest for channel in color])
    return Environment(kind="color", color=shown, strength=strength * brightest)


def _rotation(node: Any) -> float:
    """Degrees about z by a Mapping node before the map."""
    socket = node.inputs["Vector"]
    before = socket.links[0].from_node if socket.is_linked else None
    if before is None or before.type != "MAPPING":
        return 0.0
    return -math.degrees(before.inputs["Rotation"].default_value[2])
