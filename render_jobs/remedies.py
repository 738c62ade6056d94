"""What a missing library, driver or package prints, and what to do about it."""

from __future__ import annotations

import re

from render_jobs.system_libraries import BLENDER_LIBRARIES, OPENGL_LIBRARIES, install_line

FOR_BLENDER = install_line(BLENDER_LIBRARIES)
FOR_OPENGL = install_line(OPENGL_LIBRARIES)
FOR_OSMESA = install_line(["libOSMesa.so.8"]) + ", or unset PYOPENGL_PLATFORM"
FOR_DRIVER = "install the package of the GPU's driver, or of Mesa's (in Debian: libgl1-mesa-dri)"

REMEDIES: tuple[tuple[str, str], ...] = (
    (r"No module named '?(bpy|pyrender|OpenGL)", "pip install --constraint constraints.txt whacamole"),
    (r"numpy\.core\.multiarray failed|np\.infty", 'pip install "numpy>=1.26,<2"'),
    (r"lib(X\w+|xkb\w+|SM|ICE|GL)\.so[.\d]*: cannot open", FOR_BLENDER),
    (r"XRenderFindVisualFormat", "set PYGLET_HEADLESS=1, or " + install_line(["libXrender.so.1"])),
    (r"Unable to load EGL|Couldn't open libEGL|EGL: cannot open", FOR_OPENGL),
    (r"Unable to load OpenGL|glGetError", FOR_OPENGL),
    (r"EGL Error \(0x3001\)|err = 12289|eglInitialize", FOR_DRIVER),
    (r'Library "GLU" not found', 'pip install "pyglet>=2"'),
    (r"libOSMesa|OSMesaCreateContextAttribs|OSMesa gives no", FOR_OSMESA),
    (r"NoSuchDisplay|NullFunctionError", "set PYOPENGL_PLATFORM=egl and PYGLET_HEADLESS=1"),
)
"""What a failure says, and what to do about it; the first that matches counts."""


def known_failure(output: str) -> tuple[str, str] | None:
    """The line of an output that tells of a fault of this machine, and its remedy; None where none does.

    Of several lines the last, which in a traceback is the message and not the code that raised it.
    """
    lines = non_empty_lines(output)[::-1]
    for pattern, remedy in REMEDIES:
        for line in lines:
            if re.search(pattern, line):
                return line, remedy
    return None


def non_empty_lines(output: str) -> list[str]:
    """The lines that say something, without the white space around them."""
    return [line.strip() for line in output.splitlines() if line.strip()]
