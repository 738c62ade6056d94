"""The labels of both engines against rays cast at the job's own triangles, pixel by pixel."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import OpenEXR
import pytest
from numpy.typing import NDArray
from PIL import Image

from render_jobs import PASSES, Environment, Lamp, Material, Mesh, Quality, RenderJob, Sun, run_job
from render_truth import (
    BOX,
    BOX_FACES,
    SQUARE,
    SQUARE_FACES,
    camera,
    expected_frame,
    moving,
    read_picture,
    rendered_frame,
)

ALL = tuple(PASSES)
FAST = Quality(name="test", samples=2, denoise="off")
FRAMES = 3

ENGINES = [
    pytest.param("cycles", marks=pytest.mark.blender),
    pytest.param("raster", marks=pytest.mark.gl),
]

Rendered = tuple[Path, RenderJob]


def render(job: RenderJob, folder: Path, engine: str) -> Path:
    job.save(folder)
    run_job(folder, engine=engine, device="cpu", threads=2, timeout=300)
    return folder


def ground(half: float = 6.0) -> Mesh:
    return Mesh("ground", SQUARE * half, SQUARE_FACES, Material(base_color=(0.4, 0.4, 0.4)))


def upright(half: float, at: Sequence[float]) -> NDArray[np.float64]:
    """The corners of a square of this half width that faces −y."""
    return np.array([[-half, 0, -half], [half, 0, -half], [half, 0, half], [-half, 0, half]]) + np.asarray(at)


@pytest.fixture(scope="module", params=ENGINES)
def everything_moves(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Rendered:
    """A moving box; a camera that travels, turns, zooms and shifts its lens; oblong pixels; neighbours."""
    time = np.arange(-1, FRAMES + 1)[:, None]
    whole = camera(
        eye=[0.1, -4.0, 1.6] + time * [0.12, 0.05, -0.02],
        target=[0.0, 0.0, 0.8] + time * [0.02, 0.0, 0.03],
        focal=np.array([90.0, 108.0]) + time * [2.0, 2.4],
        centre=np.array([40.0, 25.0]) + time * [1.5, -2.0],
    )
    part = [
        type(whole)(whole.K[rows], whole.T_world_camera[rows], whole.fps, whole.width, whole.height)
        for rows in (slice(1, -1), [0, -1])
    ]
    box = Mesh("box", moving(BOX, [0.05, 0.02, 0.03], FRAMES), BOX_FACES, smooth=False, track_id=7)
    job = RenderJob(
        camera=part[0], camera_neighbours=part[1], meshes=(box, ground()), passes=ALL, quality=FAST,
        lights=(Sun(), Lamp(position=(2.0, -2.0, 3.0))), environment=Environment(kind="sky"),
    )  # fmt: skip
    return render(job, tmp_path_factory.mktemp("moves") / "job", request.param), job


@pytest.fixture(scope="module", params=ENGINES)
def still_camera(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Rendered:
    """A level camera that looks along +y; before it a square that moves to the right and one that rises."""
    sideways = Mesh(
        "sideways", moving(upright(0.4, [-0.6, 0.0, 1.0]), [0.1, 0, 0], FRAMES), SQUARE_FACES, track_id=300
    )
    rising = Mesh(
        "rising", moving(upright(0.4, [0.6, 1.0, 1.0]), [0, 0, 0.1], FRAMES), SQUARE_FACES, track_id=32767
    )
    path = camera([[0.0, -4.0, 1.0]] * FRAMES, [0.0, 0.0, 1.0], [100.0] * FRAMES, [[48.0, 32.0]] * FRAMES)
    job = RenderJob(path, (sideways, rising), passes=ALL, image_format="png", quality=FAST)
    return render(job, tmp_path_factory.mktemp("still") / "job", request.param), job


@pytest.mark.parametrize("frame", range(FRAMES))
def test_every_pixel_of_a_scene_in_which_all_moves(everything_moves: Rendered, frame: int) -> None:
    folder, job = everything_moves
    found, expected = rendered_frame(folder, frame), expected_frame(job, frame)
    assert (found.mask == expected.mask).mean() > 0.999  # a ray may graze an edge
    same = (found.mask == expected.mask) & (np.isfinite(found.depth) == np.isfinite(expected.depth))
    hit = same & np.isfinite(expected.depth)
    assert {0, 7} == set(np.unique(found.mask[hit])), "box and ground are both in view"
    assert 500 < (~hit).sum() < 5000, "sky is in view"
    np.testing.assert_allclose(found.depth[hit], expected.depth[hit], atol=1e-3)
    np.testing.assert_allclose(found.normal[hit], expected.normal[hit], atol=1e-3)
    np.testing.assert_allclose(found.flow[same], expected.flow[same], atol=0.01)
    assert (found.normal[~hit] == 0.0).all()
    assert np.isposinf(found.depth[same & ~hit]).all()


def test_a_motion_to_the_right_and_one_upwards(still_camera: Rendered) -> None:
    folder, _ = still_camera
    for index in range(FRAMES):
        found = rendered_frame(folder, index)
        right, up = found.mask == 300, found.mask == 32767
        assert right.sum() > 200
        assert up.sum() > 200
        # 0.1 m a frame at f = 100 px and 4 m or 5 m: 2.5 px to the right, 2 px up, which is −y
        np.testing.assert_allclose(
            found.flow[right], np.broadcast_to([2.5, 0.0], (right.sum(), 2)), atol=0.01
        )
        np.testing.assert_allclose(found.flow[up], np.broadcast_to([0.0, -2.0], (up.sum(), 2)), atol=0.01)
        np.testing.assert_allclose(found.depth[right], 4.0, atol=1e-4)
        np.testing.assert_allclose(found.depth[up], 5.0, atol=1e-4)
        # a wall that faces the camera has its normal against the viewing direction
        np.testing.assert_allclose(
            found.normal[right], np.broadcast_to([0, 0, -1.0], (right.sum(), 3)), atol=1e-4
        )
        assert (found.flow[found.mask == 0] == 0.0).all()


def test_the_cache_is_played_without_a_shift_in_time(still_camera: Rendered) -> None:
    folder, _ = still_camera
    for index in range(FRAMES):
        columns = np.flatnonzero((rendered_frame(folder, index).mask == 300).any(axis=0))
        # the square spans x = −1.0 … −0.2 m at frame 0, at 25 px/m around column 48
        assert columns[0] == pytest.approx(48 + 25 * (-1.0 + 0.1 * index), abs=1)
        assert columns[-1] + 1 == pytest.approx(48 + 25 * (-0.2 + 0.1 * index), abs=1)


def test_files_are_what_the_list_of_passes_says(still_camera: Rendered) -> None:
    folder, job = still_camera
    out = folder / "out"
    assert sorted(path.name for path in out.iterdir() if not path.name.startswith(".")) == sorted(ALL)
    for entry in PASSES.values():
        files = sorted((out / entry.name).iterdir())
        assert files == [out / entry.file(index, "png") for index in range(FRAMES)]
    with Image.open(out / "rgb" / "000000.png") as picture, Image.open(out / "mask" / "000000.png") as mask:
        assert picture.size == mask.size == (job.camera.width, job.camera.height)
        assert (picture.mode, mask.mode) == ("RGB", "I;16")
    for name in ("depth", "normal", "flow"):
        with OpenEXR.File(str(out / name / "000000.exr"), separate_channels=True) as file:
            assert len(file.parts) == 1
            assert sorted(file.channels()) == sorted(PASSES[name].channels)
            assert file.header()["compression"] == OpenEXR.ZIP_COMPRESSION
            assert file.header()["description"] == PASSES[name].description
            assert file.header()["unit"] == PASSES[name].unit


@pytest.mark.parametrize("engine", ENGINES)
def test_cut_alpha_placements_sides_and_mixed_faces(tmp_path: Path, engine: str) -> None:
    """The labels follow what is seen: cut-out cards, every placement, no back of a one-sided surface."""
    texture = np.full((64, 64, 4), 255, np.uint8)
    texture[:, 32:, 3] = 0  # the right half of the card is cut away
    Image.fromarray(texture).save(tmp_path / "card.png")
    uv = np.array([[[0, 0], [1, 0], [1, 1], [0, 1]]], float)
    cut = Material(base_color_texture=tmp_path / "card.png", alpha_mode="clip")
    one_sided = Material(double_sided=False)
    halves = np.array([[0, 1, 2, -1], [0, 2, 3, -1]])
    placements = np.stack([np.eye(4)] * 2)
    placements[:, :3, 3] = [[-0.6, 0.0, 1.7], [0.6, 0.0, 1.7]]
    job = RenderJob(
        camera([[0.0, -4.0, 1.0]], [0.0, 0.0, 1.0], [100.0], [[48.0, 32.0]]),
        (
            Mesh("card", upright(0.5, [0.0, 0.0, 0.7]), SQUARE_FACES, cut, uv=uv, track_id=1),
            Mesh("many", upright(0.4, [0.0, 0.0, 0.0]), halves, placements=placements, track_id=2),
            Mesh("away", upright(0.5, [0.0, -1.0, 0.7]), SQUARE_FACES[:, ::-1], one_sided, track_id=3),
            Mesh("back", upright(4.5, [0.0, 3.0, 1.0]), SQUARE_FACES, track_id=4),
        ),
        passes=("mask", "depth"),
        quality=FAST,
    )  # fmt: skip
    folder = render(job, tmp_path / "job", engine)
    mask = read_picture(folder / "out" / "mask" / "000000.png")
    assert set(np.unique(mask)) == {1, 2, 4}, "the one-sided square shows its back and is not seen"
    assert (mask == 1).sum() == pytest.approx(25 * 12.5, abs=20), "half the card"
    assert np.flatnonzero((mask == 1).any(axis=0)).max() < 48
    assert (mask == 2).sum() == pytest.approx(2 * 20 * 20, abs=40)
    with OpenEXR.File(str(folder / "out" / "depth" / "000000.exr"), separate_channels=True) as file:
        depth = file.channels()["Z"].pixels
    np.testing.assert_allclose(depth[mask == 1], 4.0, atol=1e-4)
    np.testing.assert_allclose(depth[mask == 4], 7.0, atol=1e-4)
    assert not (folder / "out" / "rgb").exists(), "a pass that was not asked for"
