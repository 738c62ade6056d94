"""Named parts: a partition, mirrored, and where anatomy has them."""

from itertools import pairwise

import numpy as np
import pytest

from whacamole.labels import PART_NAMES, model_parts, parts_from_regions


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


def test_regions_of_a_file():
    parts = parts_from_regions({"a": [0, 2], "b": [3], "nothing": []}, 5)
    assert parts.names == ("a", "b", "nothing")
    np.testing.assert_array_equal(parts.vertex_part, [0, -1, 0, 1, -1])
    with pytest.raises(ValueError, match="'a' holds vertex 7, the body has 5"):
        parts_from_regions({"a": [7]}, 5)
    with pytest.raises(ValueError, match="names no region"):
        parts_from_regions({}, 5)
