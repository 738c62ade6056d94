"""Reading: what was written comes back, and what is not there is named."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import whacamole
from whacamole.dataset import Dataset, DatasetLayout, write_index, write_summary
from whacamole.dataset.files import write_arrays
from whacamole.errors import DatasetError

FRAMES = 7


@pytest.fixture
def data(tmp_path: Path) -> Dataset:
    layout = DatasetLayout(tmp_path)
    for number, name in enumerate(("run", "walk")):
        sequence = layout.sequence(f"{name}-00")
        (sequence.folder / "rgb").mkdir(parents=True)
        for frame in range(FRAMES):
            image = np.full((4, 6, 3), 10 * number + frame, np.uint8)
            Image.fromarray(image).save(sequence.folder / "rgb" / f"{frame:06d}.png")
        write_arrays(sequence.camera, {"K": np.eye(3)[None] * (number + 1)})
        facts = {
            "motion_id": name,
            "frames": FRAMES,
            "width": 6,
            "height": 4,
            "passes": ["rgb"],
            "image_format": "png",
        }
        write_summary(sequence, facts)
    write_index(layout, {"seed": 1})
    layout.splits.mkdir()
    (layout.splits / "train.txt").write_text("run-00\nwalk-00\n", encoding="utf-8")
    (layout.splits / "test.txt").write_text("", encoding="utf-8")
    return whacamole.open(tmp_path)


def test_sequences_come_by_name_by_number_and_in_order(data: Dataset) -> None:
    assert [sequence.id for sequence in data] == ["run-00", "walk-00"]
    assert data[1].id == data["walk-00"].id
    assert "walk-00" in data
    assert len(data) == 2


def test_frames_and_arrays_are_those_written(data: Dataset) -> None:
    walk = data["walk-00"]
    assert (walk.rgb(3) == 13).all()
    np.testing.assert_array_equal(walk.camera["K"][0], 2 * np.eye(3))
    assert (len(walk), walk.size) == (FRAMES, (6, 4))


@pytest.mark.parametrize(
    ("length", "stride", "starts"),
    [(3, None, [0, 3]), (3, 2, [0, 2, 4]), (7, None, [0]), (8, None, []), (1, 3, [0, 3, 6])],
)
def test_clips_are_whole_and_in_place(
    data: Dataset, length: int, stride: int | None, starts: list[int]
) -> None:
    clips = list(data[0].clips(length, stride))
    assert [clip.start for clip in clips] == starts
    assert all(len(clip) == length and clip[-1] < FRAMES for clip in clips)


def test_splits_are_datasets(data: Dataset) -> None:
    assert [sequence.id for sequence in data.split("train")] == ["run-00", "walk-00"]
    assert len(data.split("test")) == 0


def test_what_is_not_there_is_named(data: Dataset, tmp_path: Path) -> None:
    with pytest.raises(DatasetError, match="jump-00"):
        data["jump-00"]
    with pytest.raises(DatasetError, match="depth was not rendered"):
        data[0].depth(0)
    with pytest.raises(IndexError):
        data[0].rgb(FRAMES)
    with pytest.raises(DatasetError, match="validation"):
        data.split("validation")
    with pytest.raises(DatasetError, match=r"dataset\.json"):
        whacamole.open(tmp_path / "nowhere")
    (data[0].layout.folder / "rgb" / "000001.png").write_bytes(b"half an ima")
    with pytest.raises(DatasetError, match=r"000001\.png"):
        data[0].rgb(1)
    data[0].layout.camera.write_bytes(b"PK\x03\x04")
    with pytest.raises(DatasetError, match=r"camera\.npz"):
        data[0].camera  # noqa: B018


@pytest.mark.parametrize("content", ["", '{"sequences": [', "[]", '{"seed": 1}', '{"sequences": [3]}'])
def test_a_broken_index_is_named_when_the_dataset_is_opened(
    data: Dataset, tmp_path: Path, content: str
) -> None:
    data.layout.index.write_text(content, encoding="utf-8")
    with pytest.raises(DatasetError, match=r"dataset\.json: not .*"):
        whacamole.open(tmp_path)


def test_a_listed_sequence_without_its_summary_is_named(whole: Dataset, tmp_path: Path) -> None:
    root = tmp_path / "copy"
    shutil.copytree(whole.layout.root, root)
    whacamole.open(root).require_whole()
    gone = DatasetLayout(root).sequence(whole.ids[0]).summary
    gone.unlink()
    lacking = whacamole.open(root)
    with pytest.raises(DatasetError, match=rf"{whole.ids[0]}/sequence\.json: not there.*whacamole render"):
        lacking.require_whole()


def test_a_dataset_that_still_renders_is_called_unfinished(data: Dataset, tmp_path: Path) -> None:
    data.layout.index.unlink()
    with pytest.raises(DatasetError, match=r"unfinished.*whacamole status"):
        whacamole.open(tmp_path)
    with pytest.raises(DatasetError, match=r"is this a folder made by"):
        whacamole.open(tmp_path / "splits")
