"""Self-contact by construction, and against every vertex with every triangle."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from scipy.spatial import cKDTree

from whacamole.body import JOINT_INDEX
from whacamole.labels import PART_NAMES, ContactLabels, model_parts
from whacamole.labels.skin import OuterSkin

HAND, THIGH = PART_NAMES.index("left_hand"), PART_NAMES.index("left_thigh")


def labelled(model, vertices):
    made = ContactLabels(model, 1, 1, 30.0, self_contact=True)
    made.add(0, None, [vertices], None)
    return made.arrays()["self_contact"][0, 0]


@pytest.fixture(scope="module")
def lowered(model, standing):
    """Bodies that lower the left arm to the thigh step by step, with the least gap between vertices."""
    angles = np.linspace(-1.0, -1.9, 31)
    params = standing(len(angles))
    pose = np.array(params.body_pose)
    pose[:, JOINT_INDEX["left_shoulder"] - 1, 2] = angles
    part = model_parts(model).vertex_part
    bodies = model.pose(replace(params, body_pose=pose)).vertices
    gaps = [cKDTree(body[part == THIGH]).query(body[part == HAND])[0].min() for body in bodies]
    return bodies, np.array(gaps)


def test_a_hand_laid_on_the_thigh_touches_it(model, lowered):
    bodies, gaps = lowered
    laid, before = (int(np.argmax(gaps < limit)) for limit in (0.006, 0.05))
    assert gaps[laid] < 0.006
    assert gaps[before] > 0.02
    touching = labelled(model, bodies[laid])
    assert touching[HAND, THIGH]
    assert touching[THIGH, HAND]
    assert not labelled(model, bodies[before])[HAND].any()


def test_nothing_touches_in_the_rest_pose(model, standing):
    assert not labelled(model, model.pose(standing(1)).vertices[0]).any()


def test_it_is_that_of_every_vertex_with_every_triangle(model, lowered):
    bodies, gaps = lowered
    body = bodies[int(np.argmax(gaps < 0.004))].astype(np.float64)
    skin = OuterSkin.build(model.v_template, model.faces)
    faces = skin.faces[(skin.faces < model.num_vertices).all(axis=1)]
    part = model_parts(model).vertex_part
    members = [skin.vertices[part[skin.vertices] == number] for number in range(len(PART_NAMES))]

    def near(one: int, other: int) -> bool:
        corners = body[faces[(part[faces] == other).any(axis=1)]]
        points = body[members[one]]
        far = cKDTree(corners.reshape(-1, 3)).query(points)[0] > 0.06  # no side is that long
        return any(
            np.linalg.norm(
                trimesh.triangles.closest_point(corners, np.tile(point, (len(corners), 1))) - point, axis=1
            ).min()
            <= 0.01
            for point in points[~far]
        )

    found = labelled(model, body.astype(np.float32))
    np.testing.assert_array_equal(found, found.T)
    rest = model.v_template.astype(np.float64)
    for other in range(len(PART_NAMES)):
        if other == HAND:
            continue
        gap = cKDTree(rest[members[other]]).query(rest[members[HAND]])[0].min()
        expected = gap > 0.1 and (near(HAND, other) or near(other, HAND))
        assert found[HAND, other] == expected, PART_NAMES[other]
