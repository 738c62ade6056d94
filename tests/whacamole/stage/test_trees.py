"""Trees: crowns above the heads, trunks on the ground, wood that is closed, leaves of the size of leaves."""

import numpy as np
import pytest
import trimesh
from scipy.spatial import cKDTree

from render_jobs import Sun
from whacamole.stage import SetBuilder
from whacamole.stage.floor import Floor
from whacamole.stage.props import plant_trees
from whacamole.stage.props.growth import leafy, limb, on_box
from whacamole.stage.props.trees import HEADROOM, TRUNK

SUN = Sun(direction=(-0.7, 0.3, -0.5))
WALK = np.stack([np.linspace(-4.0, 4.0, 80), np.zeros(80)], axis=1)


def test_a_limb_is_closed_and_has_the_volume_of_its_frustum() -> None:
    solid = limb(np.array([[1.0, 0.0, 0.0], [1.0, 0.0, 2.0], [1.0, 0.0, 4.0]]), np.array([0.4, 0.3, 0.2]), 24)
    surface = trimesh.Trimesh(solid.vertices, solid.faces, process=False)
    assert surface.is_watertight
    polygon = 24 * 0.5 * np.sin(2.0 * np.pi / 24)
    assert surface.volume == pytest.approx(polygon * 4.0 / 3.0 * (0.16 + 0.08 + 0.04), rel=1e-5)


@pytest.mark.parametrize("droop", [0.0, 0.6, 1.0])
def test_a_leaf_faces_where_it_is_told_and_is_as_large_as_told(droop: float) -> None:
    rng = np.random.default_rng(0)
    normals = rng.normal(size=(500, 3))
    solid = leafy(np.zeros((500, 3)), normals, (0.2, 0.1), rng, droop)
    corners = solid.vertices[solid.faces].astype(np.float64)
    length, width = (np.linalg.norm(corners[:, a] - corners[:, b], axis=1) for a, b in ((2, 0), (1, 3)))
    assert 0.139 < length.min() < length.max() < 0.261
    assert 0.069 < width.min() < width.max() < 0.131
    cross = np.cross(corners[:, 2] - corners[:, 0], corners[:, 1] - corners[:, 3])
    cosine = np.einsum("ni,ni->n", cross, normals)
    cosine /= np.linalg.norm(cross, axis=1) * np.linalg.norm(normals, axis=1)
    np.testing.assert_allclose(np.abs(cosine), 1.0, atol=1e-5)
    assert solid.uv.min() >= 0.0
    assert solid.uv.max() <= 1.0
    if droop == 1.0:
        assert (corners[:, 2, 2] <= corners[:, 0, 2] + 1e-6).all(), "its tip hangs down"


def test_leaves_of_a_box_lie_on_its_sides_and_top() -> None:
    size = np.array([3.0, 1.0, 0.8])
    places, _ = on_box(size, 200.0, np.random.default_rng(0))
    assert len(places) == int(200 * (2 * 0.8 + 2 * 2.4 + 3.0))
    gap = np.abs(places - [0.0, 0.0, 0.4]) - size / 2.0
    np.testing.assert_allclose(gap.max(axis=1), 0.0, atol=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_crowns_hang_above_the_heads_and_trunks_stand_on_the_ground(seed: int) -> None:
    build, floor = SetBuilder(None), Floor(WALK)
    plant_trees(build, floor, ((6, 4.2, 14.0), (8, 14.0, 30.0)), SUN, np.random.default_rng(seed))
    trunks, branches, crowns = (
        [mesh for mesh in build.meshes if mesh.name.startswith(name)]
        for name in ("trunk", "branches", "crowns")
    )
    assert len(trunks) == len(build.obstacles) >= 10
    assert 1 <= len(crowns) <= 3
    leaves = np.concatenate([mesh.vertices for mesh in crowns]).astype(np.float64)
    assert leaves[:, 2].min() >= HEADROOM
    assert sum(len(mesh.faces) for mesh in (*crowns, *branches, *trunks)) < 4500 * len(trunks)
    fall = (leaves[:, 2:] - 1.5) / -SUN.direction[2]
    shadow = leaves[:, :2] + fall * SUN.direction[:2]
    assert cKDTree(WALK).query(shadow)[0].min() > 0.6, "faces are in the sun"
    feet = np.stack([trunk.vertices[:, :2].mean(axis=0) for trunk in trunks]).astype(np.float64)
    low = branches[0].vertices[branches[0].vertices[:, 2] < HEADROOM].astype(np.float64)
    assert cKDTree(feet).query(low[:, :2])[0].max() < 0.5, "below the crown there is only the trunk"
    for trunk, foot in zip(trunks, feet, strict=True):
        assert -0.03 < trunk.vertices[:, 2].min() <= 0.0, "its foot is in the ground"
        assert trunk.vertices[:, 2].max() == pytest.approx(TRUNK, abs=0.06)
        assert (np.hypot(*(leaves[:, :2] - foot).T) < 2.0).sum() > 1500, "it stands under a crown"
