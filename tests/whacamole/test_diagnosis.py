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


@pytest.mark.parametrize(
    ("fault", "look", "remedy"),
    [
        (_has_numpy_2, diagnosis._numpy, 'pip install "numpy>=1.26,<2"'),
        (_has_python_312, diagnosis._python, "use Python 3.11"),
        (_is_arm, diagnosis._platform, "x86_64"),
        (_is_old, diagnosis._platform, "glibc 2.28"),
        (_lacks_scipy, diagnosis._packages, "pip install scipy"),
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


@pytest.mark.parametrize(
    ("search", "look", "missing", "package"),
    [
        ("missing_for_blender", diagnosis._blender_libraries, "libX11.so.6", "libx11-6"),
        ("missing_for_opengl", diagnosis._opengl_libraries, "libEGL.so.1", "libegl1"),
    ],
)
def test_missing_libraries_are_named_with_their_packages(
    search: str, look: Callable[[], Check], missing: str, package: str, monkeypatch: Patch
) -> None:
    monkeypatch.setattr(system_libraries, search, lambda: [missing])
    check = look()
    assert check.state == "warning"
    assert missing in check.found
    assert package in check.remedy


@pytest.mark.parametrize(
    ("broken", "states"),
    [
        ((), {"cycles": "ok", "raster": "ok", "eevee": "ok"}),
        (("eevee",), {"cycles": "ok", "raster": "ok", "eevee": "warning"}),
        (("cycles", "eevee"), {"cycles": "warning", "raster": "ok", "eevee": "warning"}),
        (("cycles", "raster"), {"cycles": "error", "raster": "error", "eevee": "ok"}),
    ],
)
def test_one_engine_that_can_render_is_enough(
    broken: tuple[str, ...], states: dict[str, str], monkeypatch: Patch
) -> None:
    monkeypatch.setattr(
        diagnosis, "probe", lambda name: Probe(name, name not in broken, "seen", "mend it" * (name in broken))
    )
    checks = diagnosis._engines()
    assert {check.name: check.state for check in checks} == states
    assert {check.name for check in checks if check.remedy == "mend it"} == set(broken)


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
