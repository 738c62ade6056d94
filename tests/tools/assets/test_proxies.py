"""Items: reading, cutting, what they cover."""

import json

import numpy as np
from open_people.covering import edge_points, surface_points
from open_people.proxies import face_pieces, read_proxy, rest_positions


def write_item(folder):
    """A quad and a triangle that share no vertex; every vertex hangs on base vertices 0, 1 and 2."""
    data = {
        # bits: 1 quad, 2 material, 8 texture coordinates
        "faces": [1 + 2 + 8, 0, 1, 2, 3, 0, 0, 1, 2, 3, 2 + 8, 4, 5, 6, 0, 3, 2, 1],
        "uvs": [[0, 0, 1, 0, 1, 1, 0, 1]],
        "ref_vIdxs": [[0, 1, 2]] * 7,
        "weights": [[0.5, 0.25, 0.25]] * 7,
        "offsets": [[10 * k, 0, 0] for k in range(7)],
        "materials": [{"mapDiffuse": "textures/a.png", "mapNormal": "textures/absent.png"}],
        "metadata": {"deleteVerts": [0, 1, 0, 1]},
    }
    (folder / "hat" / "textures").mkdir(parents=True)
    (folder / "hat" / "textures" / "a.png").write_bytes(b"")
    (folder / "hat" / "hat.json").write_text(json.dumps(data))


def test_an_item_is_read_as_it_was_written(tmp_path):
    write_item(tmp_path)
    item = read_proxy(tmp_path, "hat")
    np.testing.assert_array_equal(item.faces, [[0, 1, 2, 3], [4, 5, 6, -1]])
    np.testing.assert_array_equal(item.uv_faces, [[0, 1, 2, 3], [3, 2, 1, -1]])
    np.testing.assert_array_equal(item.hidden, [1, 3])
    assert list(item.textures) == ["diffuse"]
    base = np.array([[0.0, 0, 0], [0, 4, 0], [0, 0, 8]])
    np.testing.assert_allclose(rest_positions(item, base)[3], [3, 1, 2])  # decimetres became metres


def test_pieces_part_where_no_corner_is_shared(tmp_path):
    write_item(tmp_path)
    item = read_proxy(tmp_path, "hat")
    pieces = face_pieces(item.faces)
    assert pieces[0] != pieces[1]
    part = item.with_faces(pieces == pieces[1])
    np.testing.assert_array_equal(part.faces, [[0, 1, 2, -1]])
    np.testing.assert_allclose(part.offsets[:, 0], [4, 5, 6])
    np.testing.assert_allclose(part.uv[part.uv_faces[0, :3]], [[0, 1], [1, 1], [1, 0]])


def test_open_edges_and_surface_of_a_strip():
    """Two quads side by side: the inner edge is not open; points of the surface stay within it."""
    cloth = np.array([[x, y, 0.0] for y in (0, 1) for x in (0, 1, 2)])
    faces = np.array([[0, 1, 4, 3], [1, 2, 5, 4]])
    edges = edge_points(faces, cloth)
    inner = (edges[:, 0] == 1) & (edges[:, 1] > 0.01) & (edges[:, 1] < 0.99)
    assert not inner.any()
    assert edges[:, 0].min() == 0
    assert edges[:, 0].max() == 2
    points = surface_points(faces, cloth)
    assert ((points >= 0) & (points <= [2, 1, 0])).all()
    assert len(np.unique(points, axis=0)) == len(points)
