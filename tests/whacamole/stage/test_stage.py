"""Stages: closed solids, seamless textures, room for the people, the same place for the same seed."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from whacamole.dataset.files import sha256_of
from whacamole.stage import STAGES, Stage
from whacamole.stage.shapes import (
    Solid,
    bevelled_box,
    box,
    boxes,
    cylinder,
    ground_grid,
    joined,
    lathe,
    moved,
    prism,
    strip,
    tilted,
)
from whacamole.stage.textures import TEXTURES

WALK = np.stack([np.linspace(-4.0, 4.0, 80), np.sin(np.linspace(0.0, 3.0, 80))], axis=1)


def _surface(solid: Solid) -> trimesh.Trimesh:
    faces = solid.faces
    if faces.shape[1] == 4:
        faces = np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
    return trimesh.Trimesh(solid.vertices, faces, process=False)


def test_a_box_is_closed_faces_outwards_and_has_its_volume() -> None:
    surface = _surface(box((1.0, 2.0, 0.5), (2.0, 3.0, 4.0), yaw=0.7))
    assert surface.is_watertight
    assert surface.volume == pytest.approx(24.0, rel=1e-5)
    assert surface.bounds[0, 2] == pytest.approx(0.5)


def test_a_cylinder_has_the_area_of_its_prism() -> None:
    surface = _surface(cylinder((0.0, 0.0, 0.0), radius=0.5, height=2.0, sides=24))
    edge = 2.0 * 0.5 * np.sin(np.pi / 24)
    lid = 24 * 0.5 * 0.5**2 * np.sin(2.0 * np.pi / 24)
    assert surface.area == pytest.approx(24 * edge * 2.0 + lid, rel=1e-5)
    np.testing.assert_allclose(surface.face_normals[:48, 2], 0.0, atol=1e-6)
    np.testing.assert_allclose(surface.face_normals[48:], [[0.0, 0.0, 1.0]] * 24, atol=1e-6)


@pytest.mark.parametrize(
    ("solid", "volume"),
    [
        (prism([(0.0, 0.0), (2.0, 0.0), (0.0, 1.0)], 3.0), 3.0),
        (lathe([(0.5, 0.0), (0.5, 2.0)], 24), 24 * 0.5 * 0.5**2 * np.sin(2.0 * np.pi / 24) * 2.0),
        # A frustum of a square, side 2 below and 1 above.
        (lathe([(np.sqrt(2.0), 0.0), (np.sqrt(0.5), 3.0)], 4), 3.0 / 3.0 * (4.0 + 2.0 + 1.0)),
        # Of a box of 24 the four upright edges are gone, 4 × ½ × 0.1² × 4, and a frame around its top.
        (bevelled_box((2.0, 3.0, 4.0), 0.1), None),
    ],
)
def test_solids_are_closed_and_have_their_volume(solid: Solid, volume: float | None) -> None:
    surface = _surface(tilted(moved(solid, (1.0, 2.0, 3.0)), (0.3, -0.2, 0.5), (1.0, 0.0, 0.0)))
    assert surface.is_watertight
    assert surface.is_winding_consistent
    if volume is None:
        assert 24.0 - 4 * 0.005 * 4.0 - 0.05 * 0.1 * 10.0 < surface.volume < 24.0 - 4 * 0.005 * 4.0
    else:
        assert surface.volume == pytest.approx(volume, rel=1e-5)


def test_many_boxes_are_as_many_single_ones_and_their_texture_runs_on() -> None:
    low, high = np.array([[0.0, 0, 0], [2, 0, 0]]), np.array([[2.0, 1, 1], [3, 2, 4]])
    solid = boxes(low, high)
    surface = _surface(solid)
    assert surface.is_watertight
    assert surface.volume == pytest.approx(2.0 + 8.0)
    assert _surface(boxes(low, high, backless=True)).area == pytest.approx(surface.area - 2.0 - 4.0)
    front = solid.vertices[solid.faces[[0, 6]]]
    np.testing.assert_array_equal(solid.uv[[0, 6]], front[:, :, [0, 2]])


TURNED = strip(np.array([3.0, 1.0]), np.array([0.6, 0.8]), 7.0, 2.0, 0.1)


@pytest.mark.parametrize(
    "solid", [box((0, 0, 0), (2.0, 3.0, 1.0)), boxes((0, 0, 0), (2.0, 3.0, 1.0)), ground_grid(5.0, 4), TURNED]
)
def test_uv_are_in_metres(solid: Solid) -> None:
    edges = np.linalg.norm(np.diff(solid.vertices[solid.faces], axis=1), axis=2)
    np.testing.assert_allclose(np.linalg.norm(np.diff(solid.uv, axis=1), axis=2), edges, rtol=1e-5)


def test_joined_solids_keep_their_volumes() -> None:
    surface = _surface(joined([box((0, 0, 0), (2.0, 3.0, 1.0)), box((5, 0, 0), (1.0, 1.0, 1.0), yaw=0.4)]))
    assert surface.is_watertight
    assert surface.volume == pytest.approx(7.0, rel=1e-5)
    mixed = joined([box((0, 0, 0), (2.0, 3.0, 1.0)), prism([(5, 0), (7, 0), (5, 1)], 1.0)])
    assert mixed.uv.shape == (*mixed.faces.shape, 2)
    assert _surface(mixed).is_watertight
    assert _surface(mixed).volume == pytest.approx(7.0, rel=1e-5)


def test_nobody_treads_on_the_gravel_of_a_park(tmp_path: Path) -> None:
    for seed in range(5):
        (walkway,) = [mesh for mesh in _stage("park", seed, tmp_path).meshes if mesh.name == "walkway"]
        start, end, _, side = walkway.vertices[:, :2].astype(np.float64)
        along, across = end - start, side - start
        reach = (WALK - start) @ np.stack([along / (along @ along), across / (across @ across)], axis=1)
        inside = ((reach > 0.0) & (reach < 1.0)).all(axis=1)
        gap = np.maximum(-reach[:, 1], reach[:, 1] - 1.0) * np.linalg.norm(across)
        assert not inside.any()
        assert gap.min() > 1.1


@pytest.mark.parametrize("name", sorted(TEXTURES))
def test_a_texture_repeats_without_a_seam(name: str) -> None:
    image = TEXTURES[name](np.random.default_rng(3), 128)
    assert image.shape == (128, 128, 3)
    assert 0.0 <= image.min() < image.max() <= 1.0
    step = np.abs(np.diff(image, axis=1)).mean(axis=(0, 2))
    across = np.abs(image[:, 0] - image[:, -1]).mean()
    assert across <= step.max() * 1.5  # the step over the border is one of those inside


@pytest.mark.parametrize("name", sorted(TEXTURES))
def test_a_texture_has_detail_to_track(name: str) -> None:
    grey = TEXTURES[name](np.random.default_rng(5), 128).mean(axis=2)
    assert grey.std() > 0.01


def _stage(name: str, seed: int, folder: Path) -> Stage:
    return STAGES[name](np.random.default_rng(seed), WALK, folder)


@pytest.mark.parametrize("name", sorted(STAGES))
def test_nothing_stands_in_the_way_of_the_people(tmp_path: Path, name: str) -> None:
    stage = _stage(name, 1, tmp_path)
    points = np.concatenate([WALK, np.ones((len(WALK), 1))], axis=1)
    assert stage.world.obstacle_distance(points).min() > 2.0
    assert stage.world.wall_distance(points).min() > 2.0


@pytest.mark.parametrize("name", sorted(STAGES))
def test_obstacles_are_where_the_meshes_are(tmp_path: Path, name: str) -> None:
    stage = _stage(name, 0, tmp_path)
    assert len(stage.world.obstacles) >= 8
    for obstacle in stage.world.obstacles:
        parts = [
            mesh.vertices for mesh in stage.meshes
            if mesh.name == obstacle.name or mesh.name.startswith(f"{obstacle.name}.")
        ]  # fmt: skip
        solid = np.concatenate(parts)
        assert obstacle.distance(solid).max() <= 1e-5
        # Nor is the box larger than what is in it; a cylinder's polygon lies a little inside its box.
        c, s = np.cos(obstacle.yaw), np.sin(obstacle.yaw)
        local = (solid - obstacle.center) @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        np.testing.assert_allclose(np.abs(local).max(axis=0), np.asarray(obstacle.size) / 2.0, atol=0.03)


@pytest.mark.parametrize("name", sorted(STAGES))
def test_one_seed_one_place(tmp_path: Path, name: str) -> None:
    first, second = _stage(name, 4, tmp_path / "a"), _stage(name, 4, tmp_path / "b")
    for one, other in zip(first.meshes, second.meshes, strict=True):
        np.testing.assert_array_equal(one.vertices, other.vertices)
        assert one.material.base_color == other.material.base_color
        pictures = (one.material.base_color_texture, other.material.base_color_texture)
        assert len({sha256_of(picture) if picture is not None else None for picture in pictures}) == 1
    assert (first.lights, first.environment) == (second.lights, second.environment)
    other_place = _stage(name, 5, tmp_path / "c")
    assert [mesh.vertices.sum() for mesh in other_place.meshes] != [
        mesh.vertices.sum() for mesh in first.meshes
    ]


@pytest.mark.parametrize("name", sorted(STAGES))
def test_a_stage_reaches_beyond_a_long_walk(tmp_path: Path, name: str) -> None:
    paths = WALK * 4.0  # 32 m
    stage = STAGES[name](np.random.default_rng(2), paths, tmp_path)
    low = np.min([mesh.vertices.min(axis=0) for mesh in stage.meshes], axis=0)
    high = np.max([mesh.vertices.max(axis=0) for mesh in stage.meshes], axis=0)
    assert (low[:2] < paths.min(axis=0) - 4.0).all()
    assert (high[:2] > paths.max(axis=0) + 4.0).all()
