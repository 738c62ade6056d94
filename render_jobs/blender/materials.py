"""Materials in Blender: one Principled BSDF each."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bpy

from render_jobs.colour import linear
from render_jobs.errors import RenderJobError
from render_jobs.scene import Material

SKIN_RADII = (1.0, 0.35, 0.2)
"""How far red, green and blue light travels below skin, relative to the scale."""
SKIN_SCALE_M = 0.008


def build_material(material: Material) -> Any:
    """The Blender material.

    Raises:
        RenderJobError: a texture cannot be read.
    """
    made: Any = bpy.data.materials.new(material.name)
    made.use_nodes = True
    tree = made.node_tree
    shader = tree.nodes["Principled BSDF"].inputs
    shader["Roughness"].default_value = material.roughness
    shader["Metallic"].default_value = material.metallic
    shader["Specular IOR Level"].default_value = material.specular
    shader["Emission Color"].default_value = (*linear(material.emission), 1.0)
    shader["Emission Strength"].default_value = material.emission_strength
    if not material.emission_lights:
        made.cycles.emission_sampling = "NONE"
    shader["Subsurface Weight"].default_value = material.subsurface
    shader["Subsurface Radius"].default_value = SKIN_RADII
    shader["Subsurface Scale"].default_value = SKIN_SCALE_M
    _connect_color(tree, shader, material)
    if material.normal_texture is not None:
        image = _image_node(tree, material.normal_texture, material.uv_scale, is_color=False)
        bump = tree.nodes.new("ShaderNodeNormalMap")
        bump.inputs["Strength"].default_value = material.normal_strength
        tree.links.new(image.outputs["Color"], bump.inputs["Color"])
        tree.links.new(bump.outputs["Normal"], shader["Normal"])
    return made


def _connect_color(tree: Any, shader: Any, material: Material) -> None:
    alpha = None
    if material.base_color_texture is None:
        shader["Base Color"].default_value = (*linear(material.base_color), 1.0)
    else:
        image = _image_node(tree, material.base_color_texture, material.uv_scale, is_color=True)
        tint = tree.nodes.new("ShaderNodeVectorMath")
        tint.operation = "MULTIPLY"
        tint.inputs[1].default_value = linear(material.base_color)
        tree.links.new(image.outputs["Color"], tint.inputs[0])
        tree.links.new(tint.outputs["Vector"], shader["Base Color"])
        if material.alpha_mode == "clip":
            alpha = _math(tree, "GREATER_THAN", image.outputs["Alpha"], 0.5)
        elif material.alpha_mode == "blend":
            alpha = image.outputs["Alpha"]
    if not material.double_sided:
        side = tree.nodes.new("ShaderNodeNewGeometry").outputs["Backfacing"]
        front = _math(tree, "LESS_THAN", side, 0.5)
        alpha = front if alpha is None else _math(tree, "MULTIPLY", alpha, front)
    if alpha is not None:
        tree.links.new(alpha, shader["Alpha"])


def _math(tree: Any, operation: str, left: Any, right: Any) -> Any:
    node = tree.nodes.new("ShaderNodeMath")
    node.operation = operation
    tree.links.new(left, node.inputs[0])
    if isinstance(right, float):
        node.inputs[1].default_value = right
    else:
        tree.links.new(right, node.inputs[1])
    return node.outputs[0]


def _image_node(tree: Any, path: Path, uv_scale: float, *, is_color: bool) -> Any:
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = load_image(path, is_color=is_color)
    if uv_scale != 1.0:
        coordinates = tree.nodes.new("ShaderNodeTexCoord")
        scale = tree.nodes.new("ShaderNodeVectorMath")
        scale.operation = "SCALE"
        scale.inputs["Scale"].default_value = uv_scale
        tree.links.new(coordinates.outputs["UV"], scale.inputs[0])
        tree.links.new(scale.outputs["Vector"], node.inputs["Vector"])
    return node


def load_image(path: Path, *, is_color: bool) -> Any:
    """Load an image file, each once.

    Raises:
        RenderJobError: the file is no readable image. (Blender itself would paint the surface pink.)
    """
    try:
        image: Any = bpy.data.images.load(str(path), check_existing=True)
    except RuntimeError as error:
        raise RenderJobError(f"{path}: the image cannot be read") from error
    if 0 in image.size:
        raise RenderJobError(f"{path}: the image is damaged or of an unknown kind")
    image.alpha_mode = "CHANNEL_PACKED"  # colour below clipped alpha stays as painted
    if not is_color:
        image.colorspace_settings.name = "Non-Color"
    return image
