"""What closes the view: far off, all around, in nobody's way, and below the lowest sun."""

import numpy as np
import pytest
from numpy.typing import NDArray

from render_jobs import Mesh
from whacamole.stage import SetBuilder
from whacamole.stage.floor import Floor
from whacamole.stage.horizon import Prospect, horizon
from whacamole.stage.textures.distance import distant_front, distant_woods, hazed

WALK = np.stack([np.linspace(2.0, 26.0, 80), 5.0 + np.sin(np.linspace(0.0, 3.0, 80))], axis=1)
PROSPECTS: tuple[Prospect, ...] = ("town", "night-town", "country", "roofs")
LOWEST_SUN = np.radians(12.0)


def _built(prospect: Prospect, seed: int) -> SetBuilder:
    build = SetBuilder(None)
    horizon(build, Floor(WALK), prospect, np.random.default_rng(seed))
    return build


def _surface_points(mesh: Mesh) -> NDArray[np.float64]:
    """The middle of each edge of the mesh (N, 3), and its corners."""
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    return np.concatenate(
        [corners.reshape(-1, 3), ((corners + np.roll(corners, 1, axis=1)) / 2).reshape(-1, 3)]
    )


@pytest.mark.parametrize("prospect", PROSPECTS)
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_the_view_is_closed_far_off_and_in_nobodys_way(prospect: Prospect, seed: int) -> None:
    build = _built(prospect, seed)
    assert not build.obstacles
    eye = np.array([14.0, 5.0, 1.6])
    points = np.concatenate([_surface_points(mesh) for mesh in build.meshes if mesh.name != "streets"])
    away = np.linalg.norm(points[:, None, :2] - WALK[::8], axis=2).min(axis=1)
    assert away.min() > 25.0
    elevation = np.arctan2(points[:, 2], away)
    assert elevation.max() < LOWEST_SUN, "its shadow would fall on the people"
    # In each of 24 directions something stands up into the horizon line, or lies just below it from a roof.
    sector = np.floor(np.arctan2(*(points - eye)[:, 1::-1].T) / (2.0 * np.pi) * 24).astype(int) % 24
    least = -2.0 if prospect == "roofs" else 2.0
    assert all(np.degrees(elevation[sector == one].max()) > least for one in range(24))
    assert sum(mesh.faces.shape[0] for mesh in build.meshes) < 9000


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_windows_are_lit_on_the_fronts_of_the_first_row(seed: int) -> None:
    meshes = {mesh.name: mesh for mesh in _built("night-town", seed).meshes}
    windows = meshes["far-windows"]
    assert windows.material.emission_strength > 0.0
    panes = windows.vertices[windows.faces].astype(np.float64)
    walls = np.concatenate(
        [mesh.vertices[mesh.faces] for name, mesh in meshes.items() if name.startswith("town-0.front")]
    ).astype(np.float64)
    normal = np.cross(walls[:, 1] - walls[:, 0], walls[:, 2] - walls[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    center = panes.mean(axis=1)
    height = np.einsum("fi,pfi->pf", normal, center[:, None] - walls[:, 0])
    inside = np.ones_like(height, bool)
    for corner in range(3):
        edge = walls[:, (corner + 1) % 3] - walls[:, corner]
        side = np.cross(edge, center[:, None] - walls[:, corner])
        inside &= np.einsum("pfi,fi->pf", side, normal) > -1e-6
    assert ((np.abs(height - 0.05) < 1e-3) & inside).any(axis=1).all()
    facing = np.cross(panes[:, 1] - panes[:, 0], panes[:, 3] - panes[:, 0])
    towards = np.array([14.0, 5.0, 1.0]) - center
    assert (np.einsum("pi,pi->p", facing, towards) > 0.0).all()


def test_haze_makes_pale_and_takes_contrast_away() -> None:
    near, far = (distant_front(np.random.default_rng(0), haze=haze) for haze in (0.0, 0.5))
    assert far.std() < 0.6 * near.std()
    np.testing.assert_allclose(hazed(np.zeros(3), 1.0), hazed(np.ones(3), 1.0))


@pytest.mark.parametrize("seed", range(4))
def test_woods_repeat_along_the_ring_and_close_it(seed: int) -> None:
    image = distant_woods(np.random.default_rng(seed))
    assert image.shape == (128, 512, 3)
    seam = np.abs(image[:, 0] - image[:, -1]).mean()
    assert seam < 1.5 * np.abs(np.diff(image, axis=1)).mean(axis=(0, 2)).max()
    rows = [mesh for mesh in _built("country", seed).meshes if mesh.name.startswith("far-trees")]
    assert len(rows) == 2
    for mesh in rows:
        foot, top = mesh.vertices[: mesh.num_vertices // 2], mesh.vertices[mesh.num_vertices // 2 :]
        np.testing.assert_allclose(foot[0], foot[-1], atol=1e-3)
        np.testing.assert_allclose(top[0], top[-1], atol=1e-3)
        assert (top[:, 2] > 2.0).all(), "no gap"
        assert np.ptp(top[:, 2]) > 2.0, "trees differ"
