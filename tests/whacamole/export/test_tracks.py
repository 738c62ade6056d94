"""Formats of whole sequences: EMDB, TUM, nerfstudio, AMASS, MP4, each read back by another's reader."""

import json
import shutil
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest
import smplx
import torch
from evo.tools import file_interface

import whacamole
from whacamole.dataset import Dataset, write_summary
from whacamole.dataset.video import write_video
from whacamole.errors import DatasetError
from whacamole.evaluation.truth.emdb import EmdbTruth
from whacamole.export import export_dataset
from whacamole.export.emdb import SMPL_REST_PELVIS
from whacamole.motion import find_motions, read_motion


def test_emdb_is_read_by_the_evaluator_that_reads_the_benchmark(data: Dataset, tmp_path: Path) -> None:
    result = export_dataset(data, "emdb", tmp_path / "out")
    assert not result.notes
    truth = EmdbTruth(tmp_path / "out")
    assert truth.ids("emdb2") == ["P0_duet-00_01", "P0_duet-00_02", "P0_walk-00_01", "P0_walk-01_01"]
    for number in range(2):
        recording = truth.read(f"P0_duet-00_{number + 1:02d}")
        (person,) = recording.people
        sequence = data["duet-00"]
        # SMPL's pelvis is at rest pelvis + trans; the camera takes it from the y-up world to its own frame.
        pelvis = person.world.transl + SMPL_REST_PELVIS
        T_camera_world = np.linalg.inv(recording.camera.T_world_camera)
        seen = np.einsum("tij,tj->ti", T_camera_world[:, :3, :3], pelvis) + T_camera_world[:, :3, 3]
        np.testing.assert_allclose(seen, sequence.people["joints_camera"][number, :, 0], atol=1e-5)
        x, y, z = sequence.people["joints_world"][number, :, 0].T
        np.testing.assert_allclose(pelvis, np.stack([x, z, -y], axis=1), atol=1e-5)
        np.testing.assert_allclose(
            person.body_pose.reshape(4, -1)[:, :63],
            sequence.people["body_pose"][number].reshape(4, -1),
            atol=1e-6,
        )
        np.testing.assert_array_equal(person.valid, sequence.people["valid"][number])


def test_emdb_links_to_the_frames(data: Dataset, tmp_path: Path) -> None:
    export_dataset(data, "emdb", tmp_path / "deep" / "out")
    images = sorted((tmp_path / "deep" / "out" / "P0" / "walk-00_01" / "images").iterdir())
    assert [path.resolve() for path in images] == sorted(
        (data["walk-00"].layout.folder / "rgb").resolve().iterdir()
    )


def test_tum_is_read_by_evo(data: Dataset, tmp_path: Path) -> None:
    export_dataset(data, "tum", tmp_path / "out")
    for sequence in data:
        path = file_interface.read_tum_trajectory_file(str(tmp_path / "out" / f"{sequence.id}.txt"))
        np.testing.assert_allclose(path.poses_se3, sequence.camera["T_world_camera"], atol=1e-8)
        np.testing.assert_allclose(path.timestamps, np.arange(4) / 30.0, atol=1e-9)


def test_nerfstudio_projects_by_its_own_rule(data: Dataset, tmp_path: Path) -> None:
    """Camera to world, x right, y up, looking along −z: u = cx + fx·x/−z, v = cy − fy·y/−z."""
    export_dataset(data, "nerfstudio", tmp_path / "out")
    place = tmp_path / "out" / "duet-00"
    frames = json.loads((place / "transforms.json").read_text())["frames"]
    sequence = data["duet-00"]
    for t, frame in enumerate(frames):
        assert (place / frame["file_path"]).resolve() == (
            sequence.layout.folder / "rgb" / f"{t:06d}.png"
        ).resolve()
        to_camera = np.linalg.inv(np.array(frame["transform_matrix"]))
        joints = sequence.people["joints_world"][0, t] @ to_camera[:3, :3].T + to_camera[:3, 3]
        u = frame["cx"] + frame["fl_x"] * joints[:, 0] / -joints[:, 2]
        v = frame["cy"] - frame["fl_y"] * joints[:, 1] / -joints[:, 2]
        expected = sequence.people["joints_image"][0, t]
        np.testing.assert_allclose(np.stack([u, v], axis=1), expected, atol=1e-2)
        assert (frame["w"], frame["h"]) == sequence.size


def test_amass_poses_by_smplx_and_is_a_motion_again(data: Dataset, body_file: Path, tmp_path: Path) -> None:
    export_dataset(data, "amass", tmp_path / "out")
    model = smplx.create(
        str(body_file), model_type="smplx", ext="npz", use_pca=False, flat_hand_mean=True, batch_size=4
    )
    for number in range(2):
        file = tmp_path / "out" / f"duet-00_{number + 1:02d}_stageii.npz"
        with np.load(file, allow_pickle=False) as stored:
            values = dict(stored)
        assert (str(values["surface_model_type"]), float(values["mocap_frame_rate"])) == ("smplx", 30.0)
        given = {
            "betas": np.tile(values["betas"], (4, 1)), "transl": values["trans"],
            "global_orient": values["root_orient"], "body_pose": values["pose_body"],
            "jaw_pose": values["pose_jaw"], "leye_pose": values["pose_eye"][:, :3],
            "reye_pose": values["pose_eye"][:, 3:], "left_hand_pose": values["pose_hand"][:, :45],
            "right_hand_pose": values["pose_hand"][:, 45:], "expression": np.zeros((4, 10)),
        }  # fmt: skip
        with torch.no_grad():
            posed = model(**{key: torch.tensor(value, dtype=torch.float32) for key, value in given.items()})
        joints = posed.joints[:, :55].numpy()
        np.testing.assert_allclose(joints, data["duet-00"].people["joints_world"][number], atol=2e-5)
    files = find_motions(tmp_path / "out")
    assert {file.source for file in files} == {"amass-smplx"}
    person = read_motion(files[0]).people[0]
    truth = data["duet-00"].people["body_pose"][0]
    np.testing.assert_allclose(person.body_pose.reshape(truth.shape), truth, atol=1e-5)


def test_mp4_has_every_frame_at_its_time(data: Dataset, tmp_path: Path) -> None:
    export_dataset(data, "mp4", tmp_path / "out")
    sequence = data["duet-00"]
    with av.open(str(tmp_path / "out" / "duet-00.mp4")) as container:
        stream = container.streams.video[0]
        frames = list(container.decode(stream))
        times = [frame.pts * stream.time_base for frame in frames]
        assert stream.average_rate == 30
        assert (stream.width, stream.height) == (98, 64)  # 97 is odd
        pictures = [frame.to_ndarray(format="rgb24").astype(float) for frame in frames]
    assert times == [Fraction(number, 30) for number in range(4)]
    for number, picture in enumerate(pictures):
        assert np.abs(picture[:, :97] - sequence.rgb(number)).mean() < 6.0


def test_mp4_of_a_dataset_whose_frames_are_a_video(data: Dataset, tmp_path: Path) -> None:
    root = tmp_path / "dataset"
    shutil.copytree(data.layout.root, root)
    for sequence in whacamole.open(root):
        frames = [np.ascontiguousarray(sequence.rgb(number)[:, :96]) for number in range(len(sequence))]
        write_video(sequence.layout.video, frames, 30.0)
        shutil.rmtree(sequence.layout.folder / "rgb")
        facts = {key: value for key, value in sequence.facts.items() if key != "checksums"}
        write_summary(sequence.layout, facts | {"image_format": "mp4", "width": 96})
    video = whacamole.open(root)
    export_dataset(video, "mp4", tmp_path / "out")
    with av.open(str(tmp_path / "out" / "duet-00.mp4")) as container:
        pictures = [frame.to_ndarray(format="rgb24").astype(float) for frame in container.decode(video=0)]
    assert len(pictures) == len(video["duet-00"])
    for number, picture in enumerate(pictures):
        assert np.abs(picture - data["duet-00"].rgb(number)[:, :96]).mean() < 8.0
    with pytest.raises(DatasetError, match="lists single images"):
        export_dataset(video, "nerfstudio", tmp_path / "scene")


def test_a_zooming_camera_is_left_out_of_emdb(
    data: Dataset, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    camera = dict(data["walk-00"].camera)
    camera["K"] = camera["K"] * np.linspace(1.0, 1.1, 4)[:, None, None]
    monkeypatch.setattr("whacamole.dataset.reader._arrays", _with_camera(camera))
    result = export_dataset(data, "emdb", tmp_path / "out")
    assert len(result.notes) == 3
    assert "walk-00" in result.notes[1]


def _with_camera(camera):
    from whacamole.dataset.reader import _arrays

    return lambda path: camera if path.name == "camera.npz" else _arrays(path)
