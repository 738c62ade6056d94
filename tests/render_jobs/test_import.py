"""A user's scene files: read into the metric values they were made of, and never trusted."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from render_jobs import Lamp
from render_jobs.gltf_scene import read as read_by_trimesh
from render_jobs.imported import ImportedScene, SceneFileError, import_scene
from scene_files import PLANTED, blender, write_glb, write_room

pytestmark = pytest.mark.blender


def box_of(scene: ImportedScene, color: tuple[float, float, float]) -> NDArray[np.float64]:
    """Low and high corner (2, 3) of all that has a colour (linear light), placements included."""
    points = []
    for mesh in scene.meshes:
        light = np.asarray(mesh.material.base_color) ** 2.2
        if np.abs(light - color).max() < 0.05:
            for place in np.eye(4)[None] if mesh.placements is None else mesh.placements:
                points.append(mesh.vertices.astype(float) @ place[:3, :3].T + place[:3, 3])
    corners = np.concatenate(points)
    return np.stack([corners.min(axis=0), corners.max(axis=0)])


@pytest.mark.parametrize("suffix", [".blend", ".usdc", ".glb"])
def test_a_room_comes_out_as_it_was_built(tmp_path: Path, suffix: str) -> None:
    scene = import_scene(write_room(tmp_path / f"room{suffix}"), tmp_path / "plain")
    np.testing.assert_allclose(
        box_of(scene, (0.2, 0.4, 0.1)), [[-3.0, -3.0, -0.2], [5.0, 3.0, 0.0]], atol=1e-5
    )
    np.testing.assert_allclose(box_of(scene, (0.6, 0.1, 0.1)), [[2.5, 0.0, 0.0], [3.5, 2.0, 0.8]], atol=1e-5)
    np.testing.assert_allclose(
        box_of(scene, (0.1, 0.1, 0.6)), [[-1.2, -2.2, 0.0], [0.2, 2.2, 0.5]], atol=1e-5
    )
    assert len(scene.floor) == 1
    (lamp,) = scene.lights
    assert isinstance(lamp, Lamp)
    assert lamp.kind == "point"
    np.testing.assert_allclose(lamp.position, [0.0, 0.0, 2.5], atol=1e-5)
    assert lamp.power_w == pytest.approx(200.0, rel=0.05)
    assert scene.lit
    again = import_scene(tmp_path / f"room{suffix}", tmp_path / "plain")
    assert [mesh.name for mesh in again.meshes] == [mesh.name for mesh in scene.meshes]


def test_a_texture_is_taken_along_and_both_readers_of_gltf_agree(tmp_path: Path) -> None:
    file = write_glb(tmp_path / "yard.glb")
    scene = import_scene(file, tmp_path / "plain")
    other = read_by_trimesh(file, tmp_path / "images")
    for found in (scene, other):
        (painted,) = [mesh for mesh in found.meshes if mesh.material.base_color_texture is not None]
        corners = painted.vertices[painted.faces]
        np.testing.assert_allclose(np.sort(corners.reshape(-1, 3), axis=0)[[0, -1]], [[-3, -3, 0], [3, 3, 0]])
        assert painted.uv is not None
        # the image's first row lies along the far side: u grows with x, v with y
        np.testing.assert_allclose(corners[..., :2] / 6.0 + 0.5, painted.uv, atol=1e-6)
        assert np.cross(corners[0, 1] - corners[0, 0], corners[0, 2] - corners[0, 0])[2] > 0, "faces up"
        (post,) = [mesh for mesh in found.meshes if mesh is not painted]
        np.testing.assert_allclose(post.vertices.min(axis=0), [1.8, 0.8, 0.0], atol=1e-6)
        np.testing.assert_allclose(post.vertices.max(axis=0), [2.2, 1.2, 3.0], atol=1e-6)


def test_scripts_in_a_file_do_not_run(tmp_path: Path) -> None:
    text, driver = tmp_path / "text-ran", tmp_path / "driver-ran"
    file = write_room(tmp_path / "trap.blend", more=PLANTED % (str(text), str(driver)))
    # The trap is live: Blender springs it where scripts are allowed.
    blender(f"import bpy\nbpy.ops.wm.open_mainfile(filepath={str(file)!r}, use_scripts=True)")
    assert text.exists()
    assert driver.exists()
    text.unlink()
    driver.unlink()
    scene = import_scene(file, tmp_path / "plain")
    assert len(scene.meshes) >= 3
    assert not text.exists()
    assert not driver.exists()


def test_what_lies_outside_the_folder_is_refused_or_left_out(tmp_path: Path) -> None:
    (tmp_path / "secret.bin").write_bytes(bytes(36))
    inside = tmp_path / "stages"
    inside.mkdir()
    document = {
        "asset": {"version": "2.0"},
        "buffers": [{"uri": "../secret.bin", "byteLength": 36}],
        "scenes": [{"nodes": []}],
    }
    (inside / "out.gltf").write_text(json.dumps(document))
    with pytest.raises(SceneFileError, match=r"out\.gltf: refers to \.\./secret\.bin, outside its folder"):
        import_scene(inside / "out.gltf", tmp_path / "plain")
    write_glb(tmp_path / "image.glb")
    image = tmp_path / "outside.png"
    from PIL import Image

    Image.new("RGB", (4, 4), (255, 0, 0)).save(image)
    paint = f"""
made = bpy.data.objects["table"].data.materials[0]
node = made.node_tree.nodes.new("ShaderNodeTexImage")
node.image = bpy.data.images.load({str(image)!r})
made.node_tree.links.new(node.outputs["Color"], made.node_tree.nodes["Principled BSDF"].inputs["Base Color"])
"""
    scene = import_scene(write_room(inside / "room.blend", more=paint), tmp_path / "room")
    assert any("outside.png: lies outside" in note for note in scene.notes)
    assert all(mesh.material.base_color_texture is None for mesh in scene.meshes)


@pytest.mark.parametrize("suffix", [".blend", ".glb", ".gltf", ".usdc", ".usda"])
def test_a_broken_file_is_one_line_that_names_it(tmp_path: Path, suffix: str) -> None:
    file = tmp_path / f"broken{suffix}"
    file.write_bytes(b"BLENDER-v405 and then nothing of use")
    with pytest.raises(SceneFileError) as caught:
        import_scene(file, tmp_path / "plain")
    assert str(caught.value).startswith(f"{file}: ")
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "plain").exists()
    assert [path.name for path in tmp_path.iterdir()] == [file.name], "nothing is left lying about"
