"""COCO by pycocotools, WebDataset by webdataset, and what holds of every export."""

import json
from pathlib import Path

import numpy as np
import pytest
import typer
from hypothesis import given, settings
from hypothesis.extra.numpy import array_shapes, arrays
from typer.testing import CliRunner

from whacamole.cli.export import export
from whacamole.dataset import Dataset
from whacamole.errors import DatasetError, RecipeError
from whacamole.export import EXPORTERS, export_dataset
from whacamole.export.coco import KEYPOINT_NAMES, run_lengths

coco = pytest.importorskip("pycocotools.coco", reason="pycocotools is not installed")


@pytest.fixture(scope="module")
def annotated(data: Dataset, tmp_path_factory: pytest.TempPathFactory):
    out = tmp_path_factory.mktemp("coco") / "out"
    export_dataset(data, "coco", out)
    return coco.COCO(str(out / "coco_all.json"))


def test_coco_masks_are_those_of_the_dataset(annotated, data: Dataset) -> None:
    images = annotated.loadImgs(annotated.getImgIds())
    assert len(images) == 12
    found = 0
    for image in images:
        mask = data[image["sequence"]].mask(image["frame"])
        assert (data.layout.root / image["file_name"]).is_file()
        annotations = annotated.loadAnns(annotated.getAnnIds(imgIds=image["id"]))
        assert {entry["track_id"] for entry in annotations} == set(np.unique(mask)) - {0}
        for entry in annotations:
            decoded = annotated.annToMask(entry)
            np.testing.assert_array_equal(decoded, mask == entry["track_id"])
            rows, columns = np.nonzero(decoded)
            x, y, width, height = entry["bbox"]
            assert (x, y, x + width, y + height) == (
                columns.min(), rows.min(), columns.max() + 1, rows.max() + 1
            )  # fmt: skip
            assert entry["area"] == decoded.sum()
            found += 1
    assert found == 14


def test_coco_keypoints_are_the_joints(annotated, data: Dataset) -> None:
    names = list(data["duet-00"].people["joint_names"])
    image = annotated.loadImgs(1)[0]
    for entry in annotated.loadAnns(annotated.getAnnIds(imgIds=1)):
        people, person = data[image["sequence"]].people, entry["track_id"] - 1
        points = np.reshape(entry["keypoints"], (17, 3))
        for name, (x, y, v) in zip(KEYPOINT_NAMES, points, strict=True):
            if name not in names:
                assert name in ("nose", "left_ear", "right_ear")
                assert (x, y, v) == (0, 0, 0)
                continue
            joint = names.index(name)
            assert v == people["joint_visibility"][person, 0, joint]
            if v:
                np.testing.assert_allclose([x, y], people["joints_image"][person, 0, joint], atol=1e-3)
        assert entry["num_keypoints"] == (points[:, 2] > 0).sum()


@pytest.mark.parametrize("kind", ["segm", "bbox", "keypoints"])
def test_coco_scores_its_own_truth_as_perfect(annotated, kind: str, capsys: pytest.CaptureFixture) -> None:
    from pycocotools.cocoeval import COCOeval

    results = [{**entry, "score": 1.0} for entry in annotated.dataset["annotations"]]
    if kind == "keypoints":
        for entry in results:
            entry.pop("bbox")
            entry.pop("segmentation")
    else:
        for entry in results:
            entry.pop("keypoints")
            entry.pop("bbox" if kind == "segm" else "segmentation")
            if kind == "segm":
                entry["segmentation"] = annotated.annToRLE(entry)
    scores = COCOeval(annotated, annotated.loadRes(results), kind)
    scores.evaluate()
    scores.accumulate()
    scores.summarize()
    capsys.readouterr()
    assert scores.stats[0] == pytest.approx(1.0)


@settings(derandomize=True, max_examples=60, deadline=None)
@given(arrays(bool, array_shapes(min_dims=2, max_dims=2, max_side=9)))
def test_run_lengths_give_the_mask_back(mask: np.ndarray) -> None:
    from pycocotools import mask as peer

    counts = run_lengths(mask)
    encoded = peer.frPyObjects({"size": list(mask.shape), "counts": counts}, *mask.shape)
    np.testing.assert_array_equal(peer.decode(encoded).astype(bool), mask)
    assert all(count > 0 for count in counts[1:])


# The package leaves its files to the garbage collector.
@pytest.mark.filterwarnings("ignore:unclosed file:ResourceWarning")
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_webdataset_is_read_by_webdataset(data: Dataset, tmp_path: Path) -> None:
    webdataset = pytest.importorskip("webdataset", reason="webdataset is not installed")
    export_dataset(data, "webdataset", tmp_path / "out")
    shards = sorted(map(str, (tmp_path / "out").iterdir()))
    assert [Path(shard).name for shard in shards] == ["all-000000.tar"]
    samples = list(webdataset.WebDataset(shards, shardshuffle=False, empty_check=False).decode("rgb8"))
    assert [sample["__key__"] for sample in samples] == [
        f"{sequence.id}/{frame:06d}" for sequence in data for frame in range(4)
    ]
    sample, duet = samples[2], data["duet-00"]
    np.testing.assert_array_equal(sample["png"], duet.rgb(2))
    assert sample["json"]["sequence"] == "duet-00"
    assert sample["json"]["frame"] == 2
    np.testing.assert_array_equal(sample["camera.npz"]["K"], duet.camera["K"][2:3])
    people, contact = sample["people.npz"], sample["contact.npz"]
    np.testing.assert_array_equal(people["joints_world"], duet.people["joints_world"][:, 2:3])
    np.testing.assert_array_equal(people["betas"], duet.people["betas"])
    np.testing.assert_array_equal(contact["person_contact"], duet.contact["person_contact"][:, :, 2:3])
    assert sample["depth.exr"] == (duet.layout.folder / "depth" / "000002.exr").read_bytes()


# --- What holds of every export ----------------------------------------------------------------------------


@pytest.mark.parametrize("name", EXPORTERS)
def test_an_export_is_complete_or_absent(
    name: str, data: Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(source, folder):
        (folder / "half").write_text("half")
        raise DatasetError("people.npz: not readable; render it again")

    module, function = EXPORTERS[name].place
    monkeypatch.setattr(f"whacamole.export.{module}.{function}", broken)
    with pytest.raises(DatasetError):
        export_dataset(data, name, tmp_path / "out")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["bedlam", "coco", "webdataset", "tum"])
def test_the_same_dataset_gives_the_same_bytes(name: str, data: Dataset, tmp_path: Path) -> None:
    first, second = (export_dataset(data, name, tmp_path / folder) for folder in ("a", "b"))
    assert first.files == second.files
    for file in first.files:
        assert (first.folder / file).read_bytes() == (second.folder / file).read_bytes()


def test_what_cannot_be_exported_is_refused_before_it_begins(data: Dataset, tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    (tmp_path / "file").write_bytes(b"")
    for message, error, options in (
        ("no such format; choose from humandata", RecipeError, {"to": "fbx", "out": tmp_path / "a"}),
        ("whole sequences", RecipeError, {"to": "mp4", "out": tmp_path / "a", "every": 2}),
        ("already there", DatasetError, {"to": "tum", "out": tmp_path / "there"}),
        ("cannot be made", DatasetError, {"to": "tum", "out": tmp_path / "file" / "out"}),
        ("no split 'val'", DatasetError, {"to": "tum", "out": tmp_path / "a", "split": "val"}),
    ):
        with pytest.raises(error, match=message):
            export_dataset(data, **options)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", "there"]


def test_one_split_only(data: Dataset, tmp_path: Path) -> None:
    sides = {side: list(data.split(side).ids) for side in ("train", "test")}
    for side, ids in sides.items():
        if ids:
            result = export_dataset(data, "tum", tmp_path / side, split=side)
            assert list(result.files) == [f"{name}.txt" for name in ids]
        else:
            with pytest.raises(DatasetError, match="holds no sequence"):
                export_dataset(data, "tum", tmp_path / side, split=side)


def test_every_format_is_documented() -> None:
    text = (Path(__file__).parents[3] / "docs" / "export.md").read_text()
    for name in EXPORTERS:
        assert f"\n## {name}\n" in text


def test_the_command_says_what_it_wrote(data: Dataset, tmp_path: Path) -> None:
    app = typer.Typer()
    app.command()(export)
    arguments = [str(data.layout.root), "--to", "tum", "--out", str(tmp_path / "out"), "--json"]
    run = CliRunner().invoke(app, arguments)
    assert run.exit_code == 0
    assert json.loads(run.stdout)["files"] == ["duet-00.txt", "walk-00.txt", "walk-01.txt"]
