"""The documentation is true: its code runs, its tables list what is written, its names are the code's."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest
from numpy.typing import NDArray
from PIL import Image

from camera_rigs import CameraPath
from render_jobs import PASSES
from whacamole.body import BodyModel, BodyParams
from whacamole.body.joints import JOINT_NAMES
from whacamole.dataset import DatasetLayout, write_index, write_summary
from whacamole.dataset.splitting import refresh_splits
from whacamole.labels import (
    FrameImages,
    LabelledPerson,
    RasterMesh,
    SequenceLabels,
    label_sequence,
    rasterize,
)

ROOT = Path(__file__).parents[1]
FRAMES, WIDTH, HEIGHT = 3, 96, 64
Arrays = dict[str, NDArray[Any]]


def _text(name: str) -> str:
    return (ROOT / name).read_text()


# --- A dataset without a renderer: two people, cast by the rasteriser -------------------------------------


def _camera() -> CameraPath:
    """A camera four metres away, level, turning a little."""
    poses = np.tile(np.eye(4), (FRAMES, 1, 1))
    for pose, angle in zip(poses, np.linspace(0.0, 0.1, FRAMES), strict=True):
        forward = np.array([np.sin(angle), np.cos(angle), 0.0])
        down = np.array([0.0, 0.0, -1.0])
        pose[:3, :3] = np.stack([np.cross(down, forward), down, forward], axis=1)
        pose[:3, 3] = [0.0, -4.0, 1.0]
    K = np.tile([[90.0, 0.0, WIDTH / 2], [0.0, 90.0, HEIGHT / 2], [0.0, 0.0, 1.0]], (FRAMES, 1, 1))
    return CameraPath(K, poses, 30.0, WIDTH, HEIGHT)


def _person(model: BodyModel, x: float, turn: float, rng: np.random.Generator) -> BodyParams:
    """Somebody who stands at (x, 0) in a pose of no meaning."""
    betas = rng.normal(scale=0.5, size=10)
    rest = model.rest_joints(betas)[0]
    upright = np.array([np.pi / 2, 0.0, 0.0])
    shapes = {"body_pose": (21, 3), "left_hand_pose": (15, 3), "right_hand_pose": (15, 3)}
    return BodyParams(
        betas=betas,
        expression=rng.normal(scale=0.1, size=(FRAMES, 10)),
        global_orient=np.tile(upright, (FRAMES, 1)) + turn * np.arange(FRAMES)[:, None],
        transl=np.array([x, 0.0, 0.95]) - rest + np.linspace(0.0, 0.05, FRAMES)[:, None],
        **{name: rng.normal(scale=0.1, size=(FRAMES, *shape)) for name, shape in shapes.items()},
        **{name: np.zeros((FRAMES, 3)) for name in ("jaw_pose", "leye_pose", "reye_pose")},
    )


def _images(people: list[BodyParams], model: BodyModel, camera: CameraPath) -> list[FrameImages]:
    bodies = [model.pose(params).vertices for params in people]
    images = []
    for frame, T in enumerate(camera.T_camera_world):
        meshes = [RasterMesh(body[frame] @ T[:3, :3].T + T[:3, 3], model.faces) for body in bodies]
        cast = rasterize(meshes, camera.K[frame], WIDTH, HEIGHT)
        images.append(FrameImages((cast.mesh + 1).astype(np.uint8), cast.depth.astype(np.float32)))
    return images


def _write(layout: DatasetLayout, labels: SequenceLabels, images: list[FrameImages]) -> None:
    sequence = layout.sequence("walk-00")
    for name in ("mask", "depth"):
        (sequence.folder / name).mkdir(parents=True)
    for frame, image in enumerate(images):
        Image.fromarray(np.asarray(image.mask)).save(sequence.folder / PASSES["mask"].file(frame))
        header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
        exr = OpenEXR.File(header, {"Z": np.asarray(image.depth)})
        exr.write(str(sequence.folder / PASSES["depth"].file(frame)))
    np.savez(sequence.camera, **labels.camera)
    np.savez(sequence.people, **labels.people)
    np.savez(sequence.contact, **labels.contact)
    write_summary(sequence, {"motion_id": "walk"})
    write_index(layout, {})
    refresh_splits(layout, 0.0)


@pytest.fixture(scope="module")
def labels_and_folder(tmp_path_factory: pytest.TempPathFactory) -> tuple[SequenceLabels, Path]:
    """The labels of a small sequence, and a folder that holds it as `dataset`."""
    model, camera, rng = BodyModel.embedded(), _camera(), np.random.default_rng(3)
    params = [_person(model, -0.5, 0.05, rng), _person(model, 0.6, -0.08, rng)]
    people = [LabelledPerson(i + 1, "walk", "neutral", each) for i, each in enumerate(params)]
    images = _images(params, model, camera)
    labels = label_sequence(people, model, camera, lambda frame: images[frame], self_contact=True)
    folder = tmp_path_factory.mktemp("documentation")
    _write(DatasetLayout(folder / "dataset"), labels, images)
    return labels, folder


def _run(name: str) -> dict[str, Any]:
    """All Python blocks of a page, one after the other in the working directory; returns the variables."""
    variables: dict[str, Any] = {}
    for block in re.findall(r"```python\n(.*?)```", _text(name), flags=re.DOTALL):
        exec(compile(block, name, "exec"), variables)
    for value in variables.values():
        if isinstance(value, np.lib.npyio.NpzFile):
            value.close()
    return variables


@pytest.mark.parametrize(
    ("page", "last"),
    [("docs/conventions.md", "point"), ("docs/format.md", "nearest"), ("README.md", "pixels")],
)
def test_the_code_runs(
    page: str, last: str, labels_and_folder: tuple[SequenceLabels, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The assertions in the blocks are the proof; the last variable shows that all of them ran."""
    monkeypatch.chdir(labels_and_folder[1])
    assert np.all(np.isfinite(_run(page)[last]))


def test_the_code_of_the_readme_gives_what_it_says(
    labels_and_folder: tuple[SequenceLabels, Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(labels_and_folder[1])
    expected = labels_and_folder[0].people["joints_image"][0, 0]
    np.testing.assert_allclose(_run("README.md")["pixels"], expected, atol=1e-3)


# --- Tables ----------------------------------------------------------------------------------------------


def _rows(text: str, heading: str) -> list[list[str]]:
    """Cells of the first table under a heading, without its head."""
    section = text.split(f"\n## {heading}\n", 1)[1].split("\n## ", 1)[0]
    lines = [line for line in section.splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def _documented(heading: str) -> dict[str, tuple[str, str]]:
    """Key to (shape, type) of a table of docs/format.md."""
    rows = _rows(_text("docs/format.md"), heading)
    return {key: (row[1], row[2]) for row in rows for key in re.findall(r"`(\w+)`", row[0])}


@pytest.mark.parametrize("name", ["camera", "people", "contact"])
def test_the_format_lists_every_array(name: str, labels_and_folder: tuple[SequenceLabels, Path]) -> None:
    labels = labels_and_folder[0]
    arrays: Arrays = getattr(labels, name)
    model = BodyModel.embedded()
    sizes = {
        "P": 2,
        "T": FRAMES,
        "C": len(labels.contact["part_names"]),
        "⌈V/8⌉": -(-len(model.v_template) // 8),
    }
    documented = _documented(f"{name}.npz")
    assert set(documented) == set(arrays)
    for key, (shape, kind) in documented.items():
        symbols = [] if shape == "–" else shape.split(", ")
        assert arrays[key].shape == tuple(sizes.get(s) or int(s) for s in symbols), key
        stored = "str" if arrays[key].dtype.kind == "U" else arrays[key].dtype.name
        assert stored == kind, key


def test_the_format_lists_every_pass() -> None:
    rows = _rows(_text("docs/format.md"), "Images")
    documented = {row[0].strip("`"): row for row in rows}
    assert list(documented) == list(PASSES)
    for name, entry in PASSES.items():
        _, file, channels, kind, unit, _ = documented[name]
        assert file.startswith(f"`{entry.file(0).as_posix()}`")
        assert channels == ", ".join(entry.channels)
        assert (kind, unit) == (entry.dtype, entry.unit)


def test_the_conventions_list_the_joints_in_order() -> None:
    rows = _rows(_text("docs/conventions.md"), "SMPL-X parameters")
    assert [name for row in rows for name in row[1].split(", ")] == list(JOINT_NAMES)
    for row in rows:
        first, _, last = row[0].partition("–")
        names = row[1].split(", ")
        assert JOINT_NAMES[int(first)] == names[0]
        assert JOINT_NAMES[int(last or first)] == names[-1]
