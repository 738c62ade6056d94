"""Which device and which denoiser Cycles is told to take, with GPUs that are only pretended."""

from __future__ import annotations

from dataclasses import dataclass, field

import pytest

from render_jobs import EngineError, Quality
from render_jobs.blender.settings import denoiser_settings, sampling_settings, take_device
from render_jobs.devices import parse_device


@dataclass
class Device:
    """As Blender's preferences list it."""

    name: str
    type: str
    use: bool = False


@dataclass
class Preferences:
    """Those of the Cycles add-on: an interface that the build does not know is a TypeError."""

    devices: list[Device]
    known: tuple[str, ...] = ("NONE", "CUDA", "OPTIX", "HIP", "ONEAPI")
    refreshed: int = 0
    _interface: str = field(default="NONE", repr=False)

    @property
    def compute_device_type(self) -> str:
        return self._interface

    @compute_device_type.setter
    def compute_device_type(self, value: str) -> None:
        if value not in self.known:
            raise TypeError(f"enum {value!r} not found")
        self._interface = value

    def refresh_devices(self) -> None:
        self.refreshed += 1

    @property
    def used(self) -> list[str]:
        return [f"{device.type} {device.name}" for device in self.devices if device.use]


def workstation() -> Preferences:
    """Two NVIDIA cards, which show under both of their interfaces, and the processor."""
    cards = [Device(name, kind) for kind in ("CUDA", "OPTIX") for name in ("RTX A", "RTX B")]
    return Preferences([Device("EPYC", "CPU", use=True), *cards])


@pytest.mark.parametrize(
    ("wanted", "interface", "used"),
    [
        ("auto", "OPTIX", ["OPTIX RTX A", "OPTIX RTX B"]),
        ("gpu", "OPTIX", ["OPTIX RTX A", "OPTIX RTX B"]),
        ("cuda", "CUDA", ["CUDA RTX A", "CUDA RTX B"]),
        ("optix:1", "OPTIX", ["OPTIX RTX B"]),
        ("cuda:0", "CUDA", ["CUDA RTX A"]),
    ],
)
def test_the_best_interface_is_taken_and_its_devices_alone(
    wanted: str, interface: str, used: list[str]
) -> None:
    preferences = workstation()
    taken, names = take_device(preferences, parse_device(wanted))
    assert taken == interface
    assert preferences.compute_device_type == interface
    assert preferences.used == used, "the processor does not slow the cards down"
    assert names == f"{interface} " + ", ".join(name.split(" ", 1)[1] for name in used)


def test_an_interface_that_this_build_lacks_is_passed_over() -> None:
    preferences = Preferences([Device("Radeon", "HIP")], known=("NONE", "HIP"))
    assert take_device(preferences, parse_device("auto")) == ("HIP", "HIP Radeon")


def test_without_a_gpu_auto_takes_the_cpu_and_who_insists_is_told() -> None:
    bare = Preferences([Device("EPYC", "CPU")])
    assert take_device(bare, parse_device("auto")) == ("CPU", "CPU")
    assert take_device(bare, parse_device("cpu")) == ("CPU", "CPU")
    with pytest.raises(EngineError, match=r"no OPTIX or CUDA or HIP .* device: install its driver"):
        take_device(bare, parse_device("gpu"))
    with pytest.raises(EngineError, match=r"no CUDA device 2: choose from 0: RTX A, 1: RTX B"):
        take_device(workstation(), parse_device("cuda:2"))


@pytest.mark.parametrize(
    ("interface", "denoiser", "on_gpu"),
    [("OPTIX", "OPTIX", True), ("CUDA", "OPENIMAGEDENOISE", True), ("CPU", "OPENIMAGEDENOISE", False)],
)
def test_optix_denoises_with_its_own(interface: str, denoiser: str, on_gpu: bool) -> None:
    settings = denoiser_settings(Quality(name="q", samples=8, prefilter="accurate"), interface)
    assert settings["denoiser"] == denoiser
    assert settings["denoising_use_gpu"] is on_gpu
    assert settings["denoising_prefilter"] == "ACCURATE"
    assert denoiser_settings(Quality(name="q", samples=8, denoise="off"), interface) == {
        "use_denoising": False
    }


def test_samples_are_adaptive_only_where_a_threshold_is_given() -> None:
    assert sampling_settings(Quality(name="q", samples=8))["use_adaptive_sampling"] is False
    settings = sampling_settings(Quality(name="q", samples=64, noise_threshold=0.1, glossy_bounces=5))
    assert settings["use_adaptive_sampling"] is True
    assert settings["adaptive_threshold"] == 0.1
    assert settings["max_bounces"] == 5
