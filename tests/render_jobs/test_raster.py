"""The raster engine against Cycles on the same job, and its own parts."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray
from PIL import Image

from render_jobs import (
    PASSES,
    EngineError,
    Environment,
    Lamp,
    Material,
    Mesh,
    Quality,
    RenderJob,
    RenderJobError,
    Sun,
    run_job,
)
from render_jobs.raster.lighting import light_arrays
from render_jobs.raster.subdivide import subdivide
from render_jobs.raster.surfaces import surface_of
from render_jobs.raster.surroundings import surroundings_of
from render_truth import BOX, BOX_FACES, SQUARE, SQUARE_FACES, camera, moving, read_picture, rendered_frame
from whacamole.body import BodyModel


def two_people(folder: Path) -> RenderJob:
    """Two bodies at rest, one before the other, on a chequered floor; sun, lamp and sky."""
    body = BodyModel.embedded()
    rest = body.v_template @ np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]], float)  # y up to z up
    rest[:, 2] -= rest[:, 2].min()
    chequers = (np.indices((64, 64)).sum(axis=0) // 8 % 2 * 120 + 80).astype(np.uint8)
    Image.fromarray(np.stack([chequers] * 3, axis=-1)).save(folder / "floor.png")
    floor = Material(base_color_texture=folder / "floor.png", uv_scale=8.0, roughness=0.9)
    skin = Material(base_color=(0.8, 0.6, 0.5), roughness=0.7)
    uv = np.array([[[0, 0], [1, 0], [1, 1], [0, 1]]], float)
    people = [
        Mesh(f"person-{index}", (rest + offset).astype(np.float32), body.faces, skin, track_id=index)
        for index, offset in ((1, [-0.2, 0, 0]), (2, [0.3, 0.9, 0]))
    ]
    return RenderJob(
        camera([[0.6, -3.6, 1.5]], [0, 0, 0.9], [170.0], [[80.0, 60.0]], (160, 120)),
        (*people, Mesh("floor", SQUARE * 6, SQUARE_FACES, floor, uv=uv)),
        lights=(Sun(direction=(0.5, 0.6, -1.0), strength=2.0),),
        environment=Environment(color=(0.7, 0.75, 0.8), strength=0.8),
        passes=tuple(PASSES),
        quality=Quality(name="test", samples=32),
        image_format="png",
        tone="standard",
    )


@pytest.mark.gl
@pytest.mark.blender
def test_both_engines_show_the_same(tmp_path: Path) -> None:
    job = two_people(tmp_path)
    for engine in ("cycles", "raster"):
        job.save(tmp_path / engine)
        run_job(tmp_path / engine, engine=engine, device="cpu", threads=2, timeout=300)
    cycles, raster = (rendered_frame(tmp_path / engine, 0) for engine in ("cycles", "raster"))
    for person in (1, 2):
        mine, theirs = raster.mask == person, cycles.mask == person
        assert theirs.sum() > 500
        assert (mine & theirs).sum() / (mine | theirs).sum() >= 0.99
        both = mine & theirs
        assert np.median(np.abs(raster.depth[both] - cycles.depth[both])) < 0.005
        turned = np.sum(raster.normal * cycles.normal, axis=-1)[both]
        assert np.median(turned) > np.cos(np.radians(1.0))
        assert np.median(np.abs(raster.flow - cycles.flow)[both]) < 0.05
    pictures = [
        read_picture(tmp_path / engine / "out/rgb/000000.png").astype(float)
        for engine in ("cycles", "raster")
    ]
    for region in (cycles.mask == 1, cycles.mask == 0, np.isinf(cycles.depth)):
        means = [picture[region].mean(axis=0) for picture in pictures]
        assert np.abs(means[0] - means[1]).max() < 30, "brightness and colour are alike, of 255"


@pytest.mark.gl
def test_the_same_job_gives_the_same_picture_again_and_a_bad_one_is_named(tmp_path: Path) -> None:
    job = replace(two_people(tmp_path), image_format="jpg")
    contents = []
    for name in ("one", "two"):
        job.save(tmp_path / name)
        result = run_job(tmp_path / name, engine="raster", timeout=120)
        assert result.frames == 1
        contents.append([path.read_bytes() for path in sorted((tmp_path / name / "out").rglob("*.*"))])
    assert contents[0] == contents[1]
    (tmp_path / "floor.png").write_bytes((tmp_path / "floor.png").read_bytes()[:60])
    job.save(tmp_path / "bad")
    with pytest.raises(RenderJobError, match="the image is damaged") as caught:
        run_job(tmp_path / "bad", engine="raster", timeout=120)
    assert "\n" not in str(caught.value)


@pytest.mark.gl
def test_where_there_is_no_driver_the_message_says_what_to_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    two_people(tmp_path).save(tmp_path / "job")
    monkeypatch.setenv("PYOPENGL_PLATFORM", "egl")
    monkeypatch.setenv("EGL_DEVICE_ID", "99")
    with pytest.raises(EngineError, match="no OpenGL to draw with") as caught:
        run_job(tmp_path / "job", engine="raster", timeout=120)
    assert "\n" not in str(caught.value)


def test_vertices_are_parted_only_where_texture_coordinates_differ() -> None:
    uv = np.tile(np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float), (6, 1, 1))
    mesh = Mesh("box", moving(BOX, [0.1, 0, 0], 1), BOX_FACES, uv=uv)
    surface = surface_of(mesh)
    assert len(surface.triangles) == 12
    assert len(surface.corner_vertex) == len(
        np.unique(np.column_stack([surface.corner_vertex, surface.uv]), axis=0)
    )
    corners = surface.positions(0)[surface.triangles]
    np.testing.assert_array_equal(corners, mesh.frame(0)[surface.mesh_triangles])
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    assert area.sum() == pytest.approx(6.0)
    # at a corner of a cube the normal points along the diagonal, whichever way its faces are cut
    outward = surface.normals(0) @ np.ones(3)
    assert outward.max() > 1.5
    np.testing.assert_allclose(np.linalg.norm(surface.normals(0), axis=1), 1.0, rtol=1e-6)


def test_lamps_give_what_their_watts_say() -> None:
    surroundings = surroundings_of(Environment(color=(1.0, 1.0, 1.0), strength=0.5))
    np.testing.assert_allclose(surroundings.above, 0.5, rtol=1e-4)
    np.testing.assert_allclose(surroundings.below, 0.5, rtol=1e-4)
    lights = light_arrays(
        (
            Lamp(kind="point", position=(0, 0, 3), power_w=100.0),
            Lamp(kind="area", position=(0, 0, 3), target=(0, 0, 0), power_w=100.0),
            Sun(direction=(0, 0, -2), strength=3.0),
        ),
        surroundings,
    )
    assert lights.shadow_of == 0, "the sun comes first"
    np.testing.assert_allclose(lights.position[0], [0, 0, 1, 0])
    np.testing.assert_allclose(lights.color[:, 0], [3.0, 100 / np.pi, 100 / (4 * np.pi)], rtol=1e-5)
    np.testing.assert_allclose(lights.axis[1], [0, 0, -1, 0], atol=1e-6)


def test_the_bright_spot_of_an_environment_map_becomes_a_sun() -> None:
    for name in ("forest", "sunset", "studio"):
        plain = surroundings_of(Environment(kind="hdri", hdri=name))
        turned = surroundings_of(Environment(kind="hdri", hdri=name, rotation=90.0))
        assert (plain.sun is None) == (turned.sun is None)
        np.testing.assert_allclose(plain.above, turned.above, rtol=1e-4)
        if plain.sun is not None and turned.sun is not None:
            x, y, z = plain.sun[0]
            np.testing.assert_allclose(turned.sun[0], [-y, x, z], atol=0.02)


def test_a_cube_subdivides_to_the_points_that_the_rules_give() -> None:
    cube = BOX - [0.0, 0.0, 0.5]
    refined = subdivide(BOX_FACES.astype(np.int32), None, 8, 1)
    points = refined.operator @ cube
    assert points.shape == (8 + 12 + 6, 3)
    # corner: F̄ = c/3, R̄ = 2c/3, n = 3, hence (c/3 + 4c/3 + 0)/3 = 5c/9; edge: 3/4 of its midpoint
    np.testing.assert_allclose(points[:8], cube * 5 / 9, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(points[8:20], axis=1), np.hypot(0.5, 0.5) * 0.75, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(points[20:], axis=1), 0.5, atol=1e-12)
    assert len(refined.faces) == 24


@settings(max_examples=30, derandomize=True, deadline=None)
@given(arrays(np.float64, (3, 4), elements=st.floats(-10, 10)), st.integers(1, 2), st.booleans())
def test_subdivision_commutes_with_affine_maps_and_keeps_flat_rims(
    affine: NDArray[np.float64], levels: int, triangles: bool
) -> None:
    quads = np.array([[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]], np.int32)
    halves = np.array([[4, 5, 8, -1], [4, 8, 7, -1]], np.int32)
    faces = np.concatenate([quads[:3], halves]) if triangles else quads
    flat = np.array([[x, y, 0.0] for y in range(3) for x in range(3)], float)
    refined = subdivide(faces, None, 9, levels)
    np.testing.assert_allclose(refined.operator.sum(axis=1), 1.0, atol=1e-12)
    moved = flat @ affine[:, :3].T + affine[:, 3]
    np.testing.assert_allclose(
        refined.operator @ moved, (refined.operator @ flat) @ affine[:, :3].T + affine[:, 3], atol=1e-9
    )
    points = refined.operator @ flat
    assert np.abs(points[:, 2]).max() == 0.0
    assert points.min() >= 0.0
    assert points.max() <= 2.0


@pytest.mark.gl
@pytest.mark.blender
def test_both_engines_subdivide_alike(tmp_path: Path) -> None:
    """A box with an open side and triangles among its quads, textured, moving."""
    faces = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, -1], [0, 6, 4, -1]])
    mesh = Mesh("box", moving(BOX, [0.1, 0, 0.02], 1), faces, subdivision=2, track_id=1)
    path = camera([[1.2, -2.6, 1.8]], [0, 0, 0.5], [120.0], [[48.0, 32.0]])
    job = RenderJob(
        path, (mesh,), passes=tuple(PASSES), quality=Quality(name="test", samples=1, denoise="off")
    )
    for engine in ("cycles", "raster"):
        job.save(tmp_path / engine)
        run_job(tmp_path / engine, engine=engine, device="cpu", threads=2, timeout=300)
    cycles, raster = (rendered_frame(tmp_path / engine, 0) for engine in ("cycles", "raster"))
    assert (cycles.mask == raster.mask).mean() > 0.998
    both = (cycles.mask == 1) & (raster.mask == 1)
    assert both.sum() > 500
    # the vertices are the same; a bent quad may be cut along its other diagonal
    away = np.abs(cycles.depth[both] - raster.depth[both])
    assert np.median(away) < 1e-4
    assert np.quantile(away, 0.99) < 0.01
    assert np.median(np.abs(cycles.flow[both] - raster.flow[both])) < 0.001
