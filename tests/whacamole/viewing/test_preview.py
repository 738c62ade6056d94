"""Colours mean what their legends say, drawings fall where the labels are, files open."""

from pathlib import Path

import av
import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

import tiny_dataset
from whacamole.cli import app
from whacamole.dataset import Dataset
from whacamole.errors import DatasetError
from whacamole.labels.shading import track_colour
from whacamole.viewing.above import FINE, FromAbove
from whacamole.viewing.aside import _hang
from whacamole.viewing.bodies import model_for
from whacamole.viewing.colouring import DepthScale, colour_depth, colour_flow, colour_normal, depth_legend
from whacamole.viewing.panels import Panels, layers_named
from whacamole.viewing.preview import Wanted, make_previews
from whacamole.viewing.viewpoint import Viewpoint


def test_depth_darkens_with_distance_and_nothing_is_grey() -> None:
    depth = np.array([[1.0, 2.0, 3.0, 9.0, np.inf]], dtype=np.float32)
    coloured = colour_depth(depth, DepthScale(1.0, 3.0)).astype(int)[0]
    brightness = coloured.sum(axis=1)
    assert brightness[0] > brightness[1] > brightness[2]
    assert (coloured[3] == coloured[2]).all()  # beyond the scale
    assert np.ptp(coloured[4]) < 10


def test_the_bar_shows_the_colours_of_the_depths_beside_it() -> None:
    scale = DepthScale(2.0, 6.0)
    bar = np.asarray(depth_legend(scale, 240))
    rows = np.linspace(2.0, 6.0, 240 // 2 - 12, dtype=np.float32)
    np.testing.assert_array_equal(bar[6 : 6 + len(rows), 8], colour_depth(rows[:, None], scale)[:, 0])


def test_flow_is_white_where_still_and_opposite_ways_are_opposite_colours() -> None:
    flow = np.array([[[0, 0], [5, 0], [-5, 0], [0, 5], [50, 0]]], dtype=np.float32)
    still, right, left, down, far = colour_flow(flow, 5.0)[0].astype(int)
    assert (still == 255).all()
    assert (np.abs(right + left - 255) <= 1).all()
    assert np.abs(down - right).max() > 60
    assert (far == right).all()


def test_a_normal_towards_the_camera_is_blue() -> None:
    towards, up = colour_normal(np.array([[[0, 0, -1], [0, -1, 0]]], dtype=np.float32))[0]
    assert towards.argmax() == 2
    assert up.argmax() == 1


def test_from_above_people_are_where_they_stand(dataset: Dataset) -> None:
    sequence = dataset["duet-00"]
    drawn = FromAbove(sequence, 400, 300)
    picture = drawn.frame(1).astype(int)
    for number in range(2):
        place = sequence.people["joints_world"][number, 1, :1]
        ((x, y),) = drawn._paper.at(place)
        around = picture[int(y / FINE) - 5 : int(y / FINE) + 6, int(x / FINE) - 5 : int(x / FINE) + 6]
        far = np.abs(around - track_colour(number + 1)).sum(axis=-1)
        assert (far < 40).mean() > 0.3


def test_contacts_are_drawn_on_the_feet(dataset: Dataset) -> None:
    sequence = dataset["duet-00"]
    model = model_for(sequence, None)
    plain = Panels(sequence, model, ("ids",), 388)
    dotted = Panels(sequence, model, ("ids", "contacts"), 388)
    changed = np.any(
        np.asarray(plain.picture("labels", 1)) != np.asarray(dotted.picture("labels", 1)), axis=-1
    )
    touching = sequence.contact["vertex_contact"][:, 1].any()
    assert changed.any() == touching
    if touching:
        scale = dotted.cell[0] / tiny_dataset.WIDTH
        feet = sequence.people["joints_image"][:, 1, [7, 8, 10, 11]].reshape(-1, 2) * scale
        rows, columns = np.nonzero(changed)
        far = np.linalg.norm(np.stack([columns, rows], axis=1)[:, None] - feet, axis=-1).min(axis=1)
        assert np.median(far) < 12 * scale


def test_the_command_writes_video_and_sheet(dataset: Dataset, tmp_path: Path) -> None:
    arguments = ["preview", str(dataset.layout.root), "walk-00", "--out", str(tmp_path), "--width", "96",
                 "--layers", "rgb,mesh,joints,boxes,ids,contacts,mask,depth,map"]  # fmt: skip
    done = CliRunner().invoke(app, arguments, catch_exceptions=False)
    assert done.exit_code == 0, done.output
    with av.open(str(tmp_path / "walk-00.mp4")) as container:
        stream = container.streams.video[0]
        assert float(stream.average_rate) == tiny_dataset.FPS
        frames = list(container.decode(stream))
    assert len(frames) == tiny_dataset.FRAMES
    assert frames[0].width > 3 * 96
    with Image.open(tmp_path / "walk-00.jpg") as sheet:
        assert sheet.width > tiny_dataset.FRAMES * 320


def test_one_that_fails_does_not_stop_the_others(dataset: Dataset, tmp_path: Path) -> None:
    frame = dataset["duet-00"].layout.folder / "rgb" / "000001.png"
    kept = frame.read_bytes()
    frame.write_bytes(b"no picture")
    try:
        wanted = Wanted("rgb", sheet=False, width=64, out=tmp_path)
        made = make_previews(dataset.layout.root, [], wanted, quiet=True)
    finally:
        frame.write_bytes(kept)
    assert list(made.failed) == ["duet-00"]
    assert str(frame) in made.failed["duet-00"]
    assert [path.name for path in made.files] == ["walk-00.mp4", "walk-01.mp4"]
    assert not list(tmp_path.glob(".*"))


@pytest.mark.parametrize(
    ("layers", "message"), [("rgb,deep", "none of rgb"), ("flow", "--passes"), ("", "empty")]
)
def test_wrong_layers_are_one_line(dataset: Dataset, layers: str, message: str) -> None:
    with pytest.raises(DatasetError, match=message):
        layers_named(layers, dataset["walk-00"])


def test_from_aside_everything_is_in_the_picture(dataset: Dataset) -> None:
    for sequence in dataset:
        eyes = sequence.camera["T_world_camera"][:, :3, 3]
        people = sequence.people["joints_world"][:, :, 0].reshape(-1, 3)
        K, T = Viewpoint.of(eyes, people).camera(640, 360)
        local = np.concatenate([eyes, people, people * [1, 1, 0]]) @ T[:3, :3].T + T[:3, 3]
        assert (local[:, 2] > 0.5).all()
        pixel = (local @ K.T)[:, :2] / local[:, 2:]
        assert ((pixel > 0) & (pixel < [640, 360])).all()
        assert np.ptp(pixel, axis=0).max() > 200  # and fills it
        np.testing.assert_allclose(T[:3, :3] @ T[:3, :3].T, np.eye(3), atol=1e-12)
        assert T[:3, :3][0, 2] == pytest.approx(0.0)  # level


def test_the_frame_hangs_in_its_corners() -> None:
    picture = Image.new("RGB", (40, 20), (255, 0, 0))
    picture.paste((0, 0, 255), (20, 0, 40, 20))
    canvas = Image.new("RGB", (200, 100), (255, 255, 255))
    _hang(canvas, picture, [(50, 20), (150, 30), (150, 80), (50, 70)])
    drawn = np.asarray(canvas).astype(int)
    assert drawn[45, 60].tolist() == [255, 0, 0]
    assert drawn[60, 140].tolist() == [0, 0, 255]
    assert drawn[10, 100].tolist() == [255, 255, 255]
