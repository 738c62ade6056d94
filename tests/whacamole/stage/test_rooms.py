"""Rooms: walls closed but for their openings, openings closed by what is in them, lamps under fixtures."""

from collections.abc import Callable

import numpy as np
import pytest
import trimesh

from render_jobs import Lamp
from whacamole.stage import STAGES, Stage
from whacamole.stage.courts import COURTS, HEIGHT, court_lines
from whacamole.stage.floor import Floor
from whacamole.stage.props import Prop
from whacamole.stage.props.pieces import cushion, rod
from whacamole.stage.props.seats import armchair, chair, sofa
from whacamole.stage.props.sports import RING, goal, hoop, wall_bars
from whacamole.stage.props.storage import bookcase, kitchen, sideboard, television
from whacamole.stage.props.store import barrels, crates, pallet_rack
from whacamole.stage.props.tables import dining_table
from whacamole.stage.rooms import Rect, WindowKind, room, window
from whacamole.stage.shapes import Solid

WALK = np.stack([np.linspace(-4.0, 4.0, 80), np.sin(np.linspace(0.0, 3.0, 80))], axis=1)
ROOMS = ("living-room", "sports-hall", "warehouse")


def _surface(solid: Solid) -> trimesh.Trimesh:
    faces = solid.faces
    if faces.shape[1] == 4:
        faces = np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]])
    return trimesh.Trimesh(solid.vertices, faces, process=False)


def _stage(name: str, seed: int) -> Stage:
    return STAGES[name](np.random.default_rng(seed), WALK, None)


def test_a_ball_and_a_rod_have_their_volumes() -> None:
    ball = _surface(cushion((0.0, 0.0, 1.0), (2.0, 2.0, 2.0), 1.0))
    assert ball.is_watertight
    assert ball.volume == pytest.approx(4.0 / 3.0 * np.pi, rel=0.12)
    np.testing.assert_allclose(np.linalg.norm(ball.vertices - [0.0, 0.0, 2.0], axis=1), 1.0, atol=0.02)
    one = _surface(rod((1.0, 2.0, 0.5), (1.0, 4.0, 2.5), 0.1, sides=64))
    assert one.is_watertight
    assert one.volume == pytest.approx(np.pi * 0.1**2 * np.sqrt(8.0), rel=0.01)


@pytest.mark.parametrize(
    "make",
    [armchair, chair, sofa, goal, hoop, wall_bars, bookcase, kitchen, sideboard, television, barrels, crates,
     pallet_rack, dining_table],
)  # fmt: skip
def test_parts_of_a_prop_face_outwards_and_stand_on_the_floor(make: Callable[..., Prop]) -> None:
    prop = make(np.random.default_rng(1))
    low = np.min([part.solid.vertices.min(axis=0) for part in prop.parts], axis=0)
    high = np.max([part.solid.vertices.max(axis=0) for part in prop.parts], axis=0)
    w, d, h = prop.size
    np.testing.assert_allclose([low, high], [[-w / 2, -d / 2, 0.0], [w / 2, d / 2, h]], atol=1e-5)
    for part in prop.parts:
        surface = _surface(part.solid)
        assert surface.is_watertight
        assert surface.volume > 0.0


def test_a_window_takes_its_area_out_of_the_wall_and_is_closed_behind() -> None:
    shell = room(Floor(WALK), margin=4.0, height=3.0)
    wall = shell.walls[1]
    before = _surface(wall.solid()).volume
    rect = window(wall, 1.0, 1.4, WindowKind(0.9, 2.2), np.random.default_rng(0))
    assert before - _surface(wall.solid()).volume == pytest.approx(1.4 * 1.3 * 0.3, rel=1e-4)
    (sky,) = [solid for finish, solid in wall.trim.merged() if finish == "sky"]
    assert sky.vertices[:, 0].min() == pytest.approx(rect.left)
    assert sky.vertices[:, 0].max() == pytest.approx(rect.right)
    assert 0.0 < sky.vertices[:, 1].min() < 0.3  # within the wall's thickness
    assert not wall.is_free(Rect(0.9, 1.1, 1.0, 1.1))
    # Its axes: +x of the wall is to the right of who looks at it from inside.
    right, foot = np.asarray(wall.place(1.0)), np.asarray(wall.place(0.0))
    out = foot - np.asarray(wall.place(0.0, away=1.0))
    assert np.cross(right - foot, out)[2] > 0.99


@pytest.mark.parametrize("name", ROOMS)
def test_lamps_hang_just_below_what_looks_lit_or_before_a_window(name: str) -> None:
    for seed in range(3):
        stage = _stage(name, seed)
        glowing = {mesh.name: mesh.vertices for mesh in stage.meshes if mesh.material.emission_strength > 0.0}
        for lamp in stage.lights:
            assert isinstance(lamp, Lamp)
            below = lamp.target[2] == 0.0
            solid = np.concatenate(
                [v for n, v in glowing.items() if n.startswith("room-lit" if below else "room-sky")]
            )
            gap = np.linalg.norm(solid - np.asarray(lamp.position), axis=1).min()
            assert gap < (0.8 if below else 2.0)


def test_a_ring_hangs_at_its_height_and_a_court_has_its_measures() -> None:
    prop = hoop(np.random.default_rng(0))
    ring = np.concatenate([part.solid.vertices for part in prop.parts if part.finish == "ball"])
    top_of_board = prop.size[2]
    assert ring[:, 2].mean() - top_of_board == pytest.approx(-0.9, abs=0.02)
    assert RING == 3.05
    for kind, (length, width) in COURTS.items():
        lines = court_lines(kind, np.zeros(2), 0.0).vertices
        np.testing.assert_allclose(lines.max(axis=0), [length / 2, width / 2, HEIGHT], atol=1e-5)
        np.testing.assert_allclose(lines.min(axis=0), [-length / 2, -width / 2, 0.0], atol=1e-5)


@pytest.mark.parametrize("name", ROOMS)
def test_what_hangs_on_walls_stays_near_them(name: str) -> None:
    """Trim is no obstacle: up to 2.2 m it lies within 10 cm of a wall, or flat on the floor."""
    for seed in range(4):
        stage = _stage(name, seed)
        assert stage.world.bounds is not None
        low, high = (np.asarray(corner)[:2] for corner in stage.world.bounds)
        points = np.concatenate([mesh.vertices for mesh in stage.meshes if mesh.name.startswith("room-")])
        points = points[(points[:, 2] < 2.2) & (points[:, 2] > 0.01)]
        inside = np.minimum(points[:, :2] - low, high - points[:, :2]).min(axis=1)
        assert inside.max() < 0.1
