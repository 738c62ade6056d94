"""Every numbered example runs on a small dataset and is listed in examples/README.md."""

import subprocess
import sys
from pathlib import Path

import pytest

import tiny_dataset

ROOT = Path(__file__).parents[1]
EXAMPLES = sorted((ROOT / "examples").glob("[0-9][0-9]_*.py"))


@pytest.fixture(scope="module")
def dataset(tmp_path_factory: pytest.TempPathFactory) -> Path:
    root = tmp_path_factory.mktemp("examples") / "dataset"
    tiny_dataset.write_dataset(root)
    return root


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_it_runs_and_says_something(example: Path, dataset: Path) -> None:
    run = subprocess.run(
        [sys.executable, "-W", "error", str(example), str(dataset)],
        cwd=ROOT,
        env={"PYTHONPATH": str(ROOT), "PATH": ""},
        capture_output=True,
        text=True,
        check=False,
        timeout=500,
    )
    assert run.returncode == 0, run.stderr
    assert run.stdout.strip()


def test_they_are_numbered_and_listed() -> None:
    assert [path.name[:2] for path in EXAMPLES] == [f"{number:02d}" for number in range(1, len(EXAMPLES) + 1)]
    listed = (ROOT / "examples" / "README.md").read_text()
    assert all(f"`{path.name}`" in listed for path in EXAMPLES)
