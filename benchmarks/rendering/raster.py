"""The raster engine: how fast it is, and how far it agrees with Cycles.

``python -m benchmarks.rendering.raster`` prints frames a second for one, two and six people, then a row for
each stage and for a crowd of six: the least overlap of a person's masks (intersection over union) and the
largest median difference of depth between the two engines on the same job.
"""

from __future__ import annotations

import argparse
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from benchmarks.rendering.scenes import WORK, job_of, order_of
from render_jobs import PASSES, RenderJob, run_job
from render_jobs.images import read_exr
from whacamole.recipe import Recipe
from whacamole.stage import STAGES

FEWEST_PIXELS = 50
"""Of a person who shows less, one pixel more or less says nothing."""


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--sizes", nargs="*", default=["640x360", "1920x1080"], help="for the speed")
    parser.add_argument("--frames", type=int, default=12, help="for the speed")
    parser.add_argument("--agreement", default="320x180", help="size for the agreement; none to skip it")
    parser.add_argument("--out", type=Path, default=WORK / "raster")
    options = parser.parse_args()
    if options.sizes:
        print("| size | people | frames/s | CPU seconds a frame |")
        print("|---|---|---|---|")
    for size in options.sizes:
        for motion, people in (("walk", 1), ("duet", 2), ("walk", 6)):
            job = _job(motion, size, options.frames, people, ("courtyard",), options.out)
            print(f"| {size} | {_people(job)} | {_speed(job, options.out / 'speed')} |", flush=True)
    if options.agreement == "none":
        return
    print("\n| stage | people | least IoU | largest median depth difference, mm |")
    print("|---|---|---|---|")
    for stage, motion, people in (*((name, "duet", 2) for name in STAGES), ("plaza", "walk", 6)):
        job = _job(motion, options.agreement, 1, people, (stage,), options.out)
        overlap, depth = _agreement(job, options.out / "agreement")
        print(f"| {stage} | {_people(job)} | {overlap:.4f} | {depth * 1000:.3f} |", flush=True)


def _job(motion: str, size: str, frames: int, people: int, stages: tuple[str, ...], out: Path) -> RenderJob:
    recipe = Recipe.model_validate(
        {"size": size, "frames": frames, "stages": stages, "seed": 3, "people": people, "quality": "draft"}
    )
    return job_of(order_of(motion, recipe), out / "textures" / stages[0])


def _people(job: RenderJob) -> int:
    return len({mesh.track_id for mesh in job.meshes} - {0})


def _speed(job: RenderJob, folder: Path) -> str:
    """Steady pace: the first frame, which waits for shaders, left out."""
    _fresh(job, folder)
    result = run_job(folder, engine="raster", timeout=None)
    seconds = [result.frame_seconds[frame] for frame in range(1, job.num_frames)]
    cpu = [result.frame_cpu_seconds[frame] for frame in range(1, job.num_frames)]
    return f"{len(seconds) / sum(seconds):.1f} | {np.median(cpu):.3f}"


def _agreement(job: RenderJob, folder: Path) -> tuple[float, float]:
    """Least overlap and largest median difference of depth [m] over the people who can be seen."""
    found = {}
    for engine in ("cycles", "raster"):
        _fresh(replace(job, passes=("mask", "depth")), folder / engine)
        run_job(folder / engine, engine=engine, device="cpu", timeout=None)
        out = folder / engine / "out"
        with Image.open(out / PASSES["mask"].file(0)) as image:
            found[engine] = np.asarray(image), read_exr(out / PASSES["depth"].file(0))["Z"]
    (mask, depth), (other_mask, other_depth) = found["cycles"], found["raster"]
    overlaps, differences = [], []
    for person in np.unique(mask[mask > 0]):
        mine, theirs = mask == person, other_mask == person
        if mine.sum() < FEWEST_PIXELS:
            continue
        both = mine & theirs
        overlaps.append(both.sum() / (mine | theirs).sum())
        differences.append(np.median(np.abs(depth[both] - other_depth[both])))
    return min(overlaps), max(differences)


def _fresh(job: RenderJob, folder: Path) -> None:
    shutil.rmtree(folder / "out", ignore_errors=True)
    job.save(folder)


if __name__ == "__main__":
    main()
