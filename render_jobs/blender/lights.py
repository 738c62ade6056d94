"""Lights and surroundings in Blender."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal

import bpy
from mathutils import Vector

from render_jobs.blender.compat import SKY_TYPE
from render_jobs.blender.materials import load_image
from render_jobs.colour import linear
from render_jobs.scene import Environment, Lamp, Sun

LIGHT_TYPES: dict[str, Literal["SUN", "AREA", "POINT", "SPOT"]] = {
    "sun": "SUN",
    "area": "AREA",
    "point": "POINT",
    "spot": "SPOT",
}
SKY_STRENGTH = 0.1
"""Brings the physical sky (about 10 W/m²/sr) to where white paper in daylight is near white at exposure 0."""


def add_light(light: Sun | Lamp, name: str) -> None:
    """Add a sun or lamp to the scene."""
    scene: Any = bpy.context.scene
    data: Any = bpy.data.lights.new(name, LIGHT_TYPES[light.kind])
    data.color = linear(light.color)
    entity = bpy.data.objects.new(name, data)
    scene.collection.objects.link(entity)
    entity.rotation_mode = "QUATERNION"
    if isinstance(light, Sun):
        data.energy = light.strength
        data.angle = math.radians(light.angle)
        entity.rotation_quaternion = _facing(light.direction)
        return
    data.energy = light.power_w
    entity.location = light.position
    towards = [end - start for start, end in zip(light.position, light.target, strict=True)]
    entity.rotation_quaternion = _facing(towards)
    if light.kind == "area":
        data.shape = "DISK"
        data.size = light.size
    else:
        data.shadow_soft_size = light.size / 2
    if light.kind == "spot":
        data.spot_size = math.radians(light.spot_angle)


def _facing(direction: Sequence[float]) -> Any:
    """The rotation that turns a light's axis, −z, into the direction."""
    return Vector(direction).to_track_quat("-Z", "Y")


def set_environment(environment: Environment) -> None:
    """Give the scene its world."""
    scene: Any = bpy.context.scene
    world: Any = bpy.data.worlds.new("world")
    scene.world = world
    world.use_nodes = True
    tree = world.node_tree
    background = tree.nodes["Background"]
    background.inputs["Strength"].default_value = environment.strength
    if environment.kind == "color":
        background.inputs["Color"].default_value = (*linear(environment.color), 1.0)
    elif environment.kind == "sky":
        background.inputs["Strength"].default_value = environment.strength * SKY_STRENGTH
        tree.links.new(_sky(tree, environment).outputs["Color"], background.inputs["Color"])
    else:
        tree.links.new(_hdri(tree, environment).outputs["Color"], background.inputs["Color"])
    if environment.backdrop is not None:
        _show_backdrop(tree, background, environment.backdrop)


def _sky(tree: Any, environment: Environment) -> Any:
    node = tree.nodes.new("ShaderNodeTexSky")
    node.sky_type = SKY_TYPE
    node.sun_disc = False
    node.sun_elevation = math.radians(environment.sun_elevation)
    # Blender counts clockwise from +y, we count counter-clockwise from +x
    node.sun_rotation = math.radians(90.0 - environment.rotation)
    return node


def _hdri(tree: Any, environment: Environment) -> Any:
    node = tree.nodes.new("ShaderNodeTexEnvironment")
    node.image = load_image(hdri_path(environment.hdri), is_color=True)
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    mapping = tree.nodes.new("ShaderNodeMapping")
    # the mapping turns the direction looked up, hence the picture the other way
    mapping.inputs["Rotation"].default_value = (0.0, 0.0, -math.radians(environment.rotation))
    tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], node.inputs["Vector"])
    return node


def hdri_path(hdri: str | Path) -> Path:
    """The file of an environment map; a name is one that comes with Blender."""
    if isinstance(hdri, Path):
        return hdri
    utils: Any = bpy.utils
    return Path(utils.system_resource("DATAFILES"), "studiolights", "world", f"{hdri}.exr")


def _show_backdrop(tree: Any, background: Any, colour: tuple[float, float, float]) -> None:
    seen = tree.nodes.new("ShaderNodeBackground")
    seen.inputs["Color"].default_value = (*linear(colour), 1.0)
    mix = tree.nodes.new("ShaderNodeMixShader")
    rays = tree.nodes.new("ShaderNodeLightPath")
    tree.links.new(rays.outputs["Is Camera Ray"], mix.inputs[0])
    tree.links.new(background.outputs["Background"], mix.inputs[1])
    tree.links.new(seen.outputs["Background"], mix.inputs[2])
    tree.links.new(mix.outputs["Shader"], tree.nodes["World Output"].inputs["Surface"])
