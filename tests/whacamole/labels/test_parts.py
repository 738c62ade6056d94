"""Named parts: a partition, mirrored, and where anatomy has them."""

import json
from itertools import pairwise

import numpy as np
import pytest

from whacamole.errors import BodyModelError
from whacamole.labels import PART_NAMES, model_parts, parts_from_regions, read_regions


@pytest.fixture(scope="module")
def parts(model):
    return model_parts(model)


def test_every_vertex_is_in_one_part_and_every_part_has_vertices(model, parts):
    assert parts.names == PART_NAMES
    assert len(parts.vertex_part) == model.num_vertices
    counts = np.bincount(parts.vertex_part, minlength=len(parts.names))
    assert counts.sum() == model.num_vertices
    assert counts.min() > 100


def test_left_and_right_mirror(model, parts):
    for name in PART_NAMES:
        if name.startswith("left_"):
            left = model.v_template[parts.vertices(name)]
            right = model.v_template[parts.vertices("right_" + name[5:])] * [-1, 1, 1]
            order_left, order_right = (np.lexsort(np.round(side, 5).T) for side in (left, right))
            np.testing.assert_allclose(left[order_left], right[order_right], atol=2e-5)
            assert left[:, 0].min() > 0


def test_anatomy(model, parts):
    middle = {name: model.v_template[parts.vertices(name)].mean(axis=0) for name in PART_NAMES}
    heights = ["head", "neck", "chest", "belly", "pelvis", "left_thigh", "left_shin", "left_heel"]
    assert all(middle[a][1] > middle[b][1] for a, b in pairwise(heights))
    assert middle["chest"][2] > middle["upper_back"][2] + 0.1
    assert middle["belly"][2] > middle["lower_back"][2] + 0.1
    assert middle["left_hand"][0] > middle["left_forearm"][0] > middle["left_upper_arm"][0]
    joints = model.rest_joints(np.zeros(10))
    halfway = (joints[7, 2] + joints[10, 2]) / 2
    assert model.v_template[parts.vertices("left_heel")][:, 2].max() <= halfway + 0.01
    assert model.v_template[parts.vertices("left_forefoot")][:, 2].min() >= halfway - 0.01


def test_regions_hold_every_vertex():
    parts = parts_from_regions({"a": [0, 2], "b": [3], "nothing": []}, 5)
    assert parts.names == ("a", "b", "nothing", "unlisted")
    np.testing.assert_array_equal(parts.vertex_part, [0, 3, 0, 1, 3])
    assert parts_from_regions({"a": [0, 2], "b": [1]}, 3).names == ("a", "b")
    for listed, wrong in (([1, 7], 7), ([-2, 1], -2)):
        with pytest.raises(ValueError, match=f"'a' holds vertex {wrong}, the body has 5"):
            parts_from_regions({"a": listed}, 5)
    with pytest.raises(ValueError, match="names no region"):
        parts_from_regions({}, 5)
    with pytest.raises(ValueError, match="rename it"):
        parts_from_regions({"unlisted": [0]}, 2)


def test_every_form_of_a_region_file_says_the_same(tmp_path):
    number = [0, 1, 1, 0, -1, 2]
    lists = {"region_00": [0, 3], "region_01": [1, 2], "region_02": [5]}
    files = {
        "object.json": lists, "lists.json": list(lists.values()), "numbers.json": number,
        "lists.npz": lists, "numbers.npz": {"part": number},
        "named.npz": {"part": number, "names": list(lists)},
    }  # fmt: skip
    for name, contents in files.items():
        path = tmp_path / name
        if path.suffix == ".json":
            path.write_text(json.dumps(contents))
        else:
            np.savez_compressed(path, **contents)
        parts = read_regions(path, 6)
        assert parts.names == (*lists, "unlisted"), name
        np.testing.assert_array_equal(parts.vertex_part, [0, 1, 1, 0, 3, 2], err_msg=name)


@pytest.mark.parametrize(
    ("name", "contents", "reason"),
    [
        ("a.json", b'{"a": [0, 9]}', "holds vertex 9, the body has 6"),
        ("a.json", b'{"a": 5}', "not one row of whole numbers"),
        ("a.json", b'{"a": [0.5]}', "not one row of whole numbers"),
        ("a.json", b"[0, 1, 2]", "numbers 3 vertices, the body model has 6"),
        ("a.json", b"[0, 1, 2, 3, 4, 99999]", "must be 0 to 32766"),
        ("a.json", b"{", "not a usable region file"),
        ("a.json", b"7", "not one row of whole numbers"),
        ("a.npz", b"", "not a usable region file"),
        ("a.npz", b"PK\x03\x04 and no more", "no .npz"),
        ("a.txt", b"0", "must end in .json or .npz"),
        ("a.json", None, "No such file"),
    ],
)
def test_bad_region_files_are_refused_in_one_line(tmp_path, name, contents, reason):
    path = tmp_path / name
    if contents is not None:
        path.write_bytes(contents)
    with pytest.raises(BodyModelError) as caught:
        read_regions(path, 6)
    assert reason in str(caught.value)
    assert str(caught.value).startswith(str(path))
    assert "\n" not in str(caught.value)


def test_pickled_regions_are_not_loaded(tmp_path):
    np.savez(tmp_path / "a.npz", a=np.array([[0], [1, 2]], dtype=object))
    with pytest.raises(BodyModelError, match="allow_pickle=False"):
        read_regions(tmp_path / "a.npz", 6)
