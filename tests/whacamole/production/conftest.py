"""Small datasets rendered once for all tests of the main job, through the command line, as a user would."""

from pathlib import Path

import pytest

from tests_support import run_cli, write_amass, write_pair
from whacamole.body import BodyModel

FRAMES = 6
SIZE = (320, 180)


@pytest.fixture(scope="session")
def motions(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One walk and one pair."""
    folder = tmp_path_factory.mktemp("motions")
    write_amass(folder / "walk_stageii.npz")
    write_pair(folder)
    return folder


@pytest.fixture(scope="session")
def dataset(motions: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Both motions, all passes."""
    out = tmp_path_factory.mktemp("dataset") / "data"
    result = run_cli(
        "render", "--motions", motions, "--shots", "arc,tracking", "--frames", FRAMES, "--quality", "draft",
        "--size", f"{SIZE[0]}x{SIZE[1]}", "--passes", "rgb,mask,depth,normal,flow", "--image-format", "png",
        "--out", out, "--seed", 5,
    )  # fmt: skip
    assert result.returncode == 0, result.stdout + result.stderr
    return out


@pytest.fixture(scope="session")
def exported_body(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The embedded body as a file for the ``smplx`` package."""
    return BodyModel.embedded().export_full(tmp_path_factory.mktemp("body") / "SMPLX_NEUTRAL.npz")
