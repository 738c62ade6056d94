"""What Cycles is told of sampling, denoiser and device, as plain values; Blender is not needed for it."""

from __future__ import annotations

from typing import Any

from render_jobs.devices import DeviceChoice
from render_jobs.errors import EngineError
from render_jobs.quality import Quality

DENOISE_QUALITY = {"fast": "FAST", "balanced": "BALANCED", "high": "HIGH"}


def sampling_settings(quality: Quality) -> dict[str, Any]:
    """Properties of ``scene.cycles`` that decide what a sample is and how many there are."""
    return {
        "samples": quality.samples,
        "use_adaptive_sampling": quality.noise_threshold > 0,
        "adaptive_threshold": quality.noise_threshold,
        "use_light_tree": quality.light_tree,
        "diffuse_bounces": quality.diffuse_bounces,
        "glossy_bounces": quality.glossy_bounces,
        "max_bounces": max(quality.diffuse_bounces, quality.glossy_bounces),
        "transmission_bounces": 0,
        "volume_bounces": 0,
        "transparent_max_bounces": quality.transparent_bounces,
        "sample_clamp_indirect": quality.clamp_indirect,
        "caustics_reflective": True,  # without them a room of glossy walls is too dark
        "caustics_refractive": False,
    }


def denoiser_settings(quality: Quality, interface: str) -> dict[str, Any]:
    """Properties of ``scene.cycles`` for the denoiser: OptiX has its own, all other devices share one.

    Args:
        quality: how strong.
        interface: what renders: ``CPU`` or a GPU interface.
    """
    if quality.denoise == "off":
        return {"use_denoising": False}
    return {
        "use_denoising": True,
        "denoiser": "OPTIX" if interface == "OPTIX" else "OPENIMAGEDENOISE",
        "denoising_use_gpu": interface != "CPU",
        "denoising_quality": DENOISE_QUALITY[quality.denoise],
        "denoising_prefilter": quality.prefilter.upper(),
        "denoising_input_passes": "RGB_ALBEDO_NORMAL",
    }


def take_device(preferences: Any, choice: DeviceChoice) -> tuple[str, str]:
    """Switch on the first interface of the choice that has a device.

    Args:
        preferences: those of the Cycles add-on, which hold the devices.
        choice: where to run.

    Returns:
        the interface, or ``CPU``; and the devices, for people to read.

    Raises:
        EngineError: a GPU was insisted on and there is none.
    """
    for interface in choice.interfaces:
        names = enable(preferences, interface, choice.index)
        if names:
            return interface, f"{interface} {', '.join(names)}"
    if choice.insist:
        raise EngineError(_no_device(preferences, choice))
    return "CPU", "CPU"


def enable(preferences: Any, interface: str, index: int | None) -> list[str]:
    """Switch on the GPUs of an interface (one, where an index is given) and return their names."""
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


def _no_device(preferences: Any, choice: DeviceChoice) -> str:
    wanted = " or ".join(choice.interfaces)
    if choice.index is not None:
        there = enable(preferences, choice.interfaces[0], None)
        if there:
            numbers = ", ".join(f"{index}: {name}" for index, name in enumerate(there))
            return f"Cycles finds no {wanted} device {choice.index}: choose from {numbers}"
    return f"Cycles finds no {wanted} device: install its driver, or use the device cpu"
