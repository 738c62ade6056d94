"""The core of a Blender material: what the metallic-roughness model of a job can say."""

from __future__ import annotations

from typing import Any

import numpy as np

from render_jobs.blender.import_images import Images
from render_jobs.colour import srgb
from render_jobs.scene import Material

LINKED_ROUGHNESS = 0.7
"""Stands for a roughness that is painted: a job's surface has one."""

CLEAR = 0.5
"""Surfaces that let through more than this are glass and are left out."""


def read_material(material: Any, images: Images) -> Material | None:
    """The material, or None where the surface is clear as glass and not drawn.

    Of node trees the Principled BSDF counts: base colour (a value, or the first image on its way), metallic,
    roughness, normal map, emission, alpha. Without one, the colour of Blender's viewport.
    """
    if material is None:
        return Material(base_color=(0.8, 0.8, 0.8))
    shader = _principled(material)
    if shader is None:
        if material.use_nodes:
            images.note(f"material {material.name}: no Principled BSDF; it shows its viewport colour")
        return Material(name=material.name, base_color=srgb(material.diffuse_color[:3]))
    inputs = shader.inputs
    if _value(inputs["Transmission Weight"]) > CLEAR or (
        not inputs["Alpha"].is_linked and _value(inputs["Alpha"]) < 1.0 - CLEAR
    ):
        images.note(f"material {material.name}: clear as glass; its surfaces are left out")
        return None
    image_node = _first(inputs["Base Color"], "TEX_IMAGE")
    texture = None if image_node is None or image_node.image is None else images.texture(image_node.image)
    if texture is not None:
        _keep_mapping(material.name, image_node, images)
    normal_node = _first(inputs["Normal"], "TEX_IMAGE")
    normal = None if normal_node is None or normal_node.image is None else images.texture(normal_node.image)
    color = (1.0, 1.0, 1.0)
    if texture is None:
        color = _plain_color(material, inputs["Base Color"], images)
    return Material(
        name=material.name,
        base_color=color,
        base_color_texture=texture,
        alpha_mode="clip" if texture is not None and inputs["Alpha"].is_linked else "opaque",
        roughness=LINKED_ROUGHNESS if inputs["Roughness"].is_linked else _value(inputs["Roughness"]),
        metallic=0.0 if inputs["Metallic"].is_linked else _value(inputs["Metallic"]),
        specular=min(_value(inputs["Specular IOR Level"]), 1.0),
        normal_texture=normal,
        emission=srgb(inputs["Emission Color"].default_value[:3]),
        emission_strength=0.0 if _glows_by_image(inputs) else _value(inputs["Emission Strength"]),
        double_sided=not material.use_backface_culling,
    )


def _principled(material: Any) -> Any:
    nodes = material.node_tree.nodes if material.use_nodes and material.node_tree else ()
    return next((node for node in nodes if node.type == "BSDF_PRINCIPLED"), None)


def _value(socket: Any) -> float:
    return float(socket.default_value)


def _glows_by_image(inputs: Any) -> bool:
    return bool(inputs["Emission Color"].is_linked or inputs["Emission Strength"].is_linked)


def _first(socket: Any, kind: str) -> Any:
    """The nearest node of a kind upstream of a socket, or None."""
    waiting, seen = [socket], set()
    while waiting:
        for link in waiting.pop(0).links:
            node = link.from_node
            if node.type == kind:
                return node
            if node.name not in seen:
                seen.add(node.name)
                waiting.extend(node.inputs)
    return None


def _plain_color(material: Any, socket: Any, images: Images) -> tuple[float, float, float]:
    if not socket.is_linked:
        return srgb(socket.default_value[:3])
    source = _first(socket, "RGB")
    if source is not None:
        return srgb(source.outputs[0].default_value[:3])
    images.note(f"material {material.name}: its colour is computed; bake it into an image to have it here")
    return srgb(material.diffuse_color[:3])


def _keep_mapping(name: str, image_node: Any, images: Images) -> None:
    """Remember scale, turn and shift of a Mapping node, which jobs have not."""
    node = _first(image_node.inputs["Vector"], "MAPPING") if image_node.inputs["Vector"].is_linked else None
    if node is None or node.vector_type not in ("POINT", "TEXTURE"):
        return
    scale, turn = np.array(node.inputs["Scale"].default_value)[:2], node.inputs["Rotation"].default_value[2]
    shift = np.array(node.inputs["Location"].default_value)[:2]
    c, s = np.cos(turn), np.sin(turn)
    linear = np.array([[c, -s], [s, c]]) @ np.diag(scale)
    if node.vector_type == "TEXTURE":
        linear = np.linalg.inv(linear)
        shift = -linear @ shift
    images.set_mapping(name, np.column_stack([linear, shift]))
