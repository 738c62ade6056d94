"""Clothes for bodies the wardrobe was not cut for: shells of the surface, or the user's own pictures."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from whacamole.errors import TakeError
from whacamole.wardrobe import cast, dress
from whacamole.wardrobe.clipping import clip_surface
from whacamole.wardrobe.shells import dress_in_shells, texture_files


def grid(n):
    """A unit square of n × n cells, two triangles each."""
    points = np.array([[x, y, 0.0] for y in range(n + 1) for x in range(n + 1)]) / n
    corner = np.array([y * (n + 1) + x for y in range(n) for x in range(n)])
    first = np.stack([corner, corner + 1, corner + n + 2], axis=1)
    second = np.stack([corner, corner + n + 2, corner + n + 1], axis=1)
    return points, np.concatenate([first, second]).astype(np.int32)


def area(points, faces):
    p = points[faces]
    return np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1).sum() / 2


@settings(derandomize=True, max_examples=50, deadline=None)
@given(angle=st.floats(0, 6.28), offset=st.floats(-0.4, 0.4))
def test_a_cut_parts_the_surface_along_the_line(angle, offset):
    """Both sides of a straight cut together have the whole area, and lie on their side of the line."""
    points, faces = grid(5)
    direction = np.array([np.cos(angle), np.sin(angle), 0])
    field = (points - 0.5) @ direction - offset
    total = 0.0
    for sign in (1, -1):
        part = clip_surface(faces, sign * field)
        cut = part.mix @ points
        assert (sign * ((cut - 0.5) @ direction - offset) > -1e-6).all()
        total += area(cut, part.faces)
    np.testing.assert_allclose(total, 1.0, atol=1e-5)


def test_smoothing_keeps_the_edge_and_flattens_a_spike():
    points, faces = grid(6)
    part = clip_surface(faces, np.ones(len(points)))
    spike = points.copy()
    middle = int(np.argmin(np.linalg.norm(points - [0.5, 0.5, 0], axis=1)))
    spike[middle, 2] = 1.0
    smooth = part.smoothed(10).mix @ spike
    assert smooth[:, 2].max() < 0.2
    edge = (np.abs((part.mix @ points)[:, :2] - 0.5) > 0.499).any(axis=1)
    np.testing.assert_allclose(smooth[edge], (part.mix @ spike)[edge], atol=1e-6)


@pytest.fixture(scope="module")
def shells(body, make_params):
    member = cast(4)
    posed = body.pose(make_params(member.betas, frames=2)).vertices
    meshes = dress_in_shells(member, body, posed, track_id=3, name="bo", subdivision=0)
    return member, posed, {mesh.name.removeprefix("bo-"): mesh for mesh in meshes}


def test_shells_cover_the_body_part_by_part(shells):
    _, posed, meshes = shells
    assert {"skin", "eyes", "iris", "top", "bottom", "shoes"} <= set(meshes)
    assert all(mesh.track_id == 3 and len(mesh.vertices) == len(posed) for mesh in meshes.values())


def test_a_shell_does_not_reach_the_chin(body, shells):
    from whacamole.body import JOINT_INDEX

    top = shells[2]["top"].vertices[0]
    rest = body.rest_joints(shells[0].betas)
    assert top[:, 1].max() < rest[JOINT_INDEX["jaw"], 1]


def test_uv_textures_are_worn_by_their_gender(body, member, make_params, tmp_path):
    for name in ("female_01.png", "male_01.png"):
        Image.new("RGB", (4, 4)).save(tmp_path / name)
    params = make_params(member.betas, frames=1)
    (mesh,) = dress(member, body, params, textures=tmp_path / "made", uv_textures=tmp_path)
    assert mesh.material.base_color_texture == tmp_path / f"{member.gender}_01.png"
    assert mesh.uv.shape == (len(body.faces), 3, 2)
    assert len(texture_files(tmp_path)) == 2


def test_a_folder_without_pictures_is_named(body, member, make_params, tmp_path):
    with pytest.raises(TakeError, match="--textures"):
        dress(member, body, make_params(member.betas, frames=1), textures=tmp_path, uv_textures=tmp_path)
