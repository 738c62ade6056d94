"""The code in docs/rendering.md runs, and what it makes can be rendered."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from render_jobs import run_job
from render_truth import read_picture

DOCUMENT = Path(__file__).parents[2] / "docs" / "rendering.md"


@pytest.mark.gl
def test_the_example_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", DOCUMENT.read_text(encoding="utf-8"), flags=re.DOTALL)
    assert len(blocks) == 1
    exec(compile(blocks[0], str(DOCUMENT), "exec"), {})
    run_job("job", engine="raster", timeout=300)
    assert set(read_picture(tmp_path / "job" / "out" / "mask" / "000003.png").ravel()) == {0, 1}
