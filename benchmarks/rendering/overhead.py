"""What the product adds to Blender: ``python -m benchmarks.rendering.overhead --frames 24``.

The wall time of ``whacamole render`` for one sequence (start, take, plan, labels, JPEG, PNG and ZIP EXR,
checksums, index and card, all of it), over the wall time of Blender's own start and rendering of the very
same saved scene with the same settings and one multilayer EXR a frame. The two are run one after the other,
``--repeat`` times, and the medians are compared.
"""

from __future__ import annotations

import argparse
import json
import shutil
import statistics
import subprocess
import sys
import time
from pathlib import Path

from benchmarks.rendering.scenes import SCENES, WORK, blender, job_of, order_of, saved_scene
from render_jobs.processes import child_environment
from whacamole.recipe import Recipe


def main() -> None:
    """Measure and print one row of a Markdown table a length."""
    options = _parse()
    print("| frames | quality | whacamole render, s | Blender alone, s | ratio |")
    print("|---|---|---|---|---|")
    for frames in options.frames:
        ours, alone = measure(options, frames)
        print(f"| {frames} | {options.quality} | {ours:.1f} | {alone:.1f} | {ours / alone:.3f} |", flush=True)


def _parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--frames", type=int, nargs="+", default=[24])
    parser.add_argument("--quality", default="standard")
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--stage", choices=SCENES, default="courtyard")
    parser.add_argument("--repeat", type=int, default=1)
    parser.add_argument("--only", choices=("ours", "alone"), help="measure one side and keep it for later")
    parser.add_argument("--out", type=Path, default=WORK / "overhead")
    return parser.parse_args()


def measure(options: argparse.Namespace, frames: int) -> tuple[float, float]:
    """Median wall seconds of ``whacamole render`` and of Blender alone, measured now or kept from before."""
    width, height = (int(side) for side in options.size.split("x"))
    recipe = Recipe.model_validate(
        {"size": (width, height), "frames": frames, "stages": (options.stage,), "seed": 3,
         "quality": options.quality, "engine": "cycles"}
    )  # fmt: skip
    folder = options.out / f"{options.stage}-{options.size}-{options.quality}-{frames}"
    order = order_of(SCENES[options.stage], recipe)
    blend = folder / "scene.blend"
    if not blend.exists():
        saved_scene(job_of(order, folder / "textures"), folder)
    kept = folder / "seconds.json"
    times: dict[str, list[float]] = (
        json.loads(kept.read_text()) if kept.exists() else {"ours": [], "alone": []}
    )
    for _ in range(options.repeat):
        if options.only != "alone":
            times["ours"].append(_ours(order.motion.paths[0], recipe, folder / "dataset"))
        if options.only != "ours":
            times["alone"].append(_alone(blend, folder / "exr", frames))
    kept.write_text(json.dumps(times), encoding="utf-8")
    nothing = float("nan")
    ours, alone = (statistics.median(times[side]) if times[side] else nothing for side in ("ours", "alone"))
    return ours, alone


def _ours(motion: Path, recipe: Recipe, out: Path) -> float:
    shutil.rmtree(out, ignore_errors=True)
    width, height = recipe.size
    command = [
        sys.executable, "-m", "whacamole", "render", "--motions", str(motion), "--out", str(out), "--json",
        "--frames", str(recipe.frames), "--size", f"{width}x{height}", "--stages", recipe.stages[0],
        "--seed", str(recipe.seed), "--quality", recipe.quality, "--profile", "--device", "cpu",
    ]  # fmt: skip
    began = time.perf_counter()
    done = subprocess.run(command, check=True, env=child_environment(), stdout=subprocess.PIPE, text=True)
    seconds = time.perf_counter() - began
    (out.parent / "profile.json").write_text(done.stdout, encoding="utf-8")
    return seconds


def _alone(blend: Path, out: Path, frames: int) -> float:
    shutil.rmtree(out, ignore_errors=True)
    began = time.perf_counter()
    blender("film", blend, out, str(frames), log=blend.parent / "blender.log")
    seconds = time.perf_counter() - began
    if len(list(out.glob("*.exr"))) != frames:
        raise SystemExit(f"{out}: Blender did not write {frames} frames")
    return seconds


if __name__ == "__main__":
    main()
