"""What is missing is found by asking the linker; package names are those of Debian."""

import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from render_jobs import system_libraries

LISTING = """\
\tlinux-vdso.so.1 (0x00007ffc4b5f2000)
\tlibX11.so.6 => not found
\tlibXi.so.6 => not found
\tlibtbb.so.12 => /venv/bpy/./lib/libtbb.so.12 (0x00007f0000000000)
\tlibX11.so.6 => not found
\tlibstrange.so.3 => not found
"""


def test_the_listing_of_the_linker_is_read() -> None:
    assert system_libraries.parse_not_found(LISTING) == ["libX11.so.6", "libXi.so.6", "libstrange.so.3"]


def test_packages_are_debians_and_unknown_objects_keep_their_name() -> None:
    names = system_libraries.packages_for(["libX11.so.6", "libGL.so.1", "libGL.so.1", "libstrange.so.3"])
    assert names == ["libgl1", "libstrange.so.3", "libx11-6"]


def test_every_library_that_is_looked_for_has_a_package() -> None:
    wanted = {*system_libraries.BLENDER_LIBRARIES, *system_libraries.OPENGL_LIBRARIES}
    assert wanted <= system_libraries.PACKAGES.keys()


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux lacks libraries")
def test_before_blender_is_installed_the_known_ones_are_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: None)
    monkeypatch.setattr(system_libraries, "BLENDER_LIBRARIES", ("libc.so.6", "libnothere.so.1"))
    assert system_libraries.missing_for_blender() == ["libnothere.so.1"]


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux lacks libraries")
def test_the_installed_module_itself_is_asked(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    ldd = tmp_path / "ldd"
    ldd.write_text(f"#!/bin/sh\n[ \"$1\" = /venv/bpy.so ] && cat <<'END'\n{LISTING}END\n")
    ldd.chmod(0o755)
    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: SimpleNamespace(origin="/venv/bpy.so"))
    monkeypatch.setattr(shutil, "which", lambda _name: str(ldd))
    assert system_libraries.missing_for_blender() == ["libX11.so.6", "libXi.so.6", "libstrange.so.3"]


@pytest.mark.parametrize(
    ("debian", "expected"),
    [
        (True, "sudo apt-get install --no-install-recommends libegl1 libgl1"),
        (False, "install the packages that hold libEGL.so.1 libGL.so.1 (in Debian: libegl1 libgl1)"),
    ],
)
def test_the_line_fits_the_system(monkeypatch: pytest.MonkeyPatch, debian: bool, expected: str) -> None:
    monkeypatch.setattr(Path, "exists", lambda path: debian and path == Path("/etc/debian_version"))
    assert system_libraries.install_line(["libGL.so.1", "libEGL.so.1"]) == expected


def test_the_script_needs_the_standard_library_alone() -> None:
    """The set-up runs it with a bare Python, and `-P` keeps its neighbours from hiding standard modules."""
    script = system_libraries.__file__
    bare = [sys.executable, "-I", "-S", script]
    for option in ("--required", "--optional"):
        result = subprocess.run([*bare, option], capture_output=True, text=True, check=True)
        assert result.stdout.endswith("\n")
        assert result.stdout.count("\n") == 1
    assert subprocess.run([*bare, "--wrong"], capture_output=True, check=False).returncode == 2


def test_what_blender_lacks_is_not_listed_twice(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(system_libraries, "missing_for_blender", lambda: ["libGL.so.1"])
    monkeypatch.setattr(system_libraries, "missing_for_opengl", lambda: ["libEGL.so.1", "libGL.so.1"])
    assert system_libraries.main(["--required"]) == 0
    assert system_libraries.main(["--optional"]) == 0
    assert capsys.readouterr().out == "libgl1\nlibegl1\n"
