"""docs/cameras.md is true: its code runs, its pictures are there and small, its names are the code's."""

import ast
import json
import re
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from camera_rigs import KINDS, RULES, SCALES, Limits, Style

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "docs" / "cameras.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)
PICTURES = re.findall(r"\]\((images/[^)]*)\)", TEXT)


def constants():
    """Names of the module constants of camera_rigs."""
    found = set()
    for file in (ROOT / "camera_rigs").rglob("*.py"):
        for node in ast.parse(file.read_text(encoding="utf-8")).body:
            targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
            found |= {target.id for target in targets if isinstance(target, ast.Name)}
    return found


def test_the_code_runs_and_a_stored_plan_is_judged(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(BLOCKS[0], names)
    plan = names["plan"]
    assert plan.ok
    path = plan.path
    np.savez("camera.npz", K=path.K, T_world_camera=path.T_world_camera, width=path.width, height=path.height)
    Path("shot.json").write_text(json.dumps(plan.to_json()), encoding="utf-8")
    exec(BLOCKS[1], {})


def test_every_shot_has_a_small_picture():
    for picture in PICTURES:
        assert (ROOT / "docs" / picture).stat().st_size < 60_000
    assert {*KINDS, "handheld", "director"} == {Path(picture).stem for picture in PICTURES}


def test_every_name_is_one_of_the_code():
    named = set(re.findall(r"`([A-Z]+_[A-Z_]+)`", TEXT))
    assert len(named) > 25
    assert named <= constants()


def test_every_rule_scale_and_choice_of_style_is_listed():
    for name in (*(rule.name for rule in RULES), *SCALES, *KINDS):
        assert f"`{name}`" in TEXT, name
    for field in fields(Style):
        assert f"`{field.name}`" in TEXT or field.name == "options", field.name


@pytest.mark.parametrize(("rule", "field"), [("look-at", "look_at"), ("speed", "speed"), ("turn", "turn")])
def test_the_limits_are_the_code_s(rule, field):
    row = next(line for line in TEXT.splitlines() if line.startswith(f"| `{rule}` |"))
    assert f"{getattr(Limits(), field):g}" in row
