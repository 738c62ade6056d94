"""Two sequences side by side against one after the other: ``python -m benchmarks.rendering.side_by_side``.

Wall time of ``whacamole render`` for the same two sequences, with each way to share cores between jobs and
threads. Twice the cores would be used alike by one job if rendering split evenly over threads; what does not
(start, staging, the set-up of every frame) is what jobs side by side make up for.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

from benchmarks.rendering.scenes import WORK
from render_jobs.processes import child_environment

MOTIONS = ("walk", "dance_a")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--frames", type=int, default=8)
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--quality", default="standard")
    parser.add_argument("--engine", default="cycles")
    parser.add_argument("--repeat", type=int, default=1)
    parser.add_argument("--out", type=Path, default=WORK / "side-by-side")
    options = parser.parse_args()
    cores = len(os.sched_getaffinity(0))
    ways = [(1, cores), (2, max(1, cores // 2)), (2, cores)]
    motions = _motions(options.out)
    seconds: dict[tuple[int, int], list[float]] = {way: [] for way in ways}
    for _ in range(options.repeat):
        for way in ways:
            seconds[way].append(_render(motions, options, *way))
    base = min(seconds[ways[0]])
    print(f"{options.engine}, {options.frames} frames of {options.size}, {options.quality}, {cores} cores")
    print("| jobs | threads each | seconds | against one after the other |")
    print("|---|---|---|---|")
    for (jobs, threads), times in seconds.items():
        print(f"| {jobs} | {threads} | {min(times):.1f} | {min(times) / base:.2f} |")


def _motions(out: Path) -> Path:
    from whacamole.motion import embedded_motions

    folder = out / "motions"
    folder.mkdir(parents=True, exist_ok=True)
    for name in MOTIONS:
        shutil.copyfile(embedded_motions() / f"{name}.npz", folder / f"{name}.npz")
    return folder


def _render(motions: Path, options: argparse.Namespace, jobs: int, threads: int) -> float:
    out = options.out / "dataset"
    shutil.rmtree(out, ignore_errors=True)
    command = [
        sys.executable, "-m", "whacamole", "render", "--motions", str(motions), "--out", str(out), "--quiet",
        "--frames", str(options.frames), "--size", options.size, "--quality", options.quality,
        "--engine", options.engine, "--device", "cpu", "--stages", "courtyard", "--seed", "3",
        "--jobs", str(jobs), "--threads", str(threads),
    ]  # fmt: skip
    began = time.perf_counter()
    subprocess.run(command, check=True, env=child_environment())
    return time.perf_counter() - began


if __name__ == "__main__":
    main()
