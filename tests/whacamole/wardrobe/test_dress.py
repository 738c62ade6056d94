"""Dressing: the meshes of one person."""

import numpy as np
import pytest
from PIL import Image

from whacamole.body import BodyModel, vertex_normals
from whacamole.wardrobe import Worn, cast, dress, fits
from whacamole.wardrobe.catalogue import catalogue
from whacamole.wardrobe.skin import DRAWN_IN, drawn_in


@pytest.fixture(scope="module")
def dressed(body, member, make_params, tmp_path_factory):
    params = make_params(member.betas)
    return params, dress(
        member, body, params, textures=tmp_path_factory.mktemp("textures"), track_id=7, name="anna"
    )


def test_the_wardrobe_fits_the_embedded_body_only(body, tmp_path):
    assert fits(body)
    full = body.export_full(tmp_path / "full.npz")
    assert fits(BodyModel.load(full))


def test_all_meshes_of_a_person_carry_its_track_and_all_frames(member, dressed):
    params, meshes = dressed
    assert {mesh.track_id for mesh in meshes} == {7}
    assert all(mesh.vertices.shape[0] == params.num_frames for mesh in meshes)
    assert len({mesh.name for mesh in meshes}) == len(meshes)
    assert all(mesh.name.startswith("anna-") for mesh in meshes)
    names = {mesh.name.removeprefix("anna-") for mesh in meshes}
    assert {worn.item for worn in member.worn} | {"skin", "left-eye", "right-eye", "teeth", "tongue"} == names


def test_skin_under_clothes_is_left_out_and_bare_skin_is_the_posed_body(body, member, dressed):
    params, meshes = dressed
    skin = next(mesh for mesh in meshes if mesh.name == "anna-skin")
    assert 0.1 < len(skin.faces) / len(body.quads) < 0.9
    posed = body.pose(params).vertices
    geometries = [catalogue().geometry(worn.item) for worn in member.worn]
    under = np.any([geometry.under & ~geometry.hidden for geometry in geometries], axis=0)
    bare = ~np.any([geometry.under for geometry in geometries], axis=0) & (body.extras["vertex_part"] == 0)
    assert {tuple(v) for v in posed[-1][bare]} <= {tuple(v) for v in skin.vertices[-1]}
    # At the edges of clothes it is drawn in, and only in.
    lowered = posed[-1].copy()
    lowered[under] = drawn_in(body, posed, under)[-1][under]
    normals = vertex_normals(posed[-1], body.faces)
    np.testing.assert_allclose(((lowered - posed[-1]) * normals)[under].sum(axis=1), -DRAWN_IN, atol=1e-4)
    np.testing.assert_array_equal(lowered[~under], posed[-1][~under])


def test_textures_exist_and_hair_is_cut_by_alpha(dressed):
    for mesh in dressed[1]:
        material = mesh.material
        for path in (material.base_color_texture, material.normal_texture):
            assert path is None or path.is_file()
        part = mesh.name.split("-", 1)[1].split("_")[0]
        assert (material.alpha_mode == "clip") == (part in ("hair", "brows", "lashes"))


def test_dyeing_the_shirt_leaves_other_pictures_alone(body, make_params, tmp_path):
    member = cast(2, gender="male")
    tops = [worn for worn in member.worn if catalogue().items[worn.item].slot == "top"]
    others = tuple(worn for worn in member.worn if worn not in tops)
    params = make_params(member.betas, frames=1)

    def look(colour):
        changed = type(member)(**{**vars(member), "worn": (*others, Worn(tops[0].item, colour=colour))})
        meshes = dress(changed, body, params, textures=tmp_path)
        return {mesh.name: mesh.material.base_color_texture for mesh in meshes}

    red, blue = look((0.8, 0.1, 0.1)), look((0.1, 0.1, 0.8))
    assert {name for name in red if red[name] != blue[name]} == {f"person-{tops[0].item}"}
    pixels = np.asarray(Image.open(red[f"person-{tops[0].item}"]), float).mean(axis=(0, 1))
    assert pixels[0] > 2 * pixels[2]


def test_eyes_look_ahead(body, member, make_params, tmp_path):
    """The middle of the picture, the pupil, lies on the foremost vertex of the eyeball."""
    params = make_params(member.betas, frames=1)
    meshes = dress(member, body, params, textures=tmp_path)
    for side in ("left", "right"):
        eye = next(mesh for mesh in meshes if mesh.name == f"person-{side}-eye")
        depth = eye.vertices[0][:, 2]
        front = depth[eye.faces] > depth.max() - 0.001
        assert np.linalg.norm(eye.uv[front].mean(axis=0) - 0.5) < 0.1
    with Image.open(meshes[1].material.base_color_texture) as image:
        pixels = np.asarray(image.convert("L"), float)
    middle, rim = pixels[120:136, 120:136].mean(), pixels[:, :30].mean()
    assert middle < 20 < 120 < rim
