"""Realism changes the pictures and no label, and the labels say what was done."""

from pathlib import Path

import numpy as np
import pytest

from tests_support import SMALL, run_cli, write_amass
from whacamole.errors import RecipeError
from whacamole.recipe import load_recipe

pytestmark = [pytest.mark.gl, pytest.mark.slow]

OPTIONS = ("--motion-blur", "0.5", "--f-number", "1.4,2", "--exposure", "0.5", "--noise", "2,6")


def _render(motion: Path, out: Path, *options: object) -> Path:
    small = (*SMALL, "--engine", "raster", "--passes", "rgb,mask,depth,normal,flow", "--image-format", "png")
    result = run_cli("render", "--motions", motion, *small, *options, "--out", out)
    assert result.returncode == 0, result.stderr
    return next((out / "sequences").iterdir())


def test_realism_changes_the_pictures_alone_and_is_written_down(tmp_path: Path) -> None:
    motion = write_amass(tmp_path / "walk_stageii.npz")
    plain = _render(motion, tmp_path / "plain")
    filmed = _render(motion, tmp_path / "filmed", *OPTIONS)
    again = _render(motion, tmp_path / "again", *OPTIONS)
    for name in ("mask", "depth", "normal", "flow"):
        for path in (plain / name).iterdir():
            assert path.read_bytes() == (filmed / name / path.name).read_bytes()
    for name in ("people.npz", "contact.npz", "shot.json"):
        assert (plain / name).read_bytes() == (filmed / name).read_bytes()
    for path in (filmed / "rgb").iterdir():
        assert path.read_bytes() == (again / "rgb" / path.name).read_bytes()
        assert path.read_bytes() != (plain / "rgb" / path.name).read_bytes()
    assert (filmed / "camera.npz").read_bytes() == (again / "camera.npz").read_bytes()
    before, after = (np.load(folder / "camera.npz", allow_pickle=False) for folder in (plain, filmed))
    for key in ("K", "T_world_camera", "fps"):
        np.testing.assert_array_equal(before[key], after[key])
    assert (before["shutter"], before["noise"], before["f_number"]) == (0.0, 0.0, np.inf)
    assert np.isposinf(before["focus_distance"]).all()
    assert after["shutter"] == 0.5
    assert after["exposure"] == pytest.approx(before["exposure"] + 0.5)
    assert 1.4 <= after["f_number"] <= 2.0
    assert 2.0 <= after["noise"] <= 6.0
    neck = np.load(filmed / "people.npz", allow_pickle=False)["joints_camera"][0, :, 12]
    np.testing.assert_allclose(after["focus_distance"], neck[:, 2], atol=1e-4)


@pytest.mark.parametrize(
    ("option", "value", "message"),
    [
        ("motion_blur", "1.5", "motion-blur: must be less than or equal to 1"),
        ("f_number", "wide", "'wide' is neither a number nor two"),
        ("exposure", "1,-1", "1,-1: the smaller number comes first"),
        ("noise", "-3", "noise: must be greater than or equal to 0"),
    ],
)
def test_a_wrong_value_is_named(option: str, value: str, message: str) -> None:
    with pytest.raises(RecipeError) as caught:
        load_recipe(None, {option: value})
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)
