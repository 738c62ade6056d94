"""What a process may use: limits are kept, and graphics processors are shared evenly by whoever asks."""

from __future__ import annotations

import contextlib
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from render_jobs import machine
from render_jobs.machine import best_jobs, lease_gpu, usable_cores, usable_memory_mb, visible_gpus
from render_jobs.processes import child_environment


@pytest.fixture(autouse=True)
def own_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    for name in ("HIP_VISIBLE_DEVICES", "ROCR_VISIBLE_DEVICES", "SLURM_CPUS_PER_TASK", "SLURM_MEM_PER_NODE"):
        monkeypatch.delenv(name, raising=False)


@pytest.mark.parametrize(
    ("listed", "gpus"),
    [("0,1", ("0", "1")), ("", ()), ("-1", ()), ("GPU-ab12, GPU-cd34", ("GPU-ab12", "GPU-cd34"))],
)
def test_the_list_in_the_environment_holds(
    listed: str, gpus: tuple[str, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CUDA_VISIBLE_DEVICES", listed)
    assert visible_gpus() == gpus


def test_the_driver_is_asked_where_there_is_no_list(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CUDA_VISIBLE_DEVICES", raising=False)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert visible_gpus() == ()
    tool = tmp_path / "nvidia-smi"
    tool.write_text("#!/bin/sh\necho 0\necho 1\necho 3\n", encoding="utf-8")
    tool.chmod(0o755)
    assert visible_gpus() == ("0", "1", "3")


def test_jobs_spread_over_gpus_before_they_share_one() -> None:
    with contextlib.ExitStack() as stack:
        leases = [stack.enter_context(lease_gpu(("0", "1"))) for _ in range(5)]
    assert [(lease.name, lease.place) for lease in leases if lease] == [
        ("0", 0), ("1", 0), ("0", 1), ("1", 1), ("0", 2),
    ]  # fmt: skip
    with lease_gpu(("0", "1")) as again:
        assert again is not None
        assert (again.name, again.place) == ("0", 0)
        assert again.environment["CUDA_VISIBLE_DEVICES"] == "0"
    with lease_gpu(()) as none:
        assert none is None


def test_a_killed_process_gives_its_gpu_back(tmp_path: Path) -> None:
    code = (
        "import tempfile, time; from render_jobs.machine import lease_gpu\n"
        f"tempfile.tempdir = {str(tmp_path)!r}\n"
        "with lease_gpu(('0', '1')) as lease: print(lease.name, flush=True); time.sleep(60)"
    )
    holder = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, env=child_environment()
    )
    assert holder.stdout is not None
    assert holder.stdout.readline().strip() == "0"
    with lease_gpu(("0", "1")) as lease:
        assert lease is not None
        assert lease.name == "1"
    holder.kill()
    holder.communicate()
    with lease_gpu(("0", "1")) as lease:
        assert lease is not None
        assert lease.name == "0"


def test_what_a_batch_system_grants_is_not_overstepped(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(machine.os, "sched_getaffinity", lambda _: set(range(64)), raising=False)
    monkeypatch.setattr(machine, "_cgroup_folders", lambda: iter([tmp_path]))
    assert usable_cores() == 64
    (tmp_path / "cpu.max").write_text("650000 100000\n", encoding="ascii")
    (tmp_path / "memory.max").write_text(f"{512 * 2**20}\n", encoding="ascii")
    assert usable_cores() == 7
    assert usable_memory_mb() == 512
    monkeypatch.setenv("SLURM_CPUS_PER_TASK", "4")
    monkeypatch.setenv("SLURM_MEM_PER_NODE", "300")
    assert usable_cores() == 4
    assert usable_memory_mb() == 300


def test_jobs_follow_gpus_cores_and_memory() -> None:
    assert best_jobs(cores=64, memory_mb=512_000, gpus=4) == 4
    assert best_jobs(cores=1, memory_mb=1000, gpus=0) == 1
    assert best_jobs(cores=64, memory_mb=9_000, gpus=0) == 3
