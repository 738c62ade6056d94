import re
from pathlib import Path

import pytest

DOC = Path(__file__).parents[3] / "docs" / "body.md"


def test_the_code_in_the_documentation_runs(model, tmp_path, monkeypatch):
    model.export_full(tmp_path / "SMPLX_NEUTRAL.npz")
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", DOC.read_text(), re.DOTALL)
    assert len(blocks) == 3
    for block in blocks:
        exec(compile(block, str(DOC), "exec"), {})


def test_the_figures_in_the_documentation_are_those_of_the_body(model):
    text = DOC.read_text()
    assert f"{model.num_vertices:,} vertices".replace(",", " ") in text
    assert f"{len(model.faces):,} triangles".replace(",", " ") in text
    unit = [[2.0 if i == k else 0.0 for i in range(10)] for k in range(2)]
    low, high = re.search(r"\| 0 \| taller .*? \| ([\d.]+) … ([\d.]+) m", text).groups()
    assert model.stature([-b for b in unit[0]]) == pytest.approx(float(low), abs=0.01)
    assert model.stature(unit[0]) == pytest.approx(float(high), abs=0.01)
    low, high = re.search(r"\| 1 \| heavier \| (\d+) … (\d+) litres", text).groups()
    assert 1000 * model.volume([-b for b in unit[1]]) == pytest.approx(float(low), abs=1)
    assert 1000 * model.volume(unit[1]) == pytest.approx(float(high), abs=1)
