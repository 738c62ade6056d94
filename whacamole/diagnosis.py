"""What this machine can do, found by trying, and what to do where it cannot."""

import importlib.metadata
import os
import platform
import re
import shutil
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal

import psutil

from render_jobs import system_libraries
from render_jobs.probe import TRIES, Probe, probe
from render_jobs.protocol import BY_ITSELF

__all__ = ["Check", "can_render", "diagnose", "report_as_dict"]

MIN_FREE_MEMORY = 2 * 2**30
"""One render job takes about 1 GiB, the parent another half; below this a run may be killed. Bytes."""

MIN_FREE_DISK = 2 * 2**30
"""A 640x360 sequence of 240 frames with RGB, mask and depth takes some 0.2 GiB. Bytes."""

_CONSTRAINED = 'pip install --constraint constraints.txt "whacamole"'


@dataclass(frozen=True)
class Check:
    """One thing that was looked at.

    Attributes:
        name: what was looked at.
        state: ``ok``; ``warning`` where something optional is missing; ``error`` where nothing can render.
        found: what there is.
        remedy: what to do about it, empty where nothing needs doing.
    """

    name: str
    state: Literal["ok", "warning", "error"]
    found: str
    remedy: str = ""


def diagnose(folder: Path) -> list[Check]:
    """Look at everything a render needs; starts child processes for what may abort, and takes some seconds.

    Args:
        folder: where datasets would be written; its disk is looked at.
    """
    return [
        _python(),
        _platform(),
        _numpy(),
        _packages(),
        _blender_libraries(),
        _opengl_libraries(),
        *_engines(),
        _cores(),
        _memory(),
        _disk(folder),
    ]


def report_as_dict(checks: list[Check]) -> dict[str, Any]:
    """The checks as plain values: ``can_render`` and one entry a check."""
    return {"can_render": can_render(checks), "checks": [asdict(check) for check in checks]}


def can_render(checks: list[Check]) -> bool:
    """True where nothing that the main job needs is missing."""
    return all(check.state != "error" for check in checks)


def _python() -> Check:
    found = f"{platform.python_version()} ({sys.executable})"
    if platform.python_version_tuple()[:2] == ("3", "11"):
        return Check("python", "ok", found)
    return Check(
        "python", "error", found, "use Python 3.11: Blender's module is built for that version alone"
    )


def _platform() -> Check:
    system, machine = platform.system(), platform.machine()
    libc, version = platform.libc_ver()
    found = " ".join(filter(None, (system, machine, libc, version)))
    if system != "Linux":
        return Check("platform", "warning", found, "only Linux is tested")
    if machine != "x86_64":
        return Check("platform", "error", found, "Blender's module has Linux wheels for x86_64 alone")
    if libc == "glibc" and tuple(map(int, version.split(".")[:2])) < (2, 28):
        return Check("platform", "error", found, "Blender's module needs glibc 2.28: Debian 10, Ubuntu 20.04")
    return Check("platform", "ok", found)


def _version(package: str) -> str | None:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


def _numpy() -> Check:
    version = _version("numpy")
    if version is None:
        return Check("numpy", "error", "not installed", _CONSTRAINED)
    if int(version.split(".")[0]) >= 2:
        remedy = 'pip install "numpy>=1.26,<2": Blender\'s module for Python 3.11 needs NumPy 1'
        return Check("numpy", "error", version, remedy)
    return Check("numpy", "ok", version)


def _requirements() -> Iterator[str]:
    """Names of the packages that the core needs, as the installed metadata states them."""
    for line in importlib.metadata.requires("whacamole") or []:
        name = re.match(r"[A-Za-z0-9._-]+", line)
        if name and "extra ==" not in line:
            yield name[0]


def _packages() -> Check:
    try:
        versions = {name: _version(name) for name in _requirements()}
    except importlib.metadata.PackageNotFoundError:
        return Check("packages", "warning", "whacamole runs from a folder, not installed", "make setup")
    missing = sorted(name for name, version in versions.items() if version is None)
    if missing:
        return Check(
            "packages", "error", f"missing: {', '.join(missing)}", f"pip install {' '.join(missing)}"
        )
    return Check("packages", "ok", ", ".join(f"{name} {version}" for name, version in versions.items()))


def _blender_libraries() -> Check:
    """What is missing here, the engines below feel: they say whether anything can render."""
    missing = system_libraries.missing_for_blender()
    if not missing:
        return Check("system libraries", "ok", "all that Blender's module links to")
    remedy = system_libraries.install_line(missing)
    return Check("system libraries", "warning", f"missing: {', '.join(missing)}", remedy)


def _opengl_libraries() -> Check:
    missing = system_libraries.missing_for_opengl()
    if not missing:
        return Check("OpenGL libraries", "ok", ", ".join(system_libraries.OPENGL_LIBRARIES))
    remedy = system_libraries.install_line(missing)
    return Check("OpenGL libraries", "warning", f"missing: {', '.join(missing)}", remedy)


def _engines() -> list[Check]:
    """One check an engine, all tried at the same time, each in a process of its own.

    One that fails is a warning while another can render the job, else an error.
    """
    with ThreadPoolExecutor(len(TRIES)) as pool:
        outcomes = list(pool.map(probe, TRIES))
    can_render = any(outcome.works for outcome in outcomes if outcome.name in BY_ITSELF)
    return [_engine(outcome, needed=outcome.name in BY_ITSELF and not can_render) for outcome in outcomes]


def _engine(outcome: Probe, *, needed: bool) -> Check:
    if outcome.works:
        return Check(outcome.name, "ok", outcome.found)
    return Check(outcome.name, "error" if needed else "warning", outcome.found, outcome.remedy)


def _cores() -> Check:
    usable = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    return Check("processor", "ok", f"{usable} of {os.cpu_count()} cores usable")


def _memory() -> Check:
    memory = psutil.virtual_memory()
    found = f"{_gib(memory.available)} free of {_gib(memory.total)}"
    if memory.available < MIN_FREE_MEMORY:
        return Check("memory", "warning", found, "close other programs; keep --jobs 1 and the size small")
    return Check("memory", "ok", found)


def _disk(folder: Path) -> Check:
    existing = next(path for path in (folder.absolute(), *folder.absolute().parents) if path.exists())
    usage = shutil.disk_usage(existing)
    found = f"{_gib(usage.free)} free of {_gib(usage.total)} at {existing}"
    if not os.access(existing, os.W_OK):
        return Check("disk", "warning", f"{found}, not writable", "name a folder you may write to with --out")
    if usage.free < MIN_FREE_DISK:
        return Check("disk", "warning", found, "free some, or name a folder on another disk with --out")
    return Check("disk", "ok", found)


def _gib(size: float) -> str:
    return f"{size / 2**30:.1f} GiB"
