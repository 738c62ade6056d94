"""What this machine can render with, found by trying in children: a missing driver aborts, it does not raise.

``python -m render_jobs.probe NAME`` makes one try and prints what it found as JSON.
"""

from __future__ import annotations

import importlib
import json
import os
import re
import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any

from render_jobs.errors import EngineError, RenderJobError
from render_jobs.processes import child_environment, die_with_parent
from render_jobs.protocol import BY_ITSELF, ENGINES
from render_jobs.remedies import known_failure, non_empty_lines

PROBE_TIMEOUT_S = 120.0

SOFTWARE = re.compile("llvmpipe|softpipe|swrast|Software", re.IGNORECASE)
"""In the names of drivers that draw on the processor."""

UNKNOWN_REMEDY = "run `python -m render_jobs.probe {name}` to see all that it prints"


@dataclass(frozen=True)
class Probe:
    """The outcome of one try.

    Attributes:
        name: what was tried.
        works: whether it can be used.
        found: what there is, or the failure in its own words.
        remedy: a command or a hint, empty where it works.
    """

    name: str
    works: bool
    found: str
    remedy: str = ""


def probe(name: str, timeout: float = PROBE_TIMEOUT_S) -> Probe:
    """Try one thing in a child process.

    Args:
        name: one of :data:`TRIES`.
        timeout: seconds after which the try has failed.
    """
    command = [sys.executable, "-m", "render_jobs.probe", name, str(os.getpid())]
    try:
        child = subprocess.run(
            command, capture_output=True, text=True, timeout=timeout, env=child_environment(), check=False
        )
    except subprocess.TimeoutExpired:
        return Probe(name, False, f"no answer in {timeout:.0f} s", "update or reinstall the graphics driver")
    if child.returncode == 0:
        return Probe(name, True, json.loads(child.stdout.splitlines()[-1]))
    return explain_failure(name, child.stderr + child.stdout, child.returncode)


def explain_failure(name: str, output: str, status: int) -> Probe:
    """Make a failed try's output into one line and a remedy.

    Args:
        name: what was tried.
        output: everything it printed.
        status: its exit status, negative for a signal.
    """
    known = known_failure(output)
    if known is not None:
        return Probe(name, False, *known)
    lines = non_empty_lines(output)
    last = lines[-1] if lines else f"ended with status {status}"
    return Probe(name, False, last, UNKNOWN_REMEDY.format(name=name))


def choose_engine(wanted: str = "auto") -> tuple[str, str]:
    """Settle which engine renders; asks the machine where the answer is not given.

    Args:
        wanted: an engine's name, or ``auto``: Cycles where it runs, else the raster engine.

    Returns:
        the engine's name, and a line for the user where it is not the best there is, else an empty one.

    Raises:
        EngineError: nothing can render here, or not what was asked for; the message holds the remedies.
    """
    if wanted not in ("auto", *ENGINES):
        raise RenderJobError(f"engine {wanted!r} is not one of auto, {', '.join(ENGINES)}")
    failures: list[str] = []
    for name in BY_ITSELF if wanted == "auto" else (wanted,):
        found = probe(name)
        if found.works:
            note = f"Rendering with the {name} engine, as {failures[0]}" if failures else ""
            return name, note
        failures.append(f"{name} cannot run ({found.found}): {found.remedy}")
    raise EngineError("; ".join(failures))


def seek_engine(wanted: str = "auto") -> Future[tuple[str, str]]:
    """Begin :func:`choose_engine` in a thread, and return what will hold its outcome.

    The thread holds up nothing: a process that ends before the answer ends the probe, too.
    """
    sought: Future[tuple[str, str]] = Future()

    def seek() -> None:
        try:
            sought.set_result(choose_engine(wanted))
        except BaseException as error:
            sought.set_exception(error)

    threading.Thread(target=seek, daemon=True, name="seek-engine").start()
    return sought


def _try_cycles() -> str:
    bpy: Any = importlib.import_module("bpy")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    gpu_names = importlib.import_module("render_jobs.blender.cycles").gpu_names
    gpus = [f"{interface} {name}" for interface, names in gpu_names().items() for name in names]
    return f"Blender {bpy.app.version_string}, on " + (", ".join(gpus) or "the CPU alone")


def _try_eevee() -> str:
    """Render a 16×16 image with Workbench, which opens OpenGL as EEVEE does but has no shaders to compile."""
    bpy: Any = importlib.import_module("bpy")
    bpy.ops.wm.read_factory_settings(use_empty=False)
    scene = bpy.context.scene
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.render.resolution_x = scene.render.resolution_y = 16
    bpy.ops.render.render()
    gpu: Any = importlib.import_module("gpu")
    renderer = str(gpu.platform.renderer_get())
    slow = " (no graphics card: Cycles is quicker)" if SOFTWARE.search(renderer) else ""
    return f"EEVEE, on {renderer}{slow}"


def _try_raster() -> str:
    return str(importlib.import_module("render_jobs.raster.context").open_context())


TRIES: dict[str, Callable[[], str]] = {
    "cycles": _try_cycles,
    "raster": _try_raster,
    "eevee": _try_eevee,
}
"""What can be tried: each returns what it found, or raises, or takes the process with it."""


def main(name: str, parent: str) -> None:
    """Make one try in this process."""
    die_with_parent(int(parent))
    found = TRIES[name]()
    sys.stdout.write("\n" + json.dumps(found) + "\n")
    sys.stdout.flush()
    os._exit(0)  # taking Blender down at the interpreter's exit can hang


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else str(os.getppid()))
