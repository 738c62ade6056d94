"""Scene files that tests make for themselves: by Blender in a child process, or by trimesh."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import trimesh
from PIL import Image

ROOM = """
import bpy, math
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene

def material(name, color):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    made.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*color, 1.0)
    return made

def box(name, size, place, color):
    x, y, z = (side / 2 for side in size)
    corners = [(i * x, j * y, k * z) for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    data = bpy.data.meshes.new(name)
    data.from_pydata(corners, [], faces)
    entity = bpy.data.objects.new(name, data)
    entity.location = place
    data.materials.append(material(name, color))
    scene.collection.objects.link(entity)
    return entity

box("floor", (8.0, 6.0, 0.2), (1.0, 0.0, HEIGHT - 0.1), (0.2, 0.4, 0.1))
box("table", (1.0, 2.0, 0.8), (3.0, 1.0, HEIGHT + 0.4), (0.6, 0.1, 0.1))
stool = box("stool", (0.4, 0.4, 0.5), (-1.0, -2.0, HEIGHT + 0.25), (0.1, 0.1, 0.6))
for index in range(2):
    twin = bpy.data.objects.new("twin", stool.data)
    twin.location = (-1.0 + index, 2.0, HEIGHT + 0.25)
    scene.collection.objects.link(twin)
hidden = box("hidden", (9.0, 9.0, 9.0), (0.0, 0.0, 0.0), (1.0, 1.0, 1.0))
hidden.hide_render = True
lamp = bpy.data.lights.new("lamp", "POINT")
lamp.energy, lamp.color = 200.0, (1.0, 0.5, 0.25)
entity = bpy.data.objects.new("lamp", lamp)
entity.location = (0.0, 0.0, 2.5 + HEIGHT)
scene.collection.objects.link(entity)
"""
"""A floor of 8 × 6 m about (1, 0) at HEIGHT, a table, three stools of one mesh, a lamp, a hidden box."""

PLANTED = """
trap = bpy.data.texts.new("trap.py")
trap.write("import pathlib; pathlib.Path(%r).write_text('ran')")
trap.use_module = True
driver = bpy.data.objects["table"].driver_add("location", 2).driver
driver.expression = "__import__('pathlib').Path(%r).write_text('ran') and 0.4"
"""
"""A text that Blender would run on loading, and a driver that it would run on drawing."""


def blender(script: str) -> None:
    """Run a script with ``bpy`` in a process of its own; taking Blender down at the end can hang."""
    ended = script + "\nimport os, sys\nsys.stdout.flush()\nos._exit(0)\n"
    subprocess.run([sys.executable, "-c", ended], check=True, capture_output=True, timeout=120)


def write_room(path: Path, *, height: float = 0.0, more: str = "") -> Path:
    """Save the room as ``.blend`` or export it as USD or glTF, by the suffix of ``path``."""
    save = {
        ".blend": f"bpy.ops.wm.save_as_mainfile(filepath={str(path)!r})",
        ".glb": f"bpy.ops.export_scene.gltf(filepath={str(path)!r}, export_lights=True)",
    }.get(path.suffix, f"bpy.ops.wm.usd_export(filepath={str(path)!r})")
    blender(f"HEIGHT = {height}\n" + ROOM + more + "\n" + save)
    return path


def write_glb(path: Path, *, floor: float = 6.0, texture: bool = True) -> Path:
    """A square floor at y = 0 (glTF has y up) with a checkered image, and a post at x = 2, z = −1."""
    ground = trimesh.Trimesh(
        floor / 2 * np.array([[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1.0]]),
        [[0, 1, 2], [0, 2, 3]], process=False,
    )  # fmt: skip
    if texture:
        checkers = 255 * (np.indices((8, 8)).sum(axis=0) % 2)
        image = Image.fromarray(np.repeat(checkers[..., None], 3, axis=2).astype(np.uint8))
        skin = trimesh.visual.material.PBRMaterial(baseColorTexture=image)
        uv = np.array([[0, 0], [1, 0], [1, 1], [0, 1.0]])
        ground.visual = trimesh.visual.TextureVisuals(uv=uv, material=skin)
    post = trimesh.creation.box((0.4, 3.0, 0.4))
    post.apply_translation([2.0, 1.5, -1.0])
    trimesh.Scene({"ground": ground, "post": post}).export(path)
    return path
