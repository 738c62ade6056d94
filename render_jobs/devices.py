"""Names of the devices a job can run on.

``auto`` takes the best GPU the engine finds, else the CPU; ``cpu`` and ``gpu`` insist; ``cuda``, ``optix``,
``hip``, ``oneapi`` and ``metal`` name the interface, and ``cuda:1`` one of its devices.
"""

from __future__ import annotations

from dataclasses import dataclass

from render_jobs.errors import RenderJobError

GPU_INTERFACES: tuple[str, ...] = ("OPTIX", "CUDA", "HIP", "ONEAPI", "METAL")
"""What Cycles can use, best first."""


@dataclass(frozen=True)
class DeviceChoice:
    """A parsed device name.

    Attributes:
        interfaces: GPU interfaces to try in order; empty for the CPU.
        index: which device of the interface; None for all of them.
        insist: a missing GPU is an error rather than a reason to take the CPU.
    """

    interfaces: tuple[str, ...]
    index: int | None = None
    insist: bool = False


def parse_device(name: str) -> DeviceChoice:
    """Read a device name.

    Raises:
        RenderJobError: the name is none of those above.
    """
    kind, _, index = name.partition(":")
    if name in ("auto", "gpu"):
        return DeviceChoice(GPU_INTERFACES, insist=name == "gpu")
    if name == "cpu":
        return DeviceChoice(())
    if kind.upper() in GPU_INTERFACES and (index.isdigit() or name == kind):
        return DeviceChoice((kind.upper(),), int(index) if index else None, insist=True)
    choices = ", ".join(("auto", "cpu", "gpu", *(interface.lower() for interface in GPU_INTERFACES)))
    raise RenderJobError(
        f"device {name!r} is not one of {choices}, or one of the last with a number, as cuda:1"
    )
