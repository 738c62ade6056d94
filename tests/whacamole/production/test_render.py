"""The main job as a user runs it: complete, repeatable, resumable, patient with bad files."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from tests_support import SMALL, run_cli, shared_folder, write_amass

pytestmark = [pytest.mark.blender, pytest.mark.slow]

LABELS = ("camera.npz", "people.npz", "contact.npz", "shot.json")


def _contents(dataset: Path, *patterns: str) -> dict[str, bytes]:
    return {
        path.relative_to(dataset).as_posix(): path.read_bytes()
        for pattern in patterns
        for path in sorted((dataset / "sequences").glob(pattern))
    }


def _labels(dataset: Path) -> dict[str, bytes]:
    found = _contents(dataset, *(f"*/{name}" for name in LABELS))
    found["dataset.json"] = (dataset / "dataset.json").read_bytes()
    return found


@pytest.fixture(scope="module")
def one_walk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_amass(tmp_path_factory.mktemp("one") / "walk_stageii.npz")


@pytest.fixture(scope="module")
def unbroken(one_walk: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("unbroken") / "data"
    result = run_cli(
        "render", "--motions", one_walk, *SMALL, "--out", out, "--seed", 3, "--shots-per-motion", 2
    )
    assert result.returncode == 0, result.stderr
    return out


def test_every_file_of_the_contract_is_there(dataset: Path) -> None:
    index = json.loads((dataset / "dataset.json").read_text(encoding="utf-8"))
    splits = [
        (dataset / "splits" / f"{side}.txt").read_text(encoding="utf-8").split() for side in ("train", "test")
    ]
    assert sorted(splits[0] + splits[1]) == [entry["id"] for entry in index["sequences"]]
    assert [path.name for path in (dataset / ".work").iterdir()] == ["profiles"], "nothing unfinished"
    for entry in index["sequences"]:
        folder = dataset / "sequences" / entry["id"]
        for name in (*LABELS, "preview.jpg", "sequence.json"):
            assert (folder / name).stat().st_size > 0
        for name, suffix in (
            ("rgb", "png"),
            ("mask", "png"),
            ("depth", "exr"),
            ("normal", "exr"),
            ("flow", "exr"),
        ):
            frames = sorted(path.name for path in (folder / name).iterdir())
            assert frames == [f"{frame:06d}.{suffix}" for frame in range(entry["frames"])]


def test_arrays_have_the_shapes_of_the_contract(dataset: Path) -> None:
    for folder in (dataset / "sequences").iterdir():
        with np.load(folder / "camera.npz", allow_pickle=False) as camera:
            T = len(camera["frame_index"])
            assert camera["K"].shape == (T, 3, 3)
            products = camera["T_world_camera"] @ camera["T_camera_world"]
            np.testing.assert_allclose(products, np.broadcast_to(np.eye(4), (T, 4, 4)), atol=1e-12)
        with np.load(folder / "people.npz", allow_pickle=False) as people:
            P = len(people["track_id"])
            expected = {
                "betas": (P, 10), "expression": (P, T, 10), "body_pose": (P, T, 21, 3), "jaw_pose": (P, T, 3),
                "left_hand_pose": (P, T, 15, 3), "right_hand_pose": (P, T, 15, 3), "leye_pose": (P, T, 3),
                "global_orient_world": (P, T, 3), "transl_camera": (P, T, 3), "joints_world": (P, T, 55, 3),
                "joints_image": (P, T, 55, 2), "joint_visibility": (P, T, 55), "bbox_xyxy": (P, T, 4),
                "bbox_visible_xyxy": (P, T, 4), "visible_fraction": (P, T), "valid": (P, T),
            }  # fmt: skip
            assert {key: people[key].shape for key in expected} == expected
        with np.load(folder / "contact.npz", allow_pickle=False) as contact:
            C = len(contact["part_names"])
            assert contact["ground_contact"].shape == contact["ground_distance"].shape == (P, T, C)
            for key in ("person_contact", "person_distance", "person_contact_part"):
                assert contact[key].shape == (P, P, T, C)


def test_one_seed_one_dataset(one_walk: Path, unbroken: Path, tmp_path: Path) -> None:
    again = tmp_path / "data"
    result = run_cli(
        "render", "--motions", one_walk, *SMALL, "--out", again, "--seed", 3, "--shots-per-motion", 2
    )
    assert result.returncode == 0, result.stderr
    assert _labels(again) == _labels(unbroken)
    images = ("*/rgb/*", "*/mask/*", "*/depth/*", "*/preview.jpg")
    assert _contents(again, *images) == _contents(unbroken, *images)


def test_another_seed_another_camera(one_walk: Path, unbroken: Path, tmp_path: Path) -> None:
    out = tmp_path / "data"
    assert run_cli("render", "--motions", one_walk, *SMALL, "--out", out, "--seed", 4).returncode == 0
    name = "sequences/walk_stageii-00/camera.npz"
    with np.load(out / name) as one, np.load(unbroken / name) as other:
        assert np.abs(one["T_world_camera"] - other["T_world_camera"]).max() > 0.1


def test_a_finished_dataset_is_left_alone(one_walk: Path, unbroken: Path) -> None:
    before = {path: path.stat().st_mtime_ns for path in (unbroken / "sequences").rglob("*")}
    arguments = ("--motions", one_walk, *SMALL, "--out", unbroken, "--seed", 3, "--shots-per-motion", 2)
    assert run_cli("render", *arguments).returncode == 0
    assert {path: path.stat().st_mtime_ns for path in (unbroken / "sequences").rglob("*")} == before


def test_killed_runs_end_with_the_same_labels(one_walk: Path, unbroken: Path, tmp_path: Path) -> None:
    out = tmp_path / "data"
    command = [
        sys.executable, "-m", "whacamole", "render", "--motions", str(one_walk), *map(str, SMALL),
        "--out", str(out), "--seed", "3", "--shots-per-motion", "2", "--quiet",
    ]  # fmt: skip
    rng = np.random.default_rng(int.from_bytes(os.urandom(4), "big"))  # any moment must do
    for _ in range(3):
        process = subprocess.Popen(command, start_new_session=True)
        time.sleep(float(rng.uniform(0.5, 8.0)))
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    result = subprocess.run(command, check=False, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    assert _labels(out) == _labels(unbroken)
    assert _contents(out, "*/rgb/*", "*/mask/*", "*/depth/*") == _contents(
        unbroken, "*/rgb/*", "*/mask/*", "*/depth/*"
    )


def test_an_interrupted_run_leaves_no_process(one_walk: Path, tmp_path: Path) -> None:
    command = [
        sys.executable,
        "-m",
        "whacamole",
        "render",
        "--motions",
        str(one_walk),
        *map(str, SMALL),
        "--out",
    ]
    process = subprocess.Popen(
        [*command, str(tmp_path / "data"), "--frames", "30"], stderr=subprocess.PIPE, text=True
    )
    time.sleep(3.0)
    process.kill()  # the parent alone; its children must notice
    process.communicate()
    deadline = time.monotonic() + 30.0
    while _processes_naming(str(tmp_path)) and time.monotonic() < deadline:
        time.sleep(0.2)
    assert not _processes_naming(str(tmp_path))


def test_ctrl_c_says_that_the_same_command_goes_on(one_walk: Path, tmp_path: Path) -> None:
    command = (sys.executable, "-m", "whacamole", "render", "--motions", one_walk, *SMALL, "--frames", "30")
    process = subprocess.Popen(
        [*map(str, command), "--out", str(tmp_path / "data")], stderr=subprocess.PIPE, text=True
    )
    while process.poll() is None and not (tmp_path / "data" / "recipe.json").exists():
        time.sleep(0.05)
    process.send_signal(signal.SIGINT)
    _, told = process.communicate(timeout=60)
    assert process.returncode == 130
    assert told.splitlines()[-1] == "stopped; finished sequences are kept, the same command goes on"


def _processes_naming(text: str) -> list[str]:
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit() and int(entry.name) != os.getpid():
            try:
                arguments = (entry / "cmdline").read_bytes().decode(errors="replace")
            except OSError:
                continue
            if text in arguments:
                found.append(arguments)
    return found


def test_bad_files_are_named_and_the_good_ones_rendered(tmp_path: Path) -> None:
    bad = shared_folder("motions/bad")
    motions = tmp_path / "motions"
    shutil.copytree(bad, motions)
    write_amass(motions / "good_stageii.npz")
    out = tmp_path / "data"
    result = run_cli("render", "--motions", motions, *SMALL, "--out", out, "--jobs", 2)
    assert result.returncode == 1
    assert (out / "sequences" / "good_stageii-00" / "sequence.json").exists()
    assert "Traceback" not in result.stderr + result.stdout
    for path in sorted(bad.iterdir()):
        lines = [
            line
            for line in result.stderr.splitlines()
            if path.name in line and line.startswith(("refused", "failed"))
        ]
        assert len(lines) == 1, f"{path.name}: {lines}"


def test_another_recipe_in_the_same_folder_is_refused(unbroken: Path, one_walk: Path) -> None:
    result = run_cli("render", "--motions", one_walk, *SMALL, "--out", unbroken, "--seed", 99)
    assert result.returncode == 1
    assert "seed 3 is now 99" in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1


def test_a_dry_run_makes_nothing(one_walk: Path, tmp_path: Path) -> None:
    result = run_cli("render", "--motions", one_walk, "--out", tmp_path / "data", "--dry-run")
    assert result.returncode == 0
    assert "walk_stageii-00" in result.stdout
    assert not (tmp_path / "data").exists()
