"""An OpenGL context without a display: by pyrender and EGL, or, where there is no EGL, by OSMesa.

``PYOPENGL_PLATFORM`` set to ``egl`` or ``osmesa`` insists on one of them.
"""

from __future__ import annotations

import ctypes
import importlib
import os
import traceback
from typing import Any

from render_jobs.errors import EngineError
from render_jobs.probe import explain_failure
from render_jobs.system_libraries import opens

OSMESA_LIBRARIES = ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")

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
    platform = os.environ.setdefault(
        "PYOPENGL_PLATFORM", "egl" if opens("libEGL.so.1") or not osmesa_library() else "osmesa"
    )
    os.environ.setdefault("PYGLET_HEADLESS", "1")  # pyrender imports its window toolkit, too
    if threads:
        os.environ.setdefault("LP_NUM_THREADS", str(threads))
    try:
        if not _KEPT:
            _KEPT.append(OSMesaContext() if platform == "osmesa" else _egl_context())
        GL: Any = importlib.import_module("OpenGL.GL")
        return str(GL.glGetString(GL.GL_RENDERER).decode())
    except Exception as error:  # the ways in which drivers are missing have no common ancestor
        failure = explain_failure("raster", "".join(traceback.format_exception(error)), 1)
        raise EngineError(f"no OpenGL to draw with ({failure.found}): {failure.remedy}") from error


def _egl_context() -> Any:
    pyrender: Any = importlib.import_module("pyrender")
    return pyrender.OffscreenRenderer(16, 16)


def osmesa_library() -> str | None:
    """The name under which the system's OSMesa opens, None where there is none."""
    return next((name for name in OSMESA_LIBRARIES if opens(name)), None)


class OSMesaContext:
    """An OpenGL 3.3 core context in memory, current from now on; keep it as long as something is drawn.

    Made with the library itself: pyrender asks for a function that the PyOpenGL it pins does not have.

    Raises:
        OSError: there is no OSMesa; its text is that of PyOpenGL in the same plight.
        RuntimeError: it has no OpenGL 3.3.
    """

    SIZE = 16
    _ATTRIBUTES = (0x22, 0x1908, 0x30, 24, 0x33, 0x34, 0x36, 3, 0x37, 3, 0)
    """Format RGBA, 24 bits of depth, core profile, version 3.3; ended by 0 (GL/osmesa.h)."""
    _GL_UNSIGNED_BYTE = 0x1401

    def __init__(self) -> None:
        name = osmesa_library()
        if name is None:
            raise OSError("libOSMesa.so.8: cannot open shared object file: No such file or directory")
        library = ctypes.CDLL(name, ctypes.RTLD_GLOBAL)
        create = library.OSMesaCreateContextAttribs
        create.restype, create.argtypes = ctypes.c_void_p, [ctypes.POINTER(ctypes.c_int), ctypes.c_void_p]
        make_current = library.OSMesaMakeCurrent
        make_current.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_uint, ctypes.c_int, ctypes.c_int]
        self._library = library
        self._context = create((ctypes.c_int * len(self._ATTRIBUTES))(*self._ATTRIBUTES), None)
        self._pixels = ctypes.create_string_buffer(4 * self.SIZE * self.SIZE)
        if not self._context or not make_current(
            self._context, self._pixels, self._GL_UNSIGNED_BYTE, self.SIZE, self.SIZE
        ):
            raise RuntimeError("OSMesa gives no OpenGL 3.3 context")
        platform: Any = importlib.import_module("OpenGL.platform")
        # PyOpenGL keeps what it knows of a context in a dictionary; its own type for the key is not hashable
        platform.PLATFORM.GetCurrentContext.restype = ctypes.c_void_p
