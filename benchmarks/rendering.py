"""Image error over seconds: what each render setting buys, on two scenes of the product's own.

``python benchmarks/rendering.py --settings presets denoiser`` prints a table in Markdown. Error is the root
mean square over pixels and channels of the difference, in 8-bit levels, to a reference of many samples and
bounces; cost is CPU seconds (all threads) of a frame that is not the first, labels included. The reference is
kept in ``--out`` and used again. Two cores take some minutes for the reference and half a minute a setting.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from PIL import Image

from render_jobs import QUALITIES, Quality, RenderJob, run_job
from render_jobs.processes import child_environment
from whacamole.body import BodyModel
from whacamole.motion import embedded_motions, find_motions, read_motion
from whacamole.production.filming import plan_camera
from whacamole.recipe import Recipe
from whacamole.take import stage_take

SCENES = {"walk": "courtyard", "dance_a": "living-room"}
"""Motion and stage: daylight from an environment map, and lamps in a room."""

MEASURED_FRAME = 1

BASE = Quality(name="base", samples=16)

BLENDER_DEFAULT = Quality(
    name="Blender's default", samples=4096, noise_threshold=0.01, denoise="high", prefilter="accurate",
    diffuse_bounces=4, glossy_bounces=4, light_tree=True,
)  # fmt: skip


def _variants(field: str, values: list[object], base: Quality = BASE) -> list[Quality]:
    return [base.model_copy(update={"name": f"{field}={value}", field: value}) for value in values]


SETTINGS: dict[str, list[Quality]] = {
    "presets": list(QUALITIES.values()),
    "denoiser": [
        BASE.model_copy(
            update={"name": f"{denoise}, prefilter {prefilter}", "denoise": denoise, "prefilter": prefilter}
        )
        for denoise, prefilter in (
            ("off", "none"),
            ("fast", "none"),
            ("balanced", "none"),
            ("high", "none"),
            ("balanced", "fast"),
            ("balanced", "accurate"),
            ("high", "accurate"),
        )
    ],
    "samples": _variants("samples", [2, 4, 8, 16, 32, 64, 128]),
    "adaptive": _variants(
        "noise_threshold", [0.02, 0.05, 0.1, 0.2], BASE.model_copy(update={"samples": 128})
    ),
    "diffuse": _variants("diffuse_bounces", [0, 1, 2, 3, 4]),
    "glossy": _variants("glossy_bounces", [0, 1, 2, 4]),
    "sampling": [*_variants("light_tree", [True]), *_variants("clamp_indirect", [0.0, 3.0])],
    "peers": [
        BLENDER_DEFAULT,
        BASE.model_copy(
            update={"name": "Kubric: 64, denoised", "samples": 64, "denoise": "high", "prefilter": "accurate"}
        ),
        Quality(
            name="BlenderProc: 1024, threshold 0.01",
            samples=1024,
            noise_threshold=0.01,
            denoise="high",
            prefilter="accurate",
            diffuse_bounces=3,
            glossy_bounces=0,
        ),
    ],
}


@dataclass(frozen=True)
class Measurement:
    """Error in 8-bit levels and CPU seconds of one frame of one scene."""

    error: float
    cpu_seconds: float


def main() -> None:
    """Measure and print."""
    options = _parse()
    jobs = {motion: _job(motion, stage, options) for motion, stage in SCENES.items()}
    references = {name: _reference(job, name, options) for name, job in jobs.items()}
    heads = [f"{motion}, {stage}: error | CPU s" for motion, stage in SCENES.items()]
    print("| setting | " + " | ".join(heads) + " |")
    print("|---" * (2 * len(heads) + 1) + "|")
    for group in options.settings:
        for quality in SETTINGS[group]:
            cells = []
            for name, job in jobs.items():
                found = _measure(replace(job, quality=quality), references[name], options.out / "run")
                cells.append(f"{found.error:.2f} | {found.cpu_seconds:.2f}")
            print(f"| {quality.name} | " + " | ".join(cells) + " |", flush=True)


def _parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--settings", nargs="+", choices=SETTINGS, default=["presets"], help="what to measure"
    )
    parser.add_argument("--size", default="320x180", help="WIDTHxHEIGHT of the image")
    parser.add_argument("--reference-samples", type=int, default=1024)
    parser.add_argument("--threads", type=int, default=0, help="CPU threads; 0 takes all cores")
    parser.add_argument("--out", type=Path, default=Path("build/benchmarks/rendering"))
    return parser.parse_args()


def _job(motion_name: str, stage: str, options: argparse.Namespace) -> RenderJob:
    """Two frames of a dressed person who is filmed as ``whacamole render`` would."""
    (file,) = find_motions(embedded_motions() / f"{motion_name}.npz")
    width, height = (int(side) for side in options.size.split("x"))
    take = stage_take(
        read_motion(file), BodyModel.embedded(), frames=2, seed=3, shot_index=0,
        textures=options.out / "textures" / stage, stages=(stage,),
    )  # fmt: skip
    plan = plan_camera(take, Recipe(size=(width, height), frames=2), 0)
    people = tuple(mesh for performer in take.performers for mesh in performer.meshes)
    return RenderJob(
        camera=plan.path,
        meshes=take.stage.meshes + people,
        lights=take.stage.lights,
        environment=take.stage.environment,
        exposure=take.stage.exposure,
        image_format="png",
    )


def _reference(job: RenderJob, name: str, options: argparse.Namespace) -> np.ndarray:
    """The measured frame with many samples and all light that bounces matter for."""
    quality = Quality(
        name="reference", samples=options.reference_samples, denoise="high", prefilter="accurate",
        diffuse_bounces=8, glossy_bounces=8, clamp_indirect=0.0, light_tree=True,
    )  # fmt: skip
    folder = options.out / f"reference-{name}"
    replace(job, quality=quality, passes=("rgb",)).save(folder)
    subprocess.run(
        [
            sys.executable, "-m", "render_jobs.worker", str(folder), "--threads", str(options.threads),
            "--frames", f"{MEASURED_FRAME}:{MEASURED_FRAME + 1}", "--device", "cpu",
        ],
        check=True, stdout=subprocess.DEVNULL, env=child_environment(),
    )  # fmt: skip
    return _picture(folder)


def _measure(job: RenderJob, reference: np.ndarray, folder: Path) -> Measurement:
    job.save(folder)
    shutil.rmtree(folder / "out", ignore_errors=True)  # measure again what was measured before
    result = run_job(folder, device="cpu", timeout=None)
    error = float(np.sqrt(np.mean((_picture(folder) - reference) ** 2)))
    return Measurement(error, result.frame_cpu_seconds[MEASURED_FRAME])


def _picture(folder: Path) -> np.ndarray:
    with Image.open(folder / "out" / "rgb" / f"{MEASURED_FRAME:06d}.png") as image:
        return np.asarray(image, dtype=np.float64)


if __name__ == "__main__":
    main()
