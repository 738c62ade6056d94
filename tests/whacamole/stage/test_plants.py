"""Plants and park furniture: whole in their boxes, on the ground, of the size of real ones."""

import numpy as np
import pytest

from whacamole.stage import STAGES, SetBuilder
from whacamole.stage.props import Prop, PropMaker
from whacamole.stage.props.park_furniture import SEAT, bench, bin_, fence, lamp_post
from whacamole.stage.props.plants import bush, flower_bed, hedge, plant_finishes, potted

WALK = np.stack([np.linspace(-4.0, 4.0, 80), np.zeros(80)], axis=1)

HEIGHTS: dict[PropMaker, tuple[float, float]] = {
    potted: (0.45, 1.7), bush: (0.5, 1.9), hedge: (0.55, 1.5), flower_bed: (0.2, 0.6),
    bench: (0.8, 1.0), bin_: (0.75, 1.0), lamp_post: (3.7, 4.7), fence: (1.0, 1.1),
}  # fmt: skip


def _vertices(prop: Prop, finish: str = "") -> np.ndarray[tuple[int, ...], np.dtype[np.float32]]:
    return np.concatenate([part.solid.vertices for part in prop.parts if finish in ("", part.finish)])


@pytest.mark.parametrize("maker", HEIGHTS, ids=lambda maker: maker.__name__)
@pytest.mark.parametrize("seed", range(6))
def test_a_plant_fills_its_box_and_stands_on_the_ground(maker: PropMaker, seed: int) -> None:
    prop = maker(np.random.default_rng(seed))
    corners = _vertices(prop)
    np.testing.assert_allclose(corners.min(axis=0), [-prop.size[0] / 2, -prop.size[1] / 2, 0.0], atol=1e-5)
    np.testing.assert_allclose(
        corners.max(axis=0), [prop.size[0] / 2, prop.size[1] / 2, prop.size[2]], atol=1e-5
    )
    low, high = HEIGHTS[maker]
    assert low <= prop.size[2] <= high
    assert sum(len(part.solid.faces) for part in prop.parts) <= 4500


def test_a_seat_is_as_high_as_a_seat() -> None:
    wood = _vertices(bench(np.random.default_rng(0)), "planks")
    seat = wood[(wood[:, 2] < 0.5) & (np.abs(wood[:, 0]) < 2.0)]
    assert seat[:, 2].max() == pytest.approx(SEAT, abs=1e-5)


def test_every_finish_of_a_plant_can_be_had() -> None:
    finishes = plant_finishes(SetBuilder(None), np.random.default_rng(0), "houseplant")
    for maker in (potted, bush, hedge):
        for seed in range(6):
            assert {part.finish for part in maker(np.random.default_rng(seed)).parts} <= set(finishes)


@pytest.mark.parametrize("seed", range(3))
def test_grass_grows_under_ten_centimetres_high_and_where_nobody_treads(seed: int) -> None:
    meshes = {mesh.name: mesh for mesh in STAGES["park"](np.random.default_rng(seed), WALK, None).meshes}
    blades = meshes["tufts"].vertices.astype(np.float64)
    assert len(blades) > 10_000
    assert -1e-6 < blades[:, 2].min() < blades[:, 2].max() < 0.1
    for start in range(0, len(blades), 4000):
        assert np.linalg.norm(blades[start : start + 4000, None, :2] - WALK, axis=2).min() > 0.4
    start, _, _, side = meshes["walkway"].vertices[:, :2].astype(np.float64)
    across = side - start
    share = (blades[:, :2] - start) @ across / (across @ across)
    assert ((share < 0.0) | (share > 1.0)).all(), "none on the gravel"
