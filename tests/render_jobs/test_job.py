"""Jobs as plain data: what they refuse, and that a folder gives back what went in, in the same bytes."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from PIL import Image

from camera_rigs import CameraPath
from render_jobs import (
    QUALITIES,
    Environment,
    Lamp,
    Material,
    Mesh,
    RenderJob,
    RenderJobError,
    Sun,
    missing_frames,
    quality_preset,
)
from render_truth import BOX, BOX_FACES, SQUARE, SQUARE_FACES, camera, moving

FRAMES = 2


def still(frames: int = FRAMES) -> CameraPath:
    return camera([[0.0, -4.0, 1.0]] * frames, [0.0, 0.0, 1.0], [90.0] * frames, [[48.0, 32.0]] * frames)


@pytest.fixture
def textures(tmp_path: Path) -> Path:
    folder = tmp_path / "textures"
    folder.mkdir()
    for name, value in (("skin.png", 200), ("bumps.png", 128)):
        Image.fromarray(np.full((8, 8, 3), value, np.uint8)).save(folder / name)
    return folder


@pytest.fixture
def job(textures: Path) -> RenderJob:
    """A job that uses every field there is."""
    skin = Material(
        name="skin", base_color=(0.9, 0.8, 0.7), base_color_texture=textures / "skin.png", alpha_mode="clip",
        normal_texture=textures / "bumps.png", normal_strength=0.5, subsurface=0.1, uv_scale=2.0,
    )  # fmt: skip
    uv = np.linspace(0, 1, 48).reshape(6, 4, 2)
    placements = np.stack([np.eye(4)] * 3)
    return RenderJob(
        camera=still(),
        camera_neighbours=still(2),
        meshes=(
            Mesh("box", moving(BOX, [0.1, 0, 0], FRAMES), BOX_FACES, skin, uv=uv, track_id=1, subdivision=1),
            Mesh("floor", SQUARE, SQUARE_FACES, placements=placements, smooth=False),
        ),
        lights=(Sun(angle=2.0), Lamp(kind="spot", position=(0.0, -2.0, 3.0))),
        environment=Environment(kind="hdri", hdri="forest", rotation=30.0, backdrop=(0.1, 0.2, 0.3)),
        quality=quality_preset("high"),
        passes=("flow", "rgb"),
        image_format="png",
        shutter=0.25,
        exposure=0.5,
        tone="standard",
        seed=7,
    )


def files_of(folder: Path) -> dict[str, bytes]:
    paths = (path for path in sorted(folder.rglob("*")) if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


def test_a_folder_gives_back_the_job(job: RenderJob, tmp_path: Path) -> None:
    job.save(tmp_path / "job")
    back = RenderJob.load(tmp_path / "job")
    for name in (
        "lights",
        "environment",
        "quality",
        "passes",
        "image_format",
        "shutter",
        "exposure",
        "tone",
        "seed",
    ):
        assert getattr(back, name) == getattr(job, name)
    assert back.passes == ("rgb", "flow"), "in the order of the list"
    for mine, theirs in zip(job.meshes, back.meshes, strict=True):
        for name in ("name", "track_id", "smooth", "subdivision"):
            assert getattr(mine, name) == getattr(theirs, name)
        for name in ("vertices", "faces", "uv", "placements"):
            np.testing.assert_array_equal(getattr(mine, name), getattr(theirs, name))
    for mine, theirs in zip(job.camera_with_neighbours(), back.camera_with_neighbours(), strict=True):
        np.testing.assert_array_equal(mine, theirs)
    copied = back.meshes[0].material.base_color_texture
    assert copied is not None
    assert copied.is_relative_to(tmp_path / "job")
    assert copied.read_bytes() == (tmp_path / "textures" / "skin.png").read_bytes()


def test_the_same_job_gives_the_same_bytes(job: RenderJob, tmp_path: Path) -> None:
    job.save(tmp_path / "one")
    job.save(tmp_path / "two")
    RenderJob.load(tmp_path / "one").save(tmp_path / "three")
    assert files_of(tmp_path / "one") == files_of(tmp_path / "two") == files_of(tmp_path / "three")
    assert str(tmp_path) not in (tmp_path / "one" / "job.json").read_text()


def test_saving_again_keeps_finished_frames_of_the_same_job_only(job: RenderJob, tmp_path: Path) -> None:
    folder = tmp_path / "job"
    job.save(folder)
    assert missing_frames(folder) == [0, 1]
    for name in ("rgb/000001.png", "flow/000001.exr"):
        (folder / "out" / name).parent.mkdir(parents=True)
        (folder / "out" / name).write_bytes(b"")
    job.save(folder)
    assert missing_frames(folder) == [0]
    replace(job, seed=8).save(folder)
    assert missing_frames(folder) == [0, 1]
    assert [path.name for path in tmp_path.iterdir()] == ["textures", "job"] or not list(tmp_path.glob(".*"))


def test_a_folder_that_is_no_job_is_left_alone(job: RenderJob, tmp_path: Path) -> None:
    (tmp_path / "home").mkdir()
    (tmp_path / "home" / "letter.txt").write_text("dear")
    with pytest.raises(RenderJobError, match="exists and is no job folder"):
        job.save(tmp_path / "home")
    assert (tmp_path / "home" / "letter.txt").read_text() == "dear"


def test_neighbours_are_held_where_none_are_given() -> None:
    path = camera([[0, -4, 1], [0, -5, 1]], [0, 0, 1], [90.0, 91.0], [[48.0, 32.0]] * 2)
    K, pose = RenderJob(path, (Mesh("floor", SQUARE, SQUARE_FACES),)).camera_with_neighbours()
    assert K[:, 0, 0].tolist() == [90, 90, 91, 91]
    assert pose[:, 1, 3].tolist() == [-4, -4, -5, -5]


BROKEN: list[tuple[dict[str, Any], str]] = [
    ({"passes": ("rgb", "colour")}, "passes colour: choose from rgb, mask"),
    ({"passes": ()}, "passes"),
    ({"image_format": "gif"}, "image_format 'gif' is not one of jpg, png"),
    ({"tone": "sepia"}, "tone 'sepia'"),
    ({"shutter": 1.5}, "shutter 1.5 is outside 0..1"),
    ({"exposure": float("nan")}, "exposure nan"),
    ({"seed": -1}, "seed -1 is outside"),
    ({"meshes": ()}, "no mesh"),
    ({"meshes": (Mesh("a", SQUARE, SQUARE_FACES),) * 2}, "two meshes are named 'a'"),
    ({"meshes": (Mesh("a", moving(BOX, [0, 0, 0], 5), BOX_FACES),)}, "7 frames of vertices, expected 4"),
    ({"camera_neighbours": still(3)}, "camera_neighbours has 3 frames, expected 2"),
]


@pytest.mark.parametrize(("change", "message"), BROKEN)
def test_a_job_that_makes_no_sense_is_refused_in_one_line(change: dict[str, Any], message: str) -> None:
    with pytest.raises(RenderJobError) as caught:
        RenderJob(**{"camera": still(), "meshes": (Mesh("floor", SQUARE, SQUARE_FACES),), **change})
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("where", "value", "message"),
    [
        (("K", 0, 0, 0), np.nan, "NaN"),
        (("K", 0, 0, 0), -5.0, "positive focal lengths"),
        (("K", 0, 0, 1), 3.0, "no skew"),
        (("K", 1, 1, 1), 95.0, "pixel aspect"),
        (("K", 0, 0, 2), 5000.0, "principal point"),
        (("T_world_camera", 1, 0, 0), 0.5, "no rotation"),
    ],
)
def test_a_camera_that_makes_no_sense_is_refused(where: tuple[Any, ...], value: float, message: str) -> None:
    path = still()
    getattr(path, where[0])[where[1:]] = value
    with pytest.raises(RenderJobError, match=message):
        RenderJob(path, (Mesh("floor", SQUARE, SQUARE_FACES),))


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"name": "a b"}, "name may hold"),
        ({"name": "../up"}, "name may hold"),
        ({"vertices": np.zeros((4, 2))}, r"shape \(4, 2\)"),
        ({"vertices": np.full((4, 3), np.nan)}, "NaN"),
        ({"faces": np.array([[0, 1, 9]])}, "outside 0..3"),
        ({"faces": np.array([[0, -1, 2]])}, "outside 0..3"),
        ({"uv": np.zeros((1, 3, 2))}, r"expected \(1, 4, 2\)"),
        ({"placements": np.eye(3)}, "placements"),
        ({"track_id": 40000}, "track_id 40000"),
        ({"subdivision": 9}, "subdivision 9"),
    ],
)
def test_a_mesh_that_makes_no_sense_is_refused(change: dict[str, Any], message: str) -> None:
    with pytest.raises(RenderJobError, match=message):
        Mesh(**{"name": "floor", "vertices": SQUARE, "faces": SQUARE_FACES, **change})


def test_values_are_checked_where_they_are_written_down() -> None:
    with pytest.raises(ValueError, match="roughness"):
        Material(roughness=1.5)
    with pytest.raises(ValueError, match="shiny"):
        Material(shiny=True)  # type: ignore[call-arg]
    with pytest.raises(ValueError, match="hdri"):
        Environment(kind="hdri", hdri=3)  # type: ignore[arg-type]
    with pytest.raises(RenderJobError, match="'ultra' is not one of draft, standard, high"):
        quality_preset("ultra")
    assert list(QUALITIES) == ["draft", "standard", "high"]


def test_a_texture_that_cannot_be_used_is_named(tmp_path: Path) -> None:
    for name, message in (("gone.png", "cannot be copied"), ("notes.txt", "must end in")):
        material = Material(base_color_texture=tmp_path / name)
        job = RenderJob(still(), (Mesh("floor", SQUARE, SQUARE_FACES, material),))
        with pytest.raises(RenderJobError, match=f"{name}.*{message}"):
            job.save(tmp_path / "job")
        assert not (tmp_path / "job").exists()
    assert list(tmp_path.iterdir()) == [], "nothing is left behind"


def _spoil_json(folder: Path, **values: Any) -> None:
    record = json.loads((folder / "job.json").read_text())
    (folder / "job.json").write_text(json.dumps({**record, **values}))


def test_a_damaged_folder_is_refused_in_one_line(job: RenderJob, tmp_path: Path) -> None:
    vertices = "meshes/0000/vertices.npy"
    spoilers: dict[str, Any] = {
        "job.json: cannot be read": lambda folder: (folder / "job.json").unlink(),
        "Invalid JSON": lambda folder: (folder / "job.json").write_text("{"),
        "width": lambda folder: _spoil_json(folder, width="wide"),
        "Extra inputs": lambda folder: _spoil_json(folder, colour=1),
        "version": lambda folder: _spoil_json(folder, version=99),
        "vertices.npy is damaged": lambda folder: (folder / vertices).write_bytes(b"\x93NUMPY"),
        "vertices.npy cannot be read": lambda folder: (folder / vertices).unlink(),
        "outside the job folder": lambda folder: _spoil_json(folder, files={"../secret": "0" * 64}),
        "holds 2 frames, job.json 9": lambda folder: _spoil_json(folder, num_frames=9),
    }
    for index, (message, spoil) in enumerate(spoilers.items()):
        folder = tmp_path / str(index)
        job.save(folder)
        spoil(folder)
        with pytest.raises(RenderJobError) as caught:
            RenderJob.load(folder)
        assert message in str(caught.value)
        assert str(folder) in str(caught.value)
        assert "\n" not in str(caught.value)


def test_no_array_may_hold_objects(job: RenderJob, tmp_path: Path) -> None:
    """An unpickled object could execute; the checksum alone would not stop a folder made to deceive."""
    import hashlib

    job.save(tmp_path / "job")
    name = "meshes/0001/faces.npy"
    np.save(tmp_path / "job" / name, np.array([{"a": 1}], dtype=object), allow_pickle=True)
    record = json.loads((tmp_path / "job" / "job.json").read_text())
    record["files"][name] = hashlib.sha256((tmp_path / "job" / name).read_bytes()).hexdigest()
    _spoil_json(tmp_path / "job", files=record["files"])
    with pytest.raises(RenderJobError, match="no plain NumPy array"):
        RenderJob.load(tmp_path / "job")


@settings(max_examples=25, derandomize=True, deadline=None)
@given(
    vertices=arrays(np.float32, (FRAMES + 2, 5, 3), elements=st.floats(-1e6, 1e6, width=32)),
    faces=arrays(np.int32, (3, 3), elements=st.integers(0, 4)),
    seed=st.integers(0, 2**31 - 1),
    exposure=st.floats(-20, 20),
)
def test_any_geometry_survives_the_folder(
    vertices: Any, faces: Any, seed: int, exposure: float, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("any") / "job"
    RenderJob(still(), (Mesh("any", vertices, faces),), seed=seed, exposure=exposure).save(folder)
    back = RenderJob.load(folder)
    assert back.meshes[0].vertices.tobytes() == vertices.tobytes()
    assert back.meshes[0].faces.tobytes() == faces.tobytes()
    assert (back.seed, back.exposure) == (seed, exposure)
