"""The outer skin: closed, one piece, without eyes, teeth and tongue."""

import numpy as np
import trimesh

from whacamole.labels.skin import OuterSkin


def test_embedded_body_is_closed_without_its_inner_pieces(model):
    skin = OuterSkin.build(model.v_template, model.faces)
    mesh = trimesh.Trimesh(skin.close(model.v_template), skin.faces, process=False)
    mesh.remove_unreferenced_vertices()
    assert mesh.is_watertight
    assert mesh.body_count == 1
    assert mesh.volume > 0
    assert not skin.rims
    assert len(skin.vertices) == 13380


def test_holes_are_covered(ball):
    vertices, faces = ball
    top, bottom = vertices[:, 2] > 0.9, vertices[:, 2] < -0.8
    cut = faces[~(top[faces].any(axis=1) | bottom[faces].any(axis=1))]
    inner = faces + len(vertices)
    skin = OuterSkin.build(np.concatenate([vertices, 0.3 * vertices]), np.concatenate([inner, cut]))
    assert len(skin.rims) == 2
    closed = skin.close(np.concatenate([vertices, 0.3 * vertices]))
    mesh = trimesh.Trimesh(closed, skin.faces, process=False)
    mesh.remove_unreferenced_vertices()
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume > 3.5
    assert skin.vertices.max() < len(vertices)
