"""EEVEE, Blender's OpenGL engine: quick with a graphics card, slow without."""

from __future__ import annotations

from typing import Any

import bpy

from render_jobs.job import RenderJob

SAMPLES_PER_CYCLES_SAMPLE = 2
"""EEVEE's samples smooth edges, soft shadows and depth of field; each costs far less than one of Cycles."""


def set_up_eevee(job: RenderJob) -> None:
    """Prepare EEVEE for the picture; Cycles stays the scene's engine. The first frame opens OpenGL."""
    scene: Any = bpy.context.scene
    scene.eevee.taa_render_samples = SAMPLES_PER_CYCLES_SAMPLE * job.quality.samples
    scene.eevee.use_raytracing = job.quality.diffuse_bounces > 0  # bounced light, from what the camera sees
    scene.eevee.motion_blur_steps = 4 if job.shutter > 0 else 1
