"""Houses and what stands before them: windows in openings, fronts to people, props that fill their boxes."""

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from render_jobs import Lamp
from whacamole.stage import STAGES
from whacamole.stage.props import MARKET, ROOF, STREET, YARD, PropMaker, fountain, paint_outdoors, stair_house
from whacamole.stage.props.outdoor_finishes import PAINTED
from whacamole.stage.props.plants import plant_finishes
from whacamole.stage.shapes import Solid
from whacamole.stage.stage import SetBuilder
from whacamole.stage.town.front import build_house
from whacamole.stage.town.house import Town, draw_house
from whacamole.stage.town.walls import THICK

WALK = np.stack([np.linspace(-4.0, 4.0, 80), np.sin(np.linspace(0.0, 3.0, 80))], axis=1)
MAKERS = {maker.__name__: maker for maker in (*STREET, *YARD, *MARKET, *ROOF, fountain, stair_house)}


@pytest.mark.parametrize("name", sorted(MAKERS))
def test_a_prop_stands_on_the_floor_and_fills_its_box(name: str) -> None:
    maker: PropMaker = MAKERS[name]
    sizes = set()
    for seed in range(6):
        prop = maker(np.random.default_rng(seed))
        vertices = np.concatenate([part.solid.vertices for part in prop.parts])
        half = np.array(prop.size) / 2
        np.testing.assert_allclose(vertices.min(axis=0), [-half[0], -half[1], 0.0], atol=1e-4)
        np.testing.assert_allclose(vertices.max(axis=0), [half[0], half[1], prop.size[2]], atol=1e-4)
        sizes.add(prop.size)
    assert len(sizes) > 2


def test_every_finish_of_a_prop_can_be_painted() -> None:
    build, rng = SetBuilder(None), np.random.default_rng(0)
    finishes = plant_finishes(build, rng) | paint_outdoors(build, tuple(PAINTED), rng, posted=True)
    for maker in MAKERS.values():
        for seed in range(12):
            assert {part.finish for part in maker(np.random.default_rng(seed)).parts} <= set(finishes)


def _boxes(solid: Solid) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    corners = solid.vertices.astype(np.float64).reshape(-1, 8, 3)
    return corners.min(axis=1), corners.max(axis=1)


@pytest.mark.parametrize("seed", range(8))
def test_windows_are_in_openings_of_a_wall_that_fills_the_block(seed: int) -> None:
    rng = np.random.default_rng(seed)
    house = draw_house(rng, float(rng.uniform(7.0, 13.0)), Town())
    walls, details = build_house(house, rng)
    solids = [solid for _, solid in walls.merged()]
    vertices = np.concatenate([solid.vertices for solid in solids])
    np.testing.assert_allclose(vertices.min(axis=0), 0.0, atol=1e-6)
    np.testing.assert_allclose(vertices.max(axis=0), [house.width, house.depth, house.height], rtol=1e-6)
    low, high = (np.concatenate(ends) for ends in zip(*map(_boxes, solids), strict=True))
    fronts = low[:, 1] < 1e-6
    area = np.prod(high[fronts][:, [0, 2]] - low[fronts][:, [0, 2]], axis=1).sum()
    glass = [s for finish, s in details.merged() if finish in ("pane", "shop")]
    panes = np.concatenate([solid.vertices.reshape(-1, 4, 3) for solid in glass]).astype(np.float64)
    panes = panes[(panes[:, :, 1] < THICK).all(axis=1) & (panes[:, :, 2].max(axis=1) < house.height)]
    assert len(panes) >= house.bays * (house.upper + 1)
    middle = panes.mean(axis=1)
    covered = ((middle[:, None] > low) & (middle[:, None] < high)).all(axis=2)
    assert not covered.any(), "a pane is walled in"
    # What is neither wall nor glass of the front is the doors' leaves.
    glazed = np.prod(np.ptp(panes[:, :, [0, 2]], axis=1), axis=1).sum()
    assert house.width * house.height - area - glazed == pytest.approx(2.1 + 0.06, abs=0.02)


@pytest.mark.parametrize("name", ["plaza", "market", "courtyard", "night-street"])
def test_fronts_look_at_the_people(name: str) -> None:
    stage = STAGES[name](np.random.default_rng(3), WALK, None)
    panes = [mesh for mesh in stage.meshes if mesh.name.endswith((".pane", ".shop", ".lit"))]
    assert panes
    for mesh in panes:
        corners = np.asarray(mesh.vertices, np.float64)[np.asarray(mesh.faces)]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 1])
        assert (np.einsum("ni,ni->n", normal[:, :2], -corners.mean(axis=1)[:, :2]) > 0.0).all()


def test_nothing_of_a_front_hangs_into_the_heads_of_people() -> None:
    for seed in range(12):
        rng = np.random.default_rng(seed)
        _, details = build_house(draw_house(rng, 10.0, Town(shops=1.0)), rng)
        for finish, solid in details.merged():
            out = solid.vertices[solid.vertices[:, 1] < -0.4]
            assert not len(out) or out[:, 2].min() > 2.1, finish


def test_lamps_of_the_street_are_in_their_lanterns(tmp_path: Path) -> None:
    stage = STAGES["night-street"](np.random.default_rng(1), WALK, None)
    (bulbs,) = [mesh for mesh in stage.meshes if mesh.name == "lanterns.lamp"]
    lamps = [light for light in stage.lights if isinstance(light, Lamp)]
    assert lamps
    for lamp in lamps:
        gap = np.linalg.norm(np.asarray(bulbs.vertices) - np.array(lamp.position), axis=1)
        assert gap.min() < 0.25
    assert bulbs.material.emission_strength > 0.0
