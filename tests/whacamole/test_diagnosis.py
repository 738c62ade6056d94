"""What `doctor` says of machines that lack one thing each."""

import importlib.metadata
import json
import os
import platform
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import psutil
import pytest
from typer.testing import CliRunner

from render_jobs import system_libraries
from render_jobs.probe import Probe
from whacamole import diagnosis
from whacamole.cli import app
from whacamole.diagnosis import Check, can_render, report_as_dict

Patch = pytest.MonkeyPatch


def _has_numpy_2(patch: Patch) -> None:
    real = importlib.metadata.version
    patch.setattr(importlib.metadata, "version", lambda name: "2.4.6" if name == "numpy" else real(name))


def _has_python_312(patch: Patch) -> None:
    patch.setattr(platform, "python_version_tuple", lambda: ("3", "12", "1"))


def _is_arm(patch: Patch) -> None:
    patch.setattr(platform, "system", lambda: "Linux")
    patch.setattr(platform, "machine", lambda: "aarch64")


def _is_old(patch: Patch) -> None:
    patch.setattr(platform, "system", lambda: "Linux")
    patch.setattr(platform, "machine", lambda: "x86_64")
    patch.setattr(platform, "libc_ver", lambda: ("glibc", "2.17"))


def _lacks_scipy(patch: Patch) -> None:
    def version(name: str) -> str:
        if name == "scipy":
            raise importlib.metadata.PackageNotFoundError(name)
        return "1.0"

    patch.setattr(importlib.metadata, "requires", lambda _name: ["scipy>=1.11", 'torch>=2; extra == "train"'])
    patch.setattr(importlib.metadata, "version", version)


def _lacks_x11(patch: Patch) -> None:
    patch.setattr(system_libraries, "missing_for_blender", lambda: ["libX11.so.6"])


@pytest.mark.parametrize(
    ("fault", "look", "remedy"),
    [
        (_has_numpy_2, diagnosis._numpy, 'pip install "numpy>=1.26,<2"'),
        (_has_python_312, diagnosis._python, "use Python 3.11"),
        (_is_arm, diagnosis._platform, "x86_64"),
        (_is_old, diagnosis._platform, "glibc 2.28"),
        (_lacks_scipy, diagnosis._packages, "pip install scipy"),
        (_lacks_x11, diagnosis._blender_libraries, "libx11-6"),
    ],
)
def test_what_keeps_a_machine_from_rendering_is_an_error_with_a_remedy(
    fault: Callable[[Patch], None], look: Callable[[], Check], remedy: str, monkeypatch: Patch
) -> None:
    fault(monkeypatch)
    check = look()
    assert check.state == "error"
    assert remedy in check.remedy
    assert not can_render([check])


def test_missing_opengl_is_a_warning(monkeypatch: Patch) -> None:
    monkeypatch.setattr(system_libraries, "missing_for_opengl", lambda: ["libEGL.so.1"])
    check = diagnosis._opengl_libraries()
    assert check.state == "warning"
    assert "libegl1" in check.remedy
    assert can_render([check])


@pytest.mark.parametrize(("engine", "state"), [("cycles", "error"), ("workbench", "warning")])
def test_only_the_main_engine_is_needed(engine: str, state: str, monkeypatch: Patch) -> None:
    monkeypatch.setattr(diagnosis, "probe", lambda name: Probe(name, name != engine, "seen", "mend it"))
    checks = {check.name: check for check in diagnosis._engines()}
    assert (checks[engine].state, checks[engine].remedy) == (state, "mend it")
    assert {check.state for name, check in checks.items() if name != engine} == {"ok"}


@pytest.mark.blender
@pytest.mark.slow
def test_this_machine_is_looked_at_whole(tmp_path: Path) -> None:
    checks = diagnosis.diagnose(tmp_path)
    assert len({check.name for check in checks}) == len(checks)
    assert all(check.found for check in checks)
    assert all(bool(check.remedy) == (check.state != "ok") for check in checks)


def test_little_memory_is_a_warning(monkeypatch: Patch) -> None:
    memory = SimpleNamespace(available=2**30, total=4 * 2**30)
    monkeypatch.setattr(psutil, "virtual_memory", lambda: memory)
    check = diagnosis._memory()
    assert (check.state, check.found) == ("warning", "1.0 GiB free of 4.0 GiB")


def test_the_disk_of_a_folder_that_is_yet_to_be_made_is_looked_at(tmp_path: Path) -> None:
    check = diagnosis._disk(tmp_path / "not" / "yet" / "there")
    assert check.found.endswith(f" at {tmp_path}")


def test_a_full_disk_is_a_warning(monkeypatch: Patch, tmp_path: Path) -> None:
    usage = SimpleNamespace(total=100 * 2**30, free=2**30)
    monkeypatch.setattr(shutil, "disk_usage", lambda _path: usage)
    assert diagnosis._disk(tmp_path).state == "warning"


def test_a_folder_nobody_may_write_to_is_a_warning(monkeypatch: Patch, tmp_path: Path) -> None:
    monkeypatch.setattr(os, "access", lambda _path, _mode: False)
    check = diagnosis._disk(tmp_path)
    assert check.state == "warning"
    assert "not writable" in check.found


def test_the_report_holds_plain_values() -> None:
    checks = [Check("a", "ok", "fine"), Check("b", "error", "broken", "mend it")]
    assert report_as_dict(checks) == {
        "can_render": False,
        "checks": [
            {"name": "a", "state": "ok", "found": "fine", "remedy": ""},
            {"name": "b", "state": "error", "found": "broken", "remedy": "mend it"},
        ],
    }


# --- The command -----------------------------------------------------------------------------------------


def _doctor(patch: Patch, checks: list[Check], *options: str) -> Any:
    patch.setattr(diagnosis, "diagnose", lambda _folder: checks)
    return CliRunner().invoke(app, ["doctor", *options])


FINE = Check("python", "ok", "3.11.7")
BROKEN = Check("cycles", "error", "libX11.so.6: [cannot] open", "sudo apt-get install libx11-6")


def test_the_command_says_that_all_is_well(monkeypatch: Patch) -> None:
    result = _doctor(monkeypatch, [FINE])
    assert result.exit_code == 0
    assert "3.11.7" in result.output
    assert "This machine can render." in result.output


def test_the_command_ends_with_the_remedies(monkeypatch: Patch) -> None:
    result = _doctor(monkeypatch, [FINE, BROKEN])
    assert result.exit_code == 1
    assert "libX11.so.6: [cannot] open" in result.output
    assert result.output.endswith("cycles: sudo apt-get install libx11-6\nThis machine cannot render yet.\n")


def test_the_command_speaks_json(monkeypatch: Patch) -> None:
    result = _doctor(monkeypatch, [FINE, BROKEN], "--json")
    assert result.exit_code == 1
    assert json.loads(result.output) == report_as_dict([FINE, BROKEN])


def test_the_command_can_be_quiet(monkeypatch: Patch) -> None:
    result = _doctor(monkeypatch, [BROKEN], "--quiet")
    assert (result.exit_code, result.output) == (1, "")


def test_without_a_package_it_is_still_one_line(monkeypatch: Patch) -> None:
    monkeypatch.setitem(sys.modules, "whacamole.diagnosis", None)
    result = CliRunner().invoke(app, ["doctor"])
    assert result.exit_code == 1
    assert result.output.count("\n") == 1
    assert "pip install --constraint constraints.txt" in result.output
