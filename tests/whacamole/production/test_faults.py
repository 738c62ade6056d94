"""Forty sequences, and everything that can go wrong: all of them get made, each once, none of them different.

The pixels come from a stand-in (tests/farm_stand_in.py); all else is the product.
"""

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from render_jobs.processes import child_environment
from tiny_dataset import write_dataset
from whacamole.dataset import DatasetLayout
from whacamole.production.place import attempts_so_far
from whacamole.production.status import status_of
from whacamole.production.worklist import work_of

pytestmark = pytest.mark.slow

TESTS = Path(__file__).resolve().parents[2]
SEQUENCES = 40
ENDS = {  # what a fault becomes in the record of attempts
    "abort": "SIGABRT",
    "kill": "SIGKILL",
    "hang": "nothing was finished in",
    "hunger": "over the limit of 600 MB",
}
DEADLINE_S = 500.0


class Home:
    """The folder of the stand-in, and how to run the farm with it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.faults = folder / "faults"
        self.faults.mkdir(parents=True)
        self.runs: list[subprocess.Popen[str]] = []
        tiny = write_dataset(folder / "tiny")
        shutil.copytree(tiny.sequence("walk-00").folder, folder / "template")

    def end(self) -> None:
        for run in self.runs:
            run.kill()
            run.communicate()

    def start(self, out: Path, *arguments: object, sequences: int = SEQUENCES) -> subprocess.Popen[str]:
        environment = child_environment() | {"STAND_IN": str(self.folder)}
        run = subprocess.Popen(
            [sys.executable, TESTS / "farm_driver.py", str(out), str(sequences), *map(str, arguments)],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment,
        )  # fmt: skip
        self.runs.append(run)
        return run

    def made(self) -> Counter[str]:
        log = self.folder / "made.log"
        return Counter(log.read_text(encoding="utf-8").split() if log.exists() else [])

    def note_moved(self, out: Path) -> None:
        """Write down what a killed run had moved into the dataset and not yet written down."""
        moved = {folder.name for folder in (out / "sequences").iterdir()} - set(self.made())
        with (self.folder / "made.log").open("a", encoding="utf-8") as log:
            log.writelines(f"{name}\n" for name in sorted(moved))

    def plant(self, names: list[str]) -> dict[str, str]:
        """Order a fault of each kind, for sequences spread over the run; return which got which."""
        kinds = [*ENDS, "abort", "kill"]
        planted = dict(zip(names[3::6], kinds, strict=False))
        for name, kind in planted.items():
            (self.faults / f"{name}.{kind}").touch()
        return planted


@pytest.fixture
def home(tmp_path: Path) -> Iterator[Home]:
    home = Home(tmp_path / "home")
    yield home
    home.end()


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """What comes out where nothing goes wrong, one sequence after the other in one process."""
    folder = tmp_path_factory.mktemp("undisturbed")
    home = Home(folder / "home")
    run = home.start(folder / "data", "undisturbed")
    _, errors = run.communicate(timeout=DEADLINE_S)
    assert run.returncode == 0, errors
    home.end()
    assert sorted(home.made().values()) == [1] * SEQUENCES
    assert not any((folder / "data" / ".work").iterdir())
    return contents(folder / "data")


@pytest.fixture
def cluster(home: Home) -> Iterator[str]:
    """The address of a scheduler with four worker processes, each restarted when it dies."""
    process = subprocess.Popen(
        [sys.executable, TESTS / "farm_cluster.py"],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
        env=child_environment() | {"STAND_IN": str(home.folder)},
    )  # fmt: skip
    assert process.stdout is not None
    yield process.stdout.readline().strip()
    process.communicate("", timeout=60)


def contents(out: Path) -> dict[str, bytes]:
    """Every file of a dataset."""
    files = (path for path in sorted(out.rglob("*")) if path.is_file())
    kept = {path.relative_to(out).as_posix(): path.read_bytes() for path in files}
    return {name: content for name, content in kept.items() if not name.startswith(".work/")}


def names_of(out: Path) -> list[str]:
    from farm_driver import recipe

    return [order.sequence_id for order in work_of(recipe(SEQUENCES), out).orders]


def wait_for(condition: object, what: str) -> None:
    deadline = time.monotonic() + DEADLINE_S
    while not condition():  # type: ignore[operator]
        assert time.monotonic() < deadline, what
        time.sleep(0.1)


def orphans(folder: Path) -> list[list[str]]:
    """Processes that still work on something in the folder."""
    found = []
    for process in psutil.process_iter(["cmdline"]):
        words = process.info["cmdline"] or []
        if any(word.startswith(str(folder)) and word.endswith("order.json") for word in words):
            found.append(words)
    return found


def check_result(home: Home, out: Path, undisturbed: dict[str, bytes], planted: dict[str, str]) -> None:
    assert home.made() == dict.fromkeys(names_of(out), 1)
    assert contents(out) == undisturbed
    for name, kind in planted.items():
        kept = DatasetLayout(out).logs / name
        errors = " ".join(attempt["error"] for attempt in attempts_so_far(kept))
        assert ENDS[kind] in errors, (name, kind, errors)
        assert (kept / "worker.log").exists()
    assert not list(home.faults.iterdir())
    wait_for(lambda: not orphans(out), "a process outlived its run")
    state = status_of(out)
    assert (state.finished, state.asked, state.begun, state.failed) == (SEQUENCES, SEQUENCES, {}, {})


def test_on_one_machine(home: Home, undisturbed: dict[str, bytes], tmp_path: Path) -> None:
    out = tmp_path / "data"
    planted = home.plant(names_of(out))
    first = home.start(out)
    wait_for(lambda: len(home.made()) >= 5, "nothing was made")
    first.kill()  # the parent, as the kernel or a batch system would; its children must go with it
    first.communicate()
    wait_for(lambda: not orphans(out), "a child outlived its parent")
    home.note_moved(out)
    before = len(home.made())
    assert before < SEQUENCES
    (home.faults / "disk-full").touch()
    second = home.start(out)
    wait_for((home.folder / "met-disk-full").exists, "nobody met the full disk")
    assert len(home.made()) == before
    (home.faults / "disk-full").unlink()  # somebody made room
    _, errors = second.communicate(timeout=DEADLINE_S)
    assert second.returncode == 0, errors
    assert "the disk is full" in errors
    check_result(home, out, undisturbed, planted)


def test_on_a_dask_cluster_then_on_anything(
    home: Home, cluster: str, undisturbed: dict[str, bytes], tmp_path: Path
) -> None:
    out = tmp_path / "data"
    names = names_of(out)
    planted = home.plant(names)
    for name in names[5::10]:  # the fault takes the Dask worker with it, and what it was making
        (home.faults / f"{name}.kill-parent").touch()
    first = home.start(out, cluster)
    wait_for(lambda: len(home.made()) >= 8, "nothing was made")
    first.send_signal(signal.SIGKILL)
    first.communicate()
    (home.faults / "disk-full").touch()
    runs = [home.start(out, cluster), home.start(out, "", "1/2"), home.start(out, "", "2/2"), home.start(out)]
    wait_for((home.folder / "met-disk-full").exists, "nobody met the full disk")
    (home.faults / "disk-full").unlink()
    for run in runs:
        _, errors = run.communicate(timeout=DEADLINE_S)
        assert run.returncode == 0, errors
    check_result(home, out, undisturbed, planted)


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A file system of 256 MB, room for four at a time."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=256m", "tmpfs", str(folder)]
    if subprocess.run(mount, check=False, capture_output=True).returncode:
        pytest.skip("may not mount a tmpfs here")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


def test_a_disk_that_fills_up_while_the_run_goes_on(home: Home, small_disk: Path, tmp_path: Path) -> None:
    names = names_of(small_disk / "data")[:8]
    for name in names[1:]:
        (home.faults / f"{name}.hold").touch()
    run = home.start(small_disk / "data", sequences=8)
    wait_for(lambda: len(home.made()) >= 1, "nothing was made")
    with contextlib.suppress(OSError), (small_disk / "ballast").open("wb") as ballast:
        while True:
            ballast.write(bytes(2**16))
    assert shutil.disk_usage(small_disk).free < 2**17
    (home.folder / "go").touch()
    wait_for(lambda: not orphans(small_disk), "somebody works on a full disk")
    assert len(home.made()) == 1
    (small_disk / "ballast").unlink()
    _, errors = run.communicate(timeout=DEADLINE_S)
    assert run.returncode == 0, errors
    assert "the disk is full" in errors
    assert home.made() == dict.fromkeys(names, 1)


def test_a_disk_that_stays_full_ends_the_run_with_one_line(home: Home, tmp_path: Path) -> None:
    (home.faults / "disk-full").touch()
    os.environ["PATIENCE"] = "1"
    try:
        run = home.start(tmp_path / "data", sequences=2)
    finally:
        del os.environ["PATIENCE"]
    _, errors = run.communicate(timeout=DEADLINE_S)
    assert run.returncode == 1
    assert "Traceback" not in errors
    lines = [line for line in errors.splitlines() if line.startswith("failed: ")]
    assert len(lines) == 2
    assert all("the disk is full; make room" in line for line in lines)
