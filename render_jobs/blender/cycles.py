"""Cycles: devices and sampling."""

from __future__ import annotations

from typing import Any

import bpy

from render_jobs.devices import DeviceChoice
from render_jobs.errors import EngineError
from render_jobs.job import RenderJob
from render_jobs.quality import Quality

DENOISE_QUALITY = {"fast": "FAST", "balanced": "BALANCED", "high": "HIGH"}


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
    interface, names = _take_device(scene.cycles, choice)
    scene.cycles.seed = job.seed
    scene.cycles.use_animated_seed = True  # a fixed pattern of noise would stick to the screen
    scene.cycles.use_auto_tile = False
    _set_sampling(scene.cycles, job.quality)
    _set_denoiser(scene.cycles, job.quality, interface)
    return names


def _take_device(settings: Any, choice: DeviceChoice) -> tuple[str, str]:
    for interface in choice.interfaces:
        names = _enable(interface, choice.index)
        if names:
            settings.device = "GPU"
            return interface, f"{interface} {', '.join(names)}"
    if choice.insist:
        wanted = " or ".join(choice.interfaces)
        raise EngineError(f"Cycles finds no {wanted} device: install its driver, or use the device cpu")
    settings.device = "CPU"
    return "CPU", "CPU"


def _enable(interface: str, index: int | None) -> list[str]:
    """Switch on the GPUs of an interface (one, where an index is given) and return their names."""
    preferences = _preferences()
    try:
        preferences.compute_device_type = interface
    except TypeError:  # this build of Blender does not know the interface
        return []
    preferences.refresh_devices()
    found = [device for device in preferences.devices if device.type == interface]
    chosen = found if index is None else found[index : index + 1]
    for device in preferences.devices:
        device.use = device in chosen
    return [str(device.name) for device in chosen]


def gpu_names() -> dict[str, list[str]]:
    """The GPUs that Cycles finds, by interface."""
    preferences = _preferences()
    found: dict[str, list[str]] = {}
    for entry in preferences.get_device_types(bpy.context):
        if entry[0] not in ("NONE", "CPU"):
            names = _enable(entry[0], None)
            if names:
                found[entry[0]] = names
    return found


def _preferences() -> Any:
    """The preferences of the Cycles add-on: the devices."""
    context: Any = bpy.context
    return context.preferences.addons["cycles"].preferences


def _set_sampling(settings: Any, quality: Quality) -> None:
    settings.samples = quality.samples
    settings.use_adaptive_sampling = quality.noise_threshold > 0
    settings.adaptive_threshold = quality.noise_threshold
    settings.use_light_tree = quality.light_tree
    settings.diffuse_bounces = quality.diffuse_bounces
    settings.glossy_bounces = quality.glossy_bounces
    settings.max_bounces = max(quality.diffuse_bounces, quality.glossy_bounces)
    settings.transmission_bounces = 0
    settings.volume_bounces = 0
    settings.transparent_max_bounces = quality.transparent_bounces
    settings.sample_clamp_indirect = quality.clamp_indirect
    settings.caustics_reflective = False
    settings.caustics_refractive = False


def _set_denoiser(settings: Any, quality: Quality, interface: str) -> None:
    settings.use_denoising = quality.denoise != "off"
    if not settings.use_denoising:
        return
    settings.denoiser = "OPTIX" if interface == "OPTIX" else "OPENIMAGEDENOISE"
    settings.denoising_use_gpu = interface != "CPU"
    settings.denoising_quality = DENOISE_QUALITY[quality.denoise]
    settings.denoising_prefilter = quality.prefilter.upper()
    settings.denoising_input_passes = "RGB_ALBEDO_NORMAL"
