"""What docs/extending.md tells to write works: its blocks run, in their order, in one process."""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "extending.md"


def test_the_page_runs(tmp_path: Path) -> None:
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(), flags=re.DOTALL)
    assert len(blocks) == 9
    (tmp_path / "page.py").write_text("\n\n".join(blocks))
    run = subprocess.run(
        [sys.executable, "-W", "error", "page.py"], cwd=tmp_path, env={"PYTHONPATH": str(ROOT), "PATH": ""},
        capture_output=True, text=True, check=False, timeout=300,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr


def test_the_lists_it_names_are_where_it_says() -> None:
    rows = re.findall(r"^\| a .+? \| .+ \| `(\w+)` in `([\w/.]+)` \|$", PAGE.read_text(), flags=re.MULTILINE)
    assert len(rows) == 5
    for name, file in rows:
        assert re.search(rf"^{name}\b", (ROOT / file).read_text(), flags=re.MULTILINE), f"{file}: no {name}"
