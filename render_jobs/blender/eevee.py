"""The EEVEE engine: the picture by OpenGL, the labels by Cycles' single ray through every pixel centre.

EEVEE has no object index and smooths depth and normals, so that its own passes would not be exact.
"""

from __future__ import annotations

from functools import partial

from render_jobs.blender.compat import EEVEE
from render_jobs.blender.engine import render as render_with

render = partial(render_with, painter=EEVEE)
"""Render frames of a job; arguments as in :func:`render_jobs.blender.engine.render`."""
