"""The command line as somebody meets it who mistypes: one line on what is wrong, and nothing made."""

import sys
from pathlib import Path

import numpy as np
import pytest

from whacamole.cli import main


def run(monkeypatch: pytest.MonkeyPatch, *arguments: object) -> int:
    """Run `whacamole ARGUMENTS` in this process; return its exit code."""
    monkeypatch.setattr(sys, "argv", ["whacamole", *map(str, arguments)])
    with pytest.raises(SystemExit) as left:
        main()
    return int(left.value.code or 0)


WRONG = {
    "an unknown shot": (["--shots", "arcc"], "'arcc' is unknown: choose from auto, all, arc"),
    "no shot": (["--shots", ","], "no shot is named"),
    "an unknown pass": (["--passes", "rgb,mask,depth,dpeth"], "'dpeth' is none of rgb, mask, depth"),
    "no size": (["--size", "0x0"], "greater than or equal to 16 (got 0)"),
    "a lens": (["--focal-mm", "50,24"], "the smaller number comes first"),
    "no parts": (["--shard", "0/0"], "at least one part"),
    "no cluster": (["--cluster", "tcp"], "such as tcp://host:8786"),
    "an address of no kind": (["--cluster", "http://host:8786"], "such as tcp://host:8786"),
    "a cluster's file": (["--cluster-config", "slurm.yaml"], "--cluster slurm alone"),
    "no recipe": (["--recipe", "recipe.yaml"], "recipe.yaml: not a readable recipe (No such file"),
    "no body": (["--body-model", "SMPLX.npz"], "SMPLX.npz: No such file"),
    "no textures": (["--textures", "pictures"], "pictures: no .png or .jpg"),
    "no regions": (["--contact-regions", "regions.json"], "regions.json"),
    "a file as folder": (["--out", "file"], "file: is a file, not a folder; choose another --out"),
    "a folder below a file": (["--out", "file/dataset"], "file: is a file, not a folder"),
    "other things": (["--out", "other"], "other: holds other files and no dataset"),
}


@pytest.mark.parametrize("dry", [["--dry-run"], []], ids=["dry", "for good"])
@pytest.mark.parametrize(("options", "told"), WRONG.values(), ids=WRONG)
def test_a_wrong_option_is_one_line_and_makes_nothing(
    options: list[str],
    told: str,
    dry: list[str],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").touch()
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "notes.txt").touch()
    before = sorted(tmp_path.rglob("*"))
    assert run(monkeypatch, "render", "--out", "dataset", *options, *dry) == 1
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1
    assert lines[0].startswith("error: ")
    assert told in lines[0]
    assert sorted(tmp_path.rglob("*")) == before


def test_a_fault_of_both_numbers_of_a_pair_is_told_once(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    run(monkeypatch, "render", "--size", "0x0", "--dry-run")
    assert capsys.readouterr().err.count("greater than") == 1


def test_a_dry_run_into_a_pipe_names_motions_in_full_and_what_is_not_there(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    motion = tmp_path / ("a_name_" * 10 + "poses.npz")
    arrays = {"poses": np.zeros((90, 156)), "trans": np.zeros((90, 3)), "mocap_framerate": 30.0}
    np.savez(motion, **arrays)
    np.savez(tmp_path / "still_poses.npz", **{**arrays, "poses": arrays["poses"][:1]})
    stages = f"plaza,{tmp_path}/hall.blend"
    options = ("--motions", tmp_path, "--stages", stages, "--out", tmp_path / "dataset")
    assert run(monkeypatch, "render", "--dry-run", *options) == 1
    told = capsys.readouterr()
    assert f" {motion.stem}-00 " in told.out
    assert "1 to make" in told.out
    assert f"refused: {tmp_path}/hall.blend: there is no such file or folder" in told.err
    assert "still_poses.npz: a motion of 1 frame(s); give at least 2" in told.err


def test_where_no_motion_is_usable_no_dataset_is_begun(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "walk_poses.npz").write_text("no motion", encoding="utf-8")
    assert run(monkeypatch, "render", "--motions", tmp_path, "--out", tmp_path / "dataset") == 1
    assert "refused: " in capsys.readouterr().err
    assert not (tmp_path / "dataset").exists()


def test_what_the_system_refuses_is_one_line(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").touch()
    assert run(monkeypatch, "body", "--export", tmp_path / "file" / "body.npz") == 1
    [line] = capsys.readouterr().err.splitlines()
    assert line.startswith(f"error: {tmp_path}/file")


def test_the_version_is_told(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    from whacamole import __version__

    assert run(monkeypatch, "--version") == 0
    assert capsys.readouterr().out == f"whacamole {__version__}\n"
