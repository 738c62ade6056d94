"""The jobs that Slurm is asked for, and what is said where a cluster cannot be had."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from render_jobs.clusters import SlurmConfig, dask_crew, read_slurm_config, slots_here, slurm_crew
from render_jobs.errors import EngineError, RenderJobError
from render_jobs.processes import child_environment

CONFIG = """
partition: cpu
account: my-project
workers: 64
cores: 8
memory: 16GB
walltime: "04:00:00"
gpus: 1
directives: ["--constraint=avx2"]
prologue: ["source /shared/venv/bin/activate"]
python: /shared/venv/bin/python
"""


def test_the_job_script_asks_for_what_the_file_says(tmp_path: Path) -> None:
    """In a process of its own: Dask's import leaves threads and warnings behind."""
    (tmp_path / "cluster.yaml").write_text(CONFIG, encoding="utf-8")
    code = (
        "from pathlib import Path; from dask_jobqueue.slurm import SLURMJob\n"
        "from render_jobs.clusters import read_slurm_config, slurm_options\n"
        f"config = read_slurm_config(Path({str(tmp_path / 'cluster.yaml')!r}))\n"
        "options = slurm_options(config, Path('logs'))\n"
        "print(SLURMJob(scheduler='tcp://login:8786', name='1', **options).job_script())"
    )
    script = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, env=child_environment()
    ).stdout
    lines = [line for line in script.splitlines() if line.strip()]
    assert lines[0].startswith("#!")
    assert {line for line in lines if line.startswith("#SBATCH")} == {
        "#SBATCH -J whacamole", "#SBATCH -e logs/whacamole-%J.err", "#SBATCH -o logs/whacamole-%J.out",
        "#SBATCH -p cpu", "#SBATCH -A my-project", "#SBATCH -n 1", "#SBATCH --cpus-per-task=8",
        "#SBATCH --mem=15G", "#SBATCH -t 04:00:00", "#SBATCH --gres=gpu:1", "#SBATCH --constraint=avx2",
    }  # fmt: skip
    assert "source /shared/venv/bin/activate" in lines
    worker = lines[-1]
    assert worker.startswith("/shared/venv/bin/python -m distributed.cli.dask_worker tcp://login:8786")
    assert "--nthreads 1 " in worker + " "
    assert worker.split("--memory-limit")[-1].split()[0] == "0", "the last one counts"


def test_no_file_is_the_defaults() -> None:
    assert read_slurm_config(None) == SlurmConfig()


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("cores: many", "cores: Input should be a valid integer"),
        ("queue: cpu", "queue: Extra inputs are not permitted; there are partition, account"),
        ("cores: [", "not a readable cluster file"),
    ],
)
def test_a_wrong_file_is_named_with_what_is_wrong(text: str, says: str, tmp_path: Path) -> None:
    file = tmp_path / "cluster.yaml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(RenderJobError) as caught:
        read_slurm_config(file)
    assert str(file) in str(caught.value)
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_missing_package_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(EngineError, match=r"pip install 'whacamole\[cluster\]'"), dask_crew("tcp://h:1"):
        pass


def test_no_sbatch_names_the_way_without(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", sys)
    monkeypatch.setitem(sys.modules, "dask_jobqueue", sys)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(EngineError, match="--shard"), slurm_crew(SlurmConfig(), tmp_path):
        pass


@pytest.mark.filterwarnings("ignore")  # of Dask's event loop, which is none of ours
def test_jobs_that_slurm_refuses_are_told_before_any_is_submitted(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("dask_jobqueue")
    asked = tmp_path / "asked"
    sbatch = tmp_path / "sbatch"
    sbatch.write_text(f"#!/bin/sh\necho $* >> {asked}\ncat >> {asked}\necho invalid partition >&2\nexit 1\n")
    sbatch.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    with (
        pytest.raises(EngineError, match=r"would refuse the jobs \(invalid partition\)"),
        slurm_crew(SlurmConfig(partition="nowhere"), tmp_path / "logs"),
    ):
        pass
    lines = asked.read_text().splitlines()
    assert lines[0] == "--test-only"
    assert "#SBATCH -p nowhere" in lines
    assert sum(line.startswith("--test-only") for line in lines) == 1


def test_outside_a_dask_worker_there_is_one_slot() -> None:
    assert slots_here() == 1
