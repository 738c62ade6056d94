"""Blender alone: what the rendering benchmarks run in a child process.

``save JOB FILE.blend`` turns a job folder into a saved scene; ``film FILE.blend OUT FRAMES`` renders it as
any script would, one multilayer EXR a frame; ``stills FILE.blend SETTINGS.json OUT`` renders one frame of it
under many settings and notes what each took in ``OUT/measured.json``. The last two know nothing of this
project: they open the file and render.
"""

from __future__ import annotations

import argparse
import json
import os
import time
from pathlib import Path
from typing import Any

MEASURED_FRAME = 1
"""Not the first: what is built once a job stands by then."""


def save(job_folder: Path, blend: Path) -> None:
    """Build the scene that the product would render, and save it."""
    import bpy

    from render_jobs import RenderJob
    from render_jobs.blender.render import build_scene
    from render_jobs.devices import parse_device

    scratch = blend.with_suffix(".scratch")
    scratch.mkdir(parents=True, exist_ok=True)
    job = RenderJob.load(job_folder)
    build_scene(job, scratch.resolve(), parse_device("cpu"), 0)
    scene: Any = bpy.context.scene
    scene.frame_start, scene.frame_end = 0, job.num_frames - 1
    bpy.ops.wm.save_as_mainfile(filepath=str(blend.resolve()))


def film(blend: Path, out: Path, frames: int) -> None:
    """Render the first frames of a saved scene, one multilayer EXR each."""
    import bpy

    bpy.ops.wm.open_mainfile(filepath=str(blend.resolve()))
    scene: Any = bpy.context.scene
    scene.frame_start, scene.frame_end = 0, frames - 1
    scene.render.filepath = str((out / "frame_").resolve())
    bpy.ops.render.render(animation=True)


def stills(blend: Path, settings: Path, out: Path) -> None:
    """Render the measured frame under each of the settings, and note what it took.

    The scene is synchronised before the first is timed, so that times are those of sampling and denoising.
    """
    import bpy

    bpy.ops.wm.open_mainfile(filepath=str(blend.resolve()))
    scene: Any = bpy.context.scene
    for layer in scene.view_layers:
        layer.use = layer.name == "beauty"
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGB"
    scene.frame_set(MEASURED_FRAME)
    every = json.loads(settings.read_text(encoding="utf-8"))
    _apply(scene, {**every[0]["cycles"], "samples": 1, "use_adaptive_sampling": False})
    _still(scene, out / "warm-up.png")
    measured = {}
    for entry in every:
        _apply(scene, entry["cycles"])
        began, cpu_began = time.perf_counter(), time.process_time()
        _still(scene, out / f"{entry['key']}.png")
        measured[entry["key"]] = {
            "seconds": time.perf_counter() - began,
            "cpu_seconds": time.process_time() - cpu_began,
        }
        beside = out / "measured.part"
        beside.write_text(json.dumps(measured), encoding="utf-8")
        beside.replace(out / "measured.json")


def _apply(scene: Any, values: dict[str, Any]) -> None:
    for name, value in values.items():
        setattr(scene.cycles, name, value)


def _still(scene: Any, path: Path) -> None:
    import bpy

    scene.render.filepath = str(path.resolve())
    bpy.ops.render.render(write_still=True)


def main() -> None:
    """Do one of the three."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    tasks = parser.add_subparsers(dest="task", required=True)
    task = tasks.add_parser("save")
    task.add_argument("job", type=Path)
    task.add_argument("blend", type=Path)
    task = tasks.add_parser("film")
    task.add_argument("blend", type=Path)
    task.add_argument("out", type=Path)
    task.add_argument("frames", type=int)
    task = tasks.add_parser("stills")
    task.add_argument("blend", type=Path)
    task.add_argument("settings", type=Path)
    task.add_argument("out", type=Path)
    given = vars(parser.parse_args())
    chosen = {"save": save, "film": film, "stills": stills}[given.pop("task")]
    names = {"job": "job_folder"}
    chosen(**{names.get(name, name): value for name, value in given.items()})
    os._exit(0)  # taking Blender down at the interpreter's exit can hang


if __name__ == "__main__":
    main()
