"""What this process may use of the machine it is on: cores, memory, graphics processors.

A batch system or a container gives out a part of a machine; asking for all of it slows down everybody there,
or gets the process killed.
"""

from __future__ import annotations

import contextlib
import fcntl
import math
import os
import subprocess
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import psutil

MEGABYTE = 1024**2

CORES_A_JOB = 2
JOB_MEMORY_MB = 3000.0
"""Both processes of a job, with room for a crowd at high resolution."""

_GPU_LISTS = ("CUDA_VISIBLE_DEVICES", "HIP_VISIBLE_DEVICES", "ROCR_VISIBLE_DEVICES")
_MOST_A_GPU = 64


def usable_cores() -> int:
    """The number of cores this process may use: the least of affinity, cgroup quota and Slurm's grant."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    granted = os.environ.get("SLURM_CPUS_PER_TASK", "")
    limits = [int(granted)] if granted.isdigit() else []
    for folder in _cgroup_folders():
        quota, _, period = _read(folder / "cpu.max").partition(" ")
        if quota.isdigit() and period.strip().isdigit():
            limits.append(math.ceil(int(quota) / int(period)))
    return max(1, min([cores, *limits]))


def usable_memory_mb() -> float:
    """The memory that this process and its children may hold, in MB: of the machine, cgroup or Slurm job."""
    limits = [float(psutil.virtual_memory().total) / MEGABYTE]
    granted = os.environ.get("SLURM_MEM_PER_NODE", "")
    if granted.isdigit() and int(granted) > 0:
        limits.append(float(granted))
    for folder in _cgroup_folders():
        limit = _read(folder / "memory.max").strip()
        if limit.isdigit():
            limits.append(int(limit) / MEGABYTE)
    return min(limits)


def visible_gpus() -> tuple[str, ...]:
    """Names of the graphics processors that this process may use, as ``CUDA_VISIBLE_DEVICES`` takes them.

    A list in the environment holds if there is one (an empty one hides all); else the NVIDIA driver is asked.
    """
    for variable in _GPU_LISTS:
        listed = os.environ.get(variable)
        if listed is not None:
            names = (name.strip() for name in listed.split(","))
            return tuple(name for name in names if name and name != "-1")
    try:
        asked = subprocess.run(
            ["nvidia-smi", "--query-gpu=index", "--format=csv,noheader"],
            capture_output=True, text=True, timeout=30, check=True,
        )  # fmt: skip
    except (OSError, subprocess.SubprocessError):
        return ()
    return tuple(line.strip() for line in asked.stdout.splitlines() if line.strip().isdigit())


def best_jobs(cores: int, memory_mb: float, gpus: int) -> int:
    """How many jobs a machine does side by side for most throughput.

    One for each graphics processor. Without any, one for every :data:`CORES_A_JOB` cores: what a job does on
    one core alone (staging, labels, the ends of frames) then fills the gaps of the others
    (``benchmarks/cluster.py split``), as far as memory goes.
    """
    if gpus:
        return gpus
    return max(1, min(cores // CORES_A_JOB, int(memory_mb // JOB_MEMORY_MB)))


@dataclass(frozen=True)
class GpuLease:
    """One graphics processor, for one process at a time.

    Attributes:
        name: as in :func:`visible_gpus`.
        place: 0 for its only user, 1 for a second one beside it, and so on.
    """

    name: str
    place: int

    @property
    def environment(self) -> dict[str, str]:
        """What shows a child this processor alone."""
        return {variable: self.name for variable in _GPU_LISTS if variable in os.environ} | {
            "CUDA_VISIBLE_DEVICES": self.name
        }


@contextlib.contextmanager
def lease_gpu(gpus: tuple[str, ...]) -> Iterator[GpuLease | None]:
    """Take the graphics processor that the fewest use, among all processes of this user on this machine.

    The lease is a lock on a file, which the system lets go of however the process ends; farms, workers of a
    cluster and shards on one machine thus share its processors evenly without knowing of each other.

    Args:
        gpus: from :func:`visible_gpus`; where there is none, None is yielded.
    """
    folder = Path(tempfile.gettempdir()) / f"whacamole-gpus-{os.getuid()}"
    if gpus:
        folder.mkdir(mode=0o700, exist_ok=True)
    for place in range(_MOST_A_GPU if gpus else 0):
        for name in gpus:
            safe = "".join(letter if letter.isalnum() else "-" for letter in name)
            with (folder / f"{safe}.{place}").open("w") as lock:
                try:
                    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                except BlockingIOError:
                    continue
                yield GpuLease(name, place)
                return
    yield None


def _cgroup_folders() -> Iterator[Path]:
    """The folders of this process's control group (version 2) and of those around it."""
    root = Path("/sys/fs/cgroup")
    for line in _read(Path("/proc/self/cgroup")).splitlines():
        if line.startswith("0::"):
            inside = line.removeprefix("0::").strip("/")
            folder = root / inside
            yield folder
            yield from (parent for parent in folder.parents if parent.is_relative_to(root))


def _read(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except OSError:
        return ""
