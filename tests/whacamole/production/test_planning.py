"""Plans without pixels: the cameras of `render`, files that agree, breaches that are found."""

import json
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests_support import run_cli, write_amass, write_pair
from whacamole.dataset.files import sha256_of, write_arrays
from whacamole.production.planning import check_plans, make_plans
from whacamole.recipe import load_recipe


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    motions = tmp_path_factory.mktemp("motions")
    write_amass(motions / "walk_stageii.npz", frames=90)
    write_pair(motions, frames=60)
    return motions


@pytest.fixture(scope="module")
def plans(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("plans")
    _, planned = make_plans(load_recipe(None, {"motions": folder, "seed": 5}), out)
    assert [entry.ok for entry in planned] == [True, True]
    return out


def test_plans_are_the_cameras_that_render_films_by(dataset: Path, motions: Path, tmp_path: Path) -> None:
    recipe = json.loads((dataset / "recipe.json").read_text(encoding="utf-8"))
    make_plans(load_recipe(None, {**recipe, "motions": motions}), tmp_path)
    for sequence in (dataset / "sequences").iterdir():
        for name in ("camera.npz", "shot.json"):
            assert sha256_of(tmp_path / "sequences" / sequence.name / name) == sha256_of(sequence / name)


def test_the_exports_hold_the_same_poses(plans: Path) -> None:
    for sequence in (plans / "sequences").iterdir():
        with np.load(sequence / "camera.npz") as camera:
            poses, fps, T = camera["T_world_camera"], float(camera["fps"]), len(camera["K"])
        tum = np.loadtxt(sequence / "camera.tum")
        np.testing.assert_allclose(tum[:, 0], np.arange(T) / fps, atol=1e-8)
        np.testing.assert_allclose(tum[:, 1:4], poses[:, :3, 3], atol=1e-8)
        turn = Rotation.from_quat(tum[:, 4:]) * Rotation.from_matrix(poses[:, :3, :3]).inv()
        assert turn.magnitude().max() < 1e-7
        frames = json.loads((sequence / "transforms.json").read_text(encoding="utf-8"))["frames"]
        for frame, pose in zip(frames, poses, strict=True):
            opengl = np.array(frame["transform_matrix"])
            np.testing.assert_allclose(opengl[:3, 3], pose[:3, 3], atol=1e-12)
            np.testing.assert_allclose(opengl[:3, 2], -pose[:3, 2], atol=1e-12)  # OpenGL looks backwards


def test_the_picture_is_whole(plans: Path) -> None:
    for sequence in (plans / "sequences").iterdir():
        root = ElementTree.parse(sequence / "plan.svg").getroot()
        lines = root.findall(".//{http://www.w3.org/2000/svg}polyline")
        assert len(lines) >= 2 * (1 + 1 + 2)  # in each view at least a person, a shot, two frusta


def test_stored_plans_pass_and_a_moved_camera_does_not(plans: Path, tmp_path: Path) -> None:
    assert all(entry.ok for entry in check_plans(plans))
    broken = tmp_path / "walk"
    broken.mkdir()
    [source] = (plans / "sequences").glob("walk*")
    (broken / "shot.json").write_bytes((source / "shot.json").read_bytes())
    with np.load(source / "camera.npz") as camera:
        arrays = dict(camera)
    arrays["T_world_camera"] = arrays["T_world_camera"].copy()
    arrays["T_world_camera"][:, 2, 3] -= 5.0
    write_arrays(broken / "camera.npz", arrays)
    [entry] = check_plans(tmp_path)
    assert "ground" in {finding.rule for finding in entry.findings}


def test_the_command_judges_and_says_so_by_its_exit_code(plans: Path, tmp_path: Path) -> None:
    good = run_cli("plan", "--check", plans, "--json")
    assert good.returncode == 0
    assert len(json.loads(good.stdout)["plans"]) == 2
    (tmp_path / "shot.json").write_text("{}", encoding="utf-8")
    bad = run_cli("plan", "--check", tmp_path)
    assert bad.returncode == 1
    assert "camera.npz" in bad.stderr
    nothing = run_cli("plan", "--check", tmp_path / "nowhere")
    assert nothing.returncode == 1
    assert "nowhere" in nothing.stderr


def test_shots_that_do_not_exist_are_named(folder: Path, tmp_path: Path) -> None:
    result = run_cli("plan", "--motions", folder, "--out", tmp_path, "--shots", "arc,helicopter")
    assert result.returncode == 1
    assert "helicopter" in result.stderr
    assert "Traceback" not in result.stderr


def test_a_crowd_that_the_motions_cannot_fill_is_told_in_one_line(folder: Path, tmp_path: Path) -> None:
    asked = ("render", "--motions", folder, "--people", "3-4", "--out", tmp_path / "d", "--dry-run")
    told = [line for line in run_cli(*asked).stdout.splitlines() if "fewer than 3 people" in line]
    assert len(told) == 1
    assert told[0].startswith(
        "1 of 2 sequences have fewer than 3 people, walk_stageii-00 has 1: --motions holds"
    )
    assert json.loads(run_cli(*asked, "--json").stdout)["fewer_people"] == {"walk_stageii-00": 1}


def test_a_damaged_motion_of_a_further_person_costs_that_person_alone(tmp_path: Path) -> None:
    motions = tmp_path / "motions"
    motions.mkdir()
    whole = write_amass(motions / "walk_stageii.npz", frames=60)
    with np.load(whole) as arrays:
        damaged = dict(arrays)
    damaged["poses"] = damaged["poses"].copy()
    damaged["poses"][7] = np.nan
    np.savez(motions / "zz_stageii.npz", **damaged)
    _, planned = make_plans(load_recipe(None, {"motions": motions, "people": 2}), tmp_path / "plans")
    walk, broken = sorted(planned, key=lambda entry: entry.sequence_id)
    assert walk.ok
    assert not walk.error
    assert "'poses' is not finite" in broken.error
