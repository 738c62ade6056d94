"""Cycles as the engine of the scene."""

from __future__ import annotations

from typing import Any

import bpy

from render_jobs.blender.settings import denoiser_settings, enable, sampling_settings, take_device
from render_jobs.devices import DeviceChoice
from render_jobs.job import RenderJob


def set_up_cycles(job: RenderJob, choice: DeviceChoice, threads: int) -> str:
    """Make Cycles the engine of the scene.

    Args:
        job: gives quality and seed.
        choice: where to run.
        threads: CPU threads; 0 takes all cores.

    Returns:
        the devices taken, for people to read.

    Raises:
        EngineError: a GPU was insisted on and there is none.
    """
    scene: Any = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.use_persistent_data = True
    scene.render.threads_mode = "FIXED" if threads else "AUTO"
    if threads:
        scene.render.threads = threads
    interface, names = take_device(_preferences(), choice)
    scene.cycles.device = "CPU" if interface == "CPU" else "GPU"
    scene.cycles.seed = job.seed
    scene.cycles.use_animated_seed = True  # a fixed pattern of noise would stick to the screen
    scene.cycles.use_auto_tile = False
    for name, value in (sampling_settings(job.quality) | denoiser_settings(job.quality, interface)).items():
        setattr(scene.cycles, name, value)
    return names


def gpu_names() -> dict[str, list[str]]:
    """The GPUs that Cycles finds, by interface."""
    preferences = _preferences()
    found: dict[str, list[str]] = {}
    for entry in preferences.get_device_types(bpy.context):
        if entry[0] not in ("NONE", "CPU"):
            names = enable(preferences, entry[0], None)
            if names:
                found[entry[0]] = names
    return found


def _preferences() -> Any:
    """The preferences of the Cycles add-on: the devices."""
    context: Any = bpy.context
    return context.preferences.addons["cycles"].preferences
