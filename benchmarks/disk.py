"""What a frame takes on disk, by pass and codec: ``python benchmarks/disk.py``.

Renders a few frames on several stages with all passes, RGB as PNG, and encodes the same pictures as JPEG and
as video too. Prints bytes a pixel for each (mean and largest over the stages), bytes of labels for a person
in a frame, and what a sequence needs meanwhile. ``render_jobs/budget.py`` holds these figures.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
from PIL import Image

from render_jobs.images import JPEG_QUALITY
from render_jobs.processes import child_environment
from whacamole.dataset import open_dataset
from whacamole.dataset.video import write_video
from whacamole.production.filming import film_of, plan_camera
from whacamole.production.sequence import render_job, take_of
from whacamole.production.worklist import work_of
from whacamole.recipe import Recipe

PASSES = ("mask", "depth", "normal", "flow")


def main() -> None:
    """Render, encode, count, print."""
    options = _parse()
    width, height = (int(side) for side in options.size.split("x"))
    sizes: dict[str, list[float]] = defaultdict(list)
    labels: list[float] = []
    for stage in options.stages.split(","):
        out = options.out / f"{options.size}-{options.engine}-{stage}"
        _render(out, stage, options)
        for sequence in open_dataset(out):
            folder, frames = sequence.layout.folder, len(sequence)
            for name in PASSES:
                sizes[name].append(_bytes(folder / name) / frames / width / height)
            for name, total in _codecs(folder / "rgb", options.out / "encoded").items():
                sizes[name].append(total / frames / width / height)
            plain = sum(_bytes(folder / name) for name in ("people.npz", "contact.npz", "camera.npz"))
            labels.append(plain / frames / int(sequence.facts["people"]))
    what = f"{options.engine}, {options.quality}, {options.size}"
    print(f"{what}, {len(labels)} sequences of {options.frames} frames")
    print("| file | bytes a pixel, mean | largest |", "|---|---|---|", sep="\n")
    for name, values in sizes.items():
        print(f"| {name} | {np.mean(values):.3f} | {np.max(values):.3f} |")
    print(f"labels: {np.mean(labels):.0f} bytes a person and frame, {np.max(labels):.0f} at most")
    _meanwhile(options)


def _parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--frames", type=int, default=8)
    parser.add_argument("--engine", default="cycles", choices=("cycles", "raster"))
    parser.add_argument("--quality", default="standard")
    parser.add_argument("--stages", default="courtyard,living-room,park,plaza")
    parser.add_argument("--out", type=Path, default=Path("build/benchmarks/disk"))
    return parser.parse_args()


def _render(out: Path, stage: str, options: argparse.Namespace) -> None:
    subprocess.run(
        [
            sys.executable, "-m", "whacamole", "render", "--quiet", "--out", str(out), "--stages", stage,
            "--size", options.size, "--frames", str(options.frames), "--engine", options.engine,
            "--quality", options.quality, "--passes", "rgb,mask,depth,normal,flow", "--image-format", "png",
            "--limit", "1", "--jobs", "1", "--seed", "3",
        ],
        check=True, env=child_environment(),
    )  # fmt: skip


def _codecs(frames: Path, scratch: Path) -> dict[str, int]:
    """Bytes of the same pictures as PNG, JPEG and video."""
    shutil.rmtree(scratch, ignore_errors=True)
    scratch.mkdir(parents=True)
    files = sorted(frames.iterdir())
    for file in files:
        with Image.open(file) as picture:
            picture.save(scratch / f"{file.stem}.jpg", quality=JPEG_QUALITY, subsampling=0)
    found = {"rgb png": _bytes(frames), "rgb jpg": _bytes(scratch)}
    for quality in (12, 18):
        video = scratch / f"{quality}.mp4"
        write_video(video, (np.asarray(Image.open(file)) for file in files), 30.0, quality=quality)
        found[f"rgb mp4, quality {quality}"] = _bytes(video)
    return found


def _bytes(path: Path) -> int:
    return path.stat().st_size if path.is_file() else sum(_bytes(inside) for inside in path.iterdir())


def _meanwhile(options: argparse.Namespace) -> None:
    """What a job folder holds beside the frames, while its sequence is made."""
    work = options.out / "job"
    for frames in (30, 90):
        shutil.rmtree(work, ignore_errors=True)
        order = work_of(Recipe(frames=frames, limit=1, stages=("park",), seed=3), work / "none").orders[0]
        take = take_of(order, textures=work / "textures")
        plan = plan_camera(take, order.recipe, 0)
        render_job(take, plan, film_of(take, plan, order.recipe, 0), order.recipe).save(work / "job")
        print(f"meanwhile, {take.num_frames} frames, 1 person: {_bytes(work) / 1e6:.1f} MB")


if __name__ == "__main__":
    main()
