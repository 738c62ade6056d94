"""Dressing: the meshes of one person."""

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from scipy.spatial import cKDTree

from render_jobs.colour import linear_image
from whacamole.body import BodyModel, unit_vectors, vertex_normals
from whacamole.wardrobe import Worn, cast, dress, fits
from whacamole.wardrobe.catalogue import catalogue
from whacamole.wardrobe.palette import HAIR_COLOURS
from whacamole.wardrobe.skin import DRAWN_IN, drawn_in
from whacamole.wardrobe.textures import TextureFolder, item_texture


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


@pytest.mark.parametrize("hair", ["hair_cropped", "hair_parted", "hair_bob", "hair_swept"])
def test_hair_is_strands_and_not_a_shell(body, member, make_params, tmp_path, hair):
    """Neighbouring faces of a shell face the same way and are one colour; strands neither."""
    worn = replace(member, worn=(*member.worn[:3], Worn(hair)), hair_colour="brown")
    (mesh,) = (
        m for m in dress(worn, body, make_params(member.betas, 1), textures=tmp_path) if hair in m.name
    )
    at = mesh.vertices[0].astype(np.float64)
    quads = mesh.faces[mesh.faces[:, 3] >= 0]
    normals = unit_vectors(np.cross(at[quads[:, 2]] - at[quads[:, 0]], at[quads[:, 3]] - at[quads[:, 1]]))
    _, near = cKDTree(at[quads].mean(axis=1)).query(at[quads].mean(axis=1), k=12)
    agreement = np.abs(np.einsum("nkc,nc->nk", normals[near], normals))
    assert np.degrees(np.arccos(np.clip(agreement, 0, 1))).mean() > 15
    # A mirror-like gloss over all of them would be a helmet's.
    assert mesh.material.roughness >= 0.6
    assert mesh.material.specular <= 0.2


def test_hair_has_the_colour_it_is_named_for_and_strands_vary_about_it(tmp_path):
    wardrobe, folder = catalogue(), TextureFolder(tmp_path)
    item = wardrobe.items["hair_short"]
    brightness = []
    for colour, target in HAIR_COLOURS.items():
        with Image.open(item_texture(wardrobe, item, Worn(item.name), colour, folder)) as image:
            pixels = np.asarray(image)
        seen = pixels[pixels[..., 3] > 128][:, :3]
        np.testing.assert_allclose(np.median(seen, axis=0) / 255, target, atol=0.03)
        light = linear_image(seen) @ [0.2126, 0.7152, 0.0722]
        assert np.percentile(light, 90) > 1.3 * np.percentile(light, 10), colour
        brightness.append(float(np.median(light)))
    # Grey hair is no snow: under a third of the light, and black is no hole.
    assert max(brightness) < 0.35
    assert min(brightness) > 0.004


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
