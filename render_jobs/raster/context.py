"""An OpenGL context without a display, by pyrender: EGL, or OSMesa if ``PYOPENGL_PLATFORM=osmesa`` is set."""

from __future__ import annotations

import importlib
import os
import traceback
from typing import Any

from render_jobs.errors import EngineError
from render_jobs.probe import explain_failure

_KEPT: list[Any] = []
"""The renderer that owns the context: one a process, as a second one fails on some drivers."""


def open_context(threads: int = 0) -> str:
    """Make a context current in this process, once.

    Args:
        threads: CPU threads for a software driver; 0 leaves it the choice.

    Returns:
        what draws, in the driver's words.

    Raises:
        EngineError: there is no working OpenGL; the message holds the remedy.
    """
    os.environ.setdefault("PYOPENGL_PLATFORM", "egl")
    os.environ.setdefault("PYGLET_HEADLESS", "1")  # pyrender imports its window toolkit, too
    if threads:
        os.environ.setdefault("LP_NUM_THREADS", str(threads))
    try:
        if not _KEPT:
            pyrender: Any = importlib.import_module("pyrender")
            _KEPT.append(pyrender.OffscreenRenderer(16, 16))
        GL: Any = importlib.import_module("OpenGL.GL")
        return str(GL.glGetString(GL.GL_RENDERER).decode())
    except Exception as error:  # the ways in which drivers are missing have no common ancestor
        failure = explain_failure("raster", "".join(traceback.format_exception(error)), 1)
        raise EngineError(f"no OpenGL to draw with ({failure.found}): {failure.remedy}") from error
