"""The set-up scripts on machines that lack this or that, played by stand-ins for apt-get, sudo and python."""

import os
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import pytest

SETUP = Path(__file__).parents[1] / "tools" / "setup"

APT_GET = """\
echo "apt-get $*" >>"$LOG"
case "$*" in *install*) [ ! -e "$STATE/offline" ] || { echo "E: Unable to fetch" >&2; exit 100; } ;; esac
"""
# Knows libnew0 only under its new name, every other package under its old one.
APT_CACHE = '[ "$2" != libnew0 ]'
SUDO = '[ -e "$STATE/sudoer" ] || exit 1; shift; "$@"'
ID = '[ -e "$STATE/root" ] && echo 0 || echo 1000'
# Answers for a Python 3.11: the version check passes, `-m venv` makes a folder with another such Python.
PYTHON = """\
case "$1" in
  -c) case "$2" in *bpy*) [ ! -e "$STATE/blender_broken" ] || { echo "bpy: bad luck" >&2; exit 1; } ;; esac ;;
  -P) [ "$3" != --required ] || cat "$STATE/missing" 2>/dev/null || true ;;
  -m) echo "python $*" >>"$LOG"
      if [ "$2" = venv ]; then rm -rf .venv; mkdir -p .venv/bin; cp "$0" .venv/bin/python; fi ;;
esac
"""


@dataclass
class Machine:
    """A folder with a copy of the scripts, a PATH of stand-ins, and a log of what they were asked to do."""

    root: Path
    tools: Path
    state: Path

    def is_true(self, *facts: str) -> None:
        for fact in facts:
            (self.state / fact).touch()

    def has(self, name: str, script: str) -> None:
        path = self.tools / name
        path.write_text(f"#!/bin/sh\n{script}\n")
        path.chmod(0o755)

    def sh(self, script: str, **environment: str) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            ["/bin/sh", "-euc", f". tools/setup/environment.sh; {script}"],
            cwd=self.root,
            env={
                "PATH": str(self.tools),
                "LOG": str(self.state / "log"),
                "STATE": str(self.state),
                **environment,
            },
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )

    @property
    def log(self) -> list[str]:
        path = self.state / "log"
        return path.read_text().splitlines() if path.exists() else []


@pytest.fixture
def machine(tmp_path: Path) -> Machine:
    """A Debian with Python 3.11 and nobody's password."""
    machine = Machine(tmp_path / "clone", tmp_path / "bin", tmp_path / "state")
    for folder in (machine.tools, machine.state):
        folder.mkdir()
    shutil.copytree(SETUP, machine.root / "tools" / "setup")
    (machine.root / "pyproject.toml").write_text("[project]\n")
    (machine.root / "constraints.txt").write_text("numpy==1.26.4\n")
    for name in ("cat", "cksum", "cp", "env", "mkdir", "rm"):
        (machine.tools / name).symlink_to(shutil.which(name) or name)
    for name, script in (("apt-get", APT_GET), ("apt-cache", APT_CACHE), ("sudo", SUDO), ("id", ID)):
        machine.has(name, script)
    machine.has("python3.11", PYTHON)
    return machine


def test_without_rights_the_exact_line_is_printed_and_nothing_runs(machine: Machine) -> None:
    result = machine.sh("need_packages 'It is missing.' liba1 libb2")
    assert result.returncode == 1
    assert "\n    sudo apt-get install --no-install-recommends liba1 libb2\n" in result.stderr
    assert machine.log == []


@pytest.mark.parametrize("rights", ["root", "sudoer"])
def test_with_rights_it_installs(machine: Machine, rights: str) -> None:
    machine.is_true(rights)
    result = machine.sh("need_packages 'It is missing.' liba1 libb2")
    assert result.returncode == 0, result.stderr
    assert machine.log == [
        "apt-get update -qq",
        "apt-get install -y -qq --no-install-recommends liba1 libb2",
    ]


def test_a_renamed_library_is_found_under_its_new_name(machine: Machine) -> None:
    machine.is_true("root")
    machine.sh("need_packages 'It is missing.' liba1 libnew0")
    assert machine.log[-1].endswith(" liba1 libnew0t64")


def test_offline_it_prints_the_line_after_what_apt_said(machine: Machine) -> None:
    machine.is_true("root", "offline")
    result = machine.sh("need_packages 'It is missing.' liba1")
    assert result.returncode == 1
    assert "E: Unable to fetch" in result.stderr
    assert "\n    apt-get install --no-install-recommends liba1\n" in result.stderr


def test_apt_can_be_forbidden(machine: Machine) -> None:
    machine.is_true("root")
    assert machine.sh("need_packages 'It is missing.' liba1", WHACAMOLE_NO_APT="1").returncode == 1
    assert machine.log == []


def test_a_system_without_apt_is_told_the_names(machine: Machine) -> None:
    (machine.tools / "apt-get").unlink()
    result = machine.sh("need_packages 'It is missing.' liba1")
    assert result.returncode == 1
    assert "liba1" in result.stderr
    assert "apt-get install" not in result.stderr


def test_no_python_says_how_to_get_one(machine: Machine) -> None:
    (machine.tools / "python3.11").unlink()
    result = machine.sh("prepare ''")
    assert result.returncode == 1
    assert "no Python 3.11 found" in result.stderr
    assert "PYTHON=/path/to/python3.11" in result.stderr


def test_a_wrong_python_is_not_used(machine: Machine) -> None:
    machine.has("python3.9", "exit 1")
    result = machine.sh("prepare ''", PYTHON="python3.9")
    assert result.returncode == 1
    assert "PYTHON=python3.9 is not a Python 3.11" in result.stderr


def test_the_python_may_have_any_name(machine: Machine) -> None:
    (machine.tools / "python3.11").rename(machine.tools / "snake")
    assert machine.sh("prepare ''", PYTHON="snake").returncode == 0


def test_prepare_works_once_and_is_quiet_afterwards(machine: Machine) -> None:
    first = machine.sh("prepare test")
    assert first.returncode == 0, first.stderr
    assert [line.split()[2] for line in machine.log] == ["venv", "pip"]
    assert machine.log[1].endswith("--constraint constraints.txt --editable .[test]")
    again = machine.sh("prepare test")
    assert (again.returncode, again.stderr) == (0, "")
    assert len(machine.log) == 2


def _new_versions(machine: Machine) -> None:
    (machine.root / "constraints.txt").write_text("numpy==1.26.5\n")


def _moved(machine: Machine) -> None:
    machine.root = machine.root.rename(machine.root.with_name("elsewhere"))


@pytest.mark.parametrize(("change", "expected"), [(_new_versions, ["pip"]), (_moved, ["venv", "pip"])])
def test_what_changed_is_done_again(
    machine: Machine, change: Callable[[Machine], None], expected: list[str]
) -> None:
    machine.sh("prepare ''")
    change(machine)
    before = len(machine.log)
    assert machine.sh("prepare ''").returncode == 0
    assert [line.split()[2] for line in machine.log[before:]] == expected


def test_missing_libraries_stop_before_the_download(machine: Machine) -> None:
    (machine.state / "missing").write_text("libx11-6 libxi6\n")
    result = machine.sh("prepare ''")
    assert result.returncode == 1
    assert "sudo apt-get install --no-install-recommends libx11-6 libxi6" in result.stderr
    assert machine.log == []


def test_a_blender_that_does_not_load_is_not_remembered_as_good(machine: Machine) -> None:
    machine.is_true("blender_broken")
    for _ in range(2):
        result = machine.sh("prepare ''")
        assert result.returncode == 1
        assert "bpy: bad luck" in result.stderr
        assert "docs/troubleshooting.md" in result.stderr


def test_an_unknown_task_lists_those_there_are() -> None:
    result = subprocess.run(
        ["/bin/sh", str(SETUP / "task.sh"), "dmeo"],
        env={"PATH": os.defpath},
        capture_output=True,
        text=True,
        check=False,
    )
    assert result.returncode == 1
    assert "make demo" in result.stderr
    assert "there is no task 'dmeo'" in result.stderr
