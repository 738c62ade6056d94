"""The rasteriser against closed forms, against rays through pixel centres, and its own invariants."""

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import map_coordinates
from scipy.spatial import Delaunay, QhullError

from whacamole.labels import RasterMesh, rasterize
from whacamole.labels.cutout import Cutout
from whacamole.labels.raster import outermost

WIDTH, HEIGHT = 64, 48
K = np.array([[60.0, 0.0, 32.0], [0.0, 55.0, 24.0], [0.0, 0.0, 1.0]])


def pixel_rays() -> np.ndarray:
    """Directions with z = 1 through the pixel centres, ``(H, W, 3)``."""
    x, y = np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5)
    return np.stack([x, y, np.ones_like(x)], axis=-1) @ np.linalg.inv(K).T


def first_hit(vertices: np.ndarray, faces: np.ndarray, near: float) -> np.ndarray:
    """Depth of the first triangle each ray meets beyond ``near`` (Möller and Trumbore), one at a time."""
    rays = pixel_rays()
    depth = np.full((HEIGHT, WIDTH), np.inf)
    for a, b, c in vertices[faces]:
        across = np.cross(rays, c - a)
        with np.errstate(divide="ignore", invalid="ignore"):
            scale = 1.0 / (across @ (b - a))
            u = across @ -a * scale
            turned = np.cross(-a, b - a)
            v = rays @ turned * scale
            z = (c - a) @ turned * scale
        hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (z >= near)
        depth = np.where(hit & (z < depth), z, depth)
    return depth


def sphere(radius: float, centre: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    mesh = trimesh.creation.icosphere(subdivisions=5, radius=radius)
    return mesh.vertices + np.array(centre), np.asarray(mesh.faces)


def test_plane_depth_is_exact():
    # z = 2 + 0.3 x - 0.2 y, so along a ray (x, y, 1) z the depth is 2 / (1 - 0.3 x + 0.2 y).
    x, y = np.meshgrid(np.linspace(-40, 40, 9), np.linspace(-40, 40, 9))
    corners = np.stack([x, y, 2 + 0.3 * x - 0.2 * y], axis=-1).reshape(-1, 3)
    quads = np.array([[i, i + 1, i + 10, i + 9] for i in range(71) if i % 9 < 8])
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    raster = rasterize([RasterMesh(corners, faces)], K, WIDTH, HEIGHT)
    rays = pixel_rays()
    expected = 2 / (1 - 0.3 * rays[..., 0] + 0.2 * rays[..., 1])
    np.testing.assert_allclose(raster.depth, expected, rtol=1e-12)
    assert (raster.mesh == 0).all()


@pytest.mark.parametrize("cull", [False, True])
def test_sphere_depth(cull: bool):
    radius, centre = 0.5, (0.1, -0.05, 2.0)
    vertices, faces = sphere(radius, centre)
    raster = rasterize([RasterMesh(vertices, faces, cull_back=cull)], K, WIDTH, HEIGHT)
    rays = pixel_rays()
    along = rays @ np.array(centre)
    square = (rays**2).sum(axis=-1)
    disc = along**2 - square * (np.dot(centre, centre) - radius**2)
    hit = disc > 0
    depth = (along - np.sqrt(np.maximum(disc, 0))) / square
    assert np.count_nonzero((raster.mesh >= 0) != hit) <= 6  # the polyhedron lies inside the sphere
    inner = disc > 0.1 * disc.max()
    np.testing.assert_allclose(raster.depth[inner], depth[inner], atol=1.5e-3)


@given(seed=st.integers(0, 2**32 - 1), near=st.sampled_from([0.01, 0.5]))
@settings(max_examples=40, deadline=None, derandomize=True)
def test_agrees_with_rays_for_any_triangles(seed: int, near: float):
    rng = np.random.default_rng(seed)
    vertices = rng.normal(size=(30, 3)) * [1.0, 1.0, 1.5] + [0, 0, 1.0]  # many cross the near plane
    faces = rng.permutation(30).reshape(10, 3)
    raster = rasterize([RasterMesh(vertices, faces)], K, WIDTH, HEIGHT, near=near)
    expected = first_hit(vertices, faces, near)
    # Only pixel centres within rounding of an edge may differ, and there are none among random numbers.
    np.testing.assert_array_equal(np.isfinite(raster.depth), np.isfinite(expected))
    seen = np.isfinite(expected)
    np.testing.assert_allclose(raster.depth[seen], expected[seen], rtol=1e-6)


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=30, deadline=None, derandomize=True)
def test_shared_edges_partition_the_plane(seed: int):
    """Every pixel under a triangulated sheet is filled once: no crack, no overlap, even at lattice points."""
    rng = np.random.default_rng(seed)
    # Corners on pixel centres and edges, the worst case for a fill rule.
    grid = rng.integers(0, 2 * np.array([WIDTH, HEIGHT]), size=(20, 2)) / 2.0
    try:
        faces = Delaunay(grid).simplices
    except QhullError:
        return
    z = 1.7
    vertices = np.concatenate([(grid - K[:2, 2]) / [K[0, 0], K[1, 1]] * z, np.full((20, 1), z)], axis=1)
    alone = [rasterize([RasterMesh(vertices, face[None])], K, WIDTH, HEIGHT).mesh >= 0 for face in faces]
    together = rasterize([RasterMesh(vertices, faces)], K, WIDTH, HEIGHT)
    np.testing.assert_array_equal(np.sum(alone, axis=0), together.mesh >= 0)


def test_nearer_mesh_hides_the_farther_in_either_order():
    near, faces = sphere(0.3, (0, 0, 1.5))
    far, _ = sphere(0.6, (0.1, 0, 3.0))
    one = rasterize([RasterMesh(near, faces), RasterMesh(far, faces)], K, WIDTH, HEIGHT)
    two = rasterize([RasterMesh(far, faces), RasterMesh(near, faces)], K, WIDTH, HEIGHT)
    np.testing.assert_array_equal(one.depth, two.depth)
    np.testing.assert_array_equal(one.triangle, two.triangle)
    np.testing.assert_array_equal(one.mesh == 0, two.mesh == 1)


def test_triangle_index_names_the_triangle():
    vertices, faces = sphere(0.5, (0, 0, 2.0))
    raster = rasterize([RasterMesh(vertices, faces)], K, WIDTH, HEIGHT)
    rows, columns = np.nonzero(raster.triangle >= 0)
    points = pixel_rays()[rows, columns] * raster.depth[rows, columns, None]
    corners = vertices[faces[raster.triangle[rows, columns]]]
    bary = trimesh.triangles.points_to_barycentric(corners, points)
    assert bary.min() > -1e-6


def test_nothing_to_draw():
    empty = rasterize([], K, WIDTH, HEIGHT)
    assert np.isinf(empty.depth).all()
    behind = RasterMesh(np.array([[0, 0, -1.0], [1, 0, -1], [0, 1, -2]]), np.array([[0, 1, 2]]))
    assert (rasterize([behind], K, WIDTH, HEIGHT).mesh == -1).all()


def test_a_cutout_is_cut_where_the_ray_meets_opaque_texture():
    # The floor y = 1 as one quad that passes under the camera, so cut at the near plane; u runs with x and v
    # with z, the texture repeats. Its 8 x 8 alpha is noise, asked for by SciPy's own interpolation.
    corners = np.array([[-4.0, 1, -3], [4, 1, -3], [4, 1, 9], [-4, 1, 9]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    alpha = np.random.default_rng(5).integers(0, 256, (8, 8), dtype=np.uint8)
    uv = np.stack([corners[:, 0] / 5, corners[:, 2] / 4], axis=1)
    cut = RasterMesh(corners, faces, cutout=Cutout(alpha, uv[faces]))
    wall = RasterMesh(np.array([[-90.0, -90, 20], [90, -90, 20], [0, 180, 20]]), np.array([[0, 1, 2]]))
    drawn = rasterize([cut, wall], K, WIDTH, HEIGHT)
    rays = pixel_rays()
    with np.errstate(divide="ignore", invalid="ignore"):
        hit = rays / rays[..., 1:2]
    on_floor = (rays[..., 1] > 0) & (np.abs(hit[..., 0]) < 4) & (hit[..., 2] < 9)
    x, z = np.where(on_floor, hit[..., 0], 0.0), np.where(on_floor, hit[..., 2], 0.0)
    at = [(1 - z / 4) * 8 - 0.5, x / 5 * 8 - 0.5]
    there = map_coordinates(alpha.astype(float), at, order=1, mode="grid-wrap") > 127.5
    np.testing.assert_array_equal(drawn.mesh, np.where(on_floor & there, 0, 1))
    np.testing.assert_allclose(drawn.depth[drawn.mesh == 0], z[on_floor & there], rtol=1e-9)
    assert 0.2 < there[on_floor].mean() < 0.8
    # Drawn after what hides it, or before: the same.
    swapped = rasterize([wall, cut], K, WIDTH, HEIGHT)
    np.testing.assert_array_equal(swapped.depth, drawn.depth)


def test_the_outline_of_a_cutout_reaches_as_far_as_what_is_there():
    # A disc of alpha on a square of 2 m that two triangles make.
    across, down = np.meshgrid(np.arange(64) - 31.5, np.arange(64) - 31.5)
    alpha = np.where(np.hypot(across, down) < 26, 255, 0).astype(np.uint8)  # radius 26 / 32 m
    corners = np.array([[-1.0, -1, 4], [1, -1, 4], [1, 1, 4], [-1, 1, 4]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    uv = np.stack([(corners[:, 0] + 1) / 2, (1 - corners[:, 1]) / 2], axis=1)
    found = outermost(RasterMesh(corners, faces, cutout=Cutout(alpha, uv[faces])))
    assert np.hypot(found[:, 0], found[:, 1]).max() < 26.5 / 32
    reach = np.abs([found.min(axis=0), found.max(axis=0)])[:, :2]
    assert (reach > 26 / 32 - 2 / 8).all()  # short by less than a step, an eighth of the side
    whole = outermost(RasterMesh(corners, faces, cutout=Cutout(np.full((2, 2), 255, np.uint8), uv[faces])))
    np.testing.assert_allclose(np.unique(whole, axis=0), np.unique(corners, axis=0))
