"""What a frame costs: ``python -m benchmarks.rendering.cost --size 1920x1080``.

CPU seconds of all threads and wall seconds of one frame with one and with two dressed people, by quality
preset: RGB, mask and depth, labels not counted. It is the second frame of a job, so that what is done once a
job is left out.
"""

from __future__ import annotations

import argparse
import shutil
from pathlib import Path

from benchmarks.rendering.scenes import WORK, job_of, order_of
from render_jobs import QUALITIES, run_job
from whacamole.recipe import Recipe

PEOPLE = {"walk": 1, "duet": 2}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--size", default="1920x1080")
    parser.add_argument("--quality", nargs="+", choices=QUALITIES, default=list(QUALITIES))
    parser.add_argument("--motions", nargs="+", choices=PEOPLE, default=list(PEOPLE))
    parser.add_argument("--stage", default="courtyard")
    parser.add_argument("--out", type=Path, default=WORK / "cost")
    options = parser.parse_args()
    print("| size | people | quality | CPU s a frame | wall s a frame |")
    print("|---|---|---|---|---|")
    for motion in options.motions:
        for quality in options.quality:
            recipe = Recipe.model_validate(
                {"size": options.size, "frames": 2, "stages": (options.stage,), "seed": 3, "quality": quality}
            )
            folder = options.out / "job"
            shutil.rmtree(folder, ignore_errors=True)
            job_of(order_of(motion, recipe), options.out / "textures").save(folder)
            result = run_job(folder, device="cpu", timeout=None)
            cpu, wall = result.frame_cpu_seconds[1], result.frame_seconds[1]
            print(f"| {options.size} | {PEOPLE[motion]} | {quality} | {cpu:.1f} | {wall:.1f} |", flush=True)


if __name__ == "__main__":
    main()
