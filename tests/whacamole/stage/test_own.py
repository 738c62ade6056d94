"""Stages of the user's own: where one can walk, what is in the way, and what becomes of bad files."""

from pathlib import Path

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from render_jobs import RenderJobError, Sun
from render_jobs.maps import read_map
from scene_files import write_glb, write_room
from whacamole.errors import RecipeError, TakeError
from whacamole.stage import STAGES, find_places
from whacamole.stage.light import DAY, lit_by, read_hdri
from whacamole.stage.own import load_stage
from whacamole.stage.survey import survey_ground, survey_solids
from whacamole.take.crowd import Footprint
from whacamole.take.location import choose_location, free_spot

Triangles = NDArray[np.float64]


def _box(size: tuple[float, float, float], place: tuple[float, float, float]) -> Triangles:
    return np.asarray(trimesh.creation.box(size, trimesh.transformations.translation_matrix(place)).triangles)


ROOM = np.concatenate(
    [
        _box((8.0, 6.0, 0.2), (0.0, 0.0, -0.1)),
        _box((0.2, 6.0, 3.0), (4.0, 0.0, 1.5)),
        _box((0.2, 6.0, 3.0), (-4.0, 0.0, 1.5)),
        _box((8.0, 0.2, 3.0), (0.0, 3.0, 1.5)),
        _box((8.0, 0.2, 3.0), (0.0, -3.0, 1.5)),
        _box((8.0, 6.0, 0.2), (0.0, 0.0, 3.1)),
        _box((1.0, 1.0, 0.75), (2.0, 1.0, 0.375)),
        _box((1.0, 1.0, 0.5), (-2.0, 1.0, 2.5)),  # hangs above the heads
    ]
)
"""A room of 8 × 6 m with a table and something under the ceiling."""


def test_one_walks_where_the_floor_is_free_and_nothing_stands() -> None:
    ground = survey_ground(ROOM, ROOM)
    places = np.array([[0, 0], [2, 1], [-2, 1], [3.95, 0], [5, 0], [0, 2.0], [2.0, 0.0]])
    room = ground.room(places)
    assert (room[[1, 3, 4]] == 0).all(), "in the table, in the wall, outside"
    np.testing.assert_allclose(room[[0, 2, 5, 6]], [np.hypot(1.5, 0.5), 1.9, 0.9, 0.5], atol=0.16)
    assert ground.area == pytest.approx(7.8 * 5.8 - 1.0, rel=0.08)


def test_solids_are_walls_furniture_and_all_that_nobody_gets_into() -> None:
    solids = survey_solids(ROOM, survey_ground(ROOM, ROOM))
    boxes = solids.boxes(np.array([-15.0, -15.0]), np.array([15.0, 15.0]))
    assert 5 <= len(boxes) <= 250

    def inside(point: tuple[float, float, float]) -> bool:
        return min(float(box.distance(point)) for box in boxes) < 0.0

    for point in (
        (2.0, 1.0, 0.4),
        (4.0, 0.0, 1.0),
        (0.0, 3.0, 2.0),
        (-2.0, 1.0, 2.5),
        (9.0, 0.0, 1.0),
        (0, 0, 3.2),
    ):
        assert inside(point), f"{point} is solid, or out of the room"
    for point in ((0.0, 0.0, 1.0), (2.0, 1.0, 1.5), (-2.0, 1.0, 1.5), (-3.5, -2.5, 2.5)):
        assert not inside(point), f"{point} is air"


def test_a_hollow_box_is_no_place_to_walk() -> None:
    crate = _box((3.0, 3.0, 1.0), (0.0, 0.0, 0.5))[:12]
    floor = _box((10.0, 10.0, 0.2), (0.0, 0.0, -0.1))
    ground = survey_ground(floor, np.concatenate([floor, crate]))
    assert ground.room(np.array([0.0, 0.0])) == 0.0
    assert ground.room(np.array([3.5, 0.0])) > 1.0


def _walk(length: float, radius: float = 0.4) -> Footprint:
    time = np.linspace(-0.5, 0.5, 90)
    return Footprint(np.stack([length * time, 0.0 * time], axis=1), np.full(90, radius))


def test_a_walk_is_put_where_it_meets_nothing_in_any_frame() -> None:
    ground = survey_ground(ROOM, ROOM)
    walk = _walk(4.5)
    for seed in range(8):
        spot = free_spot(ground, [walk], np.random.default_rng(seed))
        assert spot is not None
        moved = walk.moved(spot)
        # Exact distances to the table and the walls, not those of the grid.
        gap = np.abs(moved.center - [2.0, 1.0]) - 0.5
        table = np.hypot(*np.maximum(gap, 0.0).T)
        walls = np.minimum(3.9 - np.abs(moved.center[:, 0]), 2.9 - np.abs(moved.center[:, 1]))
        assert table.min() > 0.4
        assert walls.min() > 0.4
    assert free_spot(ground, [_walk(9.0)], np.random.default_rng(0)) is None


def test_a_stage_without_room_is_passed_over(tmp_path: Path) -> None:
    small, large = write_glb(tmp_path / "small.glb", floor=2.0), write_glb(tmp_path / "large.glb", floor=30.0)
    places = find_places((str(tmp_path),), None, tmp_path / "cache", tuple(STAGES))
    assert places.files == (large, small)
    for seed in range(4):
        location = choose_location(np.random.default_rng(seed), places, [_walk(8.0)])
        assert location.build(np.zeros((1, 2)), None).name == "large"
    with pytest.raises(TakeError, match=r"needs 50\.8 × 0\.8 m of free floor, which no stage has"):
        choose_location(np.random.default_rng(0), places, [_walk(50.0)])


@pytest.mark.blender
def test_a_floor_by_name_is_brought_to_zero_height(tmp_path: Path) -> None:
    stage = load_stage(write_room(tmp_path / "room.blend", height=1.5), tmp_path / "cache")
    again = load_stage(tmp_path / "room.blend", tmp_path / "cache")
    np.testing.assert_array_equal(stage.ground.clearance, again.ground.clearance)
    assert stage.ground.room(np.array([0.0, 0.0])) > 0.5
    assert stage.ground.room(np.array([3.0, 1.0])) == 0.0, "the table"
    (lamp,) = stage.lights
    assert not isinstance(lamp, Sun)
    assert lamp.position[2] == pytest.approx(2.5, abs=1e-5)
    built = stage.stage(np.random.default_rng(0), np.zeros((5, 2)), ())
    assert built.lights == stage.lights, "it brings its own light"
    assert float(built.world.obstacle_distance(np.array([3.0, 1.0, 0.4]))) < 0.0


def test_bad_files_are_told_and_the_others_go_on(tmp_path: Path) -> None:
    write_glb(tmp_path / "good.glb", floor=20.0)
    (tmp_path / "bad.glb").write_bytes(b"no glb")
    scene = trimesh.Scene({"wall": trimesh.creation.box((4.0, 4.0, 0.1))})
    scene.export(tmp_path / "nofloor.glb")
    for _ in range(2):  # the second time from what is kept
        places = find_places((str(tmp_path), "plaza"), None, tmp_path / "cache", tuple(STAGES))
        assert places.names == ("plaza",)
        assert [file.name for file in places.files] == ["good.glb"]
        bad, floorless = places.problems
        assert bad.startswith(f"{tmp_path / 'bad.glb'}: is damaged")
        assert floorless == (
            f"{tmp_path / 'nofloor.glb'}: no floor to walk on; name an object or its collection `floor`, "
            "or put the floor at z = 0"
        )
    with pytest.raises(RecipeError, match="none can be used"):
        find_places((str(tmp_path / "bad.glb"),), None, tmp_path / "cache", tuple(STAGES))


def _write_hdr(path: Path, image: NDArray[np.float64]) -> Path:
    """A Radiance file of runs and literals, written by the book (Ward 1991)."""
    mantissa, exponent = np.frexp(image.max(axis=-1))
    scale = np.where(image.max(axis=-1) > 0, mantissa * 256.0 / np.maximum(image.max(axis=-1), 1e-32), 0.0)
    rgbe = np.concatenate([image * scale[..., None], (exponent + 128.0)[..., None]], axis=-1).astype(np.uint8)
    height, width = image.shape[:2]
    lines = b""
    for row in rgbe:
        lines += bytes([2, 2, width >> 8, width & 255])
        for channel in row.T:
            if (channel == channel[0]).all() and width <= 127:
                lines += bytes([128 + width, channel[0]])
            else:
                for start in range(0, width, 128):
                    part = channel[start : start + 128]
                    lines += bytes([len(part)]) + part.tobytes()
    path.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" + f"-Y {height} +X {width}\n".encode() + lines)
    return path


def test_a_map_is_read_and_made_as_bright_as_a_day(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    image = rng.uniform(0.0, 9.0, (32, 64, 3))
    image[4] = 5.0
    back = read_map(_write_hdr(tmp_path / "sky.hdr", image))
    assert np.abs(back - image).max() < image.max() / 128
    uniform = read_hdri(_write_hdr(tmp_path / "white.hdr", np.full((32, 64, 3), 3.0)))
    assert uniform.irradiance == pytest.approx(3.0 * np.pi, rel=0.02), "E = π L"
    stage = STAGES["plaza"](np.random.default_rng(0), np.zeros((4, 2)), None)
    lit = lit_by(stage, (uniform,), np.random.default_rng(0))
    assert lit.lights == ()
    assert lit.environment.hdri == tmp_path / "white.hdr"
    assert lit.environment.strength * uniform.irradiance == pytest.approx(DAY)
    night = STAGES["night-street"](np.random.default_rng(0), np.zeros((4, 2)), None)
    assert lit_by(night, (uniform,), np.random.default_rng(0)) is night


@pytest.mark.parametrize(
    "content", [b"", b"#?RADIANCE\n\n-Y 32 +X 64\n\x02\x02\x00\x40\xff", b"\x76\x2f\x31\x01junk"]
)
@pytest.mark.parametrize("suffix", [".hdr", ".exr"])
def test_a_broken_map_is_one_line(tmp_path: Path, content: bytes, suffix: str) -> None:
    path = tmp_path / f"sky{suffix}"
    path.write_bytes(content)
    with pytest.raises(RenderJobError, match=str(path)) as caught:
        read_hdri(path)
    assert "\n" not in str(caught.value)
    with pytest.raises(RecipeError, match="holds no usable"):
        find_places((), tmp_path, tmp_path / "cache", tuple(STAGES))
