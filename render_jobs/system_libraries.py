"""The shared libraries that the renderers load from the operating system, and the packages that hold them.

The wheels of Blender's module (``bpy``) and of OpenGL bring most of what they need; a server or a container
lacks the rest. What is missing is found by asking the dynamic linker, not guessed from the system's name.

Run as a script, ``--required`` prints the Debian packages that are missing for Blender's module and
``--optional`` what the OpenGL engines lack beside them, on one line, which is empty where all is there. The
set-up runs it before anything is installed: this file imports the standard library alone.
"""

import ctypes
import importlib.util
import shutil
import subprocess
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from types import MappingProxyType

PACKAGES: Mapping[str, str] = MappingProxyType(
    {
        "libEGL.so.1": "libegl1",
        "libGL.so.1": "libgl1",
        "libICE.so.6": "libice6",
        "libSM.so.6": "libsm6",
        "libOSMesa.so.8": "libosmesa6",
        "libX11.so.6": "libx11-6",
        "libXext.so.6": "libxext6",
        "libXfixes.so.3": "libxfixes3",
        "libXi.so.6": "libxi6",
        "libXrender.so.1": "libxrender1",
        "libgcc_s.so.1": "libgcc-s1",
        "libgomp.so.1": "libgomp1",
        "libstdc++.so.6": "libstdc++6",
        "libxkbcommon.so.0": "libxkbcommon0",
    }
)
"""Shared-object name to the Debian and Ubuntu package that holds it."""

BLENDER_LIBRARIES = (
    "libGL.so.1",
    "libSM.so.6",
    "libX11.so.6",
    "libXfixes.so.3",
    "libXi.so.6",
    "libXrender.so.1",
    "libxkbcommon.so.0",
)
"""What Blender's module links to and bare systems lack: tried where the module itself cannot be asked."""

OPENGL_LIBRARIES = ("libEGL.so.1", "libGL.so.1")
"""What EEVEE, Workbench and the raster engine open at run time."""


def missing_for_blender() -> list[str]:
    """Names of the shared objects that Blender's module links to and the system does not have.

    The dynamic linker's own list for the installed module; before it is installed, or without ``ldd``, the
    known ones that do not open. Empty on other systems than Linux, where the wheel brings all it needs.
    """
    if not sys.platform.startswith("linux"):
        return []
    spec = importlib.util.find_spec("bpy")
    ldd = shutil.which("ldd")
    if spec is None or spec.origin is None or ldd is None:
        return [name for name in BLENDER_LIBRARIES if not opens(name)]
    listing = subprocess.run([ldd, spec.origin], capture_output=True, text=True, check=False).stdout
    return parse_not_found(listing)


def parse_not_found(listing: str) -> list[str]:
    """The names that a listing of ``ldd`` reports as not found, sorted, each once."""
    return sorted(
        {line.split()[0] for line in listing.splitlines() if line.rstrip().endswith("=> not found")}
    )


def missing_for_opengl() -> list[str]:
    """Names of the shared objects that the OpenGL engines open and the system does not have."""
    if not sys.platform.startswith("linux"):
        return []
    return [name for name in OPENGL_LIBRARIES if not opens(name)]


def opens(name: str) -> bool:
    """Whether the dynamic linker finds a shared object of this name."""
    try:
        ctypes.CDLL(name)
    except OSError:
        return False
    return True


def packages_for(names: Iterable[str]) -> list[str]:
    """Debian packages that hold these shared objects, sorted; an unknown object stands under its own name."""
    return sorted({PACKAGES.get(name, name) for name in names})


def install_line(names: Iterable[str]) -> str:
    """The line that brings these shared objects to this system, or their names where it is no Debian."""
    wanted = " ".join(packages_for(names))
    if Path("/etc/debian_version").exists():
        return f"sudo apt-get install --no-install-recommends {wanted}"
    return f"install the packages that hold {' '.join(sorted(names))} (in Debian: {wanted})"


def main(arguments: list[str]) -> int:
    """Print what is missing; returns the exit status."""
    if arguments == ["--required"]:
        names = missing_for_blender()
    elif arguments == ["--optional"]:
        names = sorted(set(missing_for_opengl()) - set(missing_for_blender()))
    else:
        sys.stderr.write("usage: python system_libraries.py --required|--optional\n")
        return 2
    sys.stdout.write(" ".join(packages_for(names)) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
