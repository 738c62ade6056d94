"""Scenes of the product's own for the rendering benchmarks, as jobs and as saved Blender files."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from render_jobs import Quality, RenderJob, quality_preset
from render_jobs.processes import child_environment
from whacamole.body import BodyModel
from whacamole.motion import embedded_motions, find_motions, read_motion
from whacamole.production.filming import camera_neighbours, plan_camera
from whacamole.recipe import Recipe
from whacamole.take import stage_take

SCENES = {"courtyard": "walk", "living-room": "dance_a", "night-street": "duet"}
"""Stage and motion: daylight from an environment map, lamps in a room, and two people under street lamps."""

WORK = Path("build/benchmarks/rendering")


def make_job(
    stage: str, size: tuple[int, int], frames: int, *, quality: Quality | None = None, out: Path = WORK
) -> RenderJob:
    """Dressed people on a stage, filmed as ``whacamole render`` would film them."""
    (file,) = (file for file in find_motions(embedded_motions()) if file.id == SCENES[stage])
    take = stage_take(
        read_motion(file), BodyModel.embedded(), frames=frames, seed=3, shot_index=0,
        textures=out / "textures" / stage, stages=(stage,),
    )  # fmt: skip
    plan = plan_camera(take, Recipe(size=size, frames=frames), 0)
    people = tuple(mesh for performer in take.performers for mesh in performer.meshes)
    return RenderJob(
        camera=plan.path,
        camera_neighbours=camera_neighbours(plan.path),
        meshes=take.stage.meshes + people,
        lights=take.stage.lights,
        environment=take.stage.environment,
        exposure=take.stage.exposure,
        quality=quality or quality_preset("standard"),
    )


def blender(*words: str | Path, log: Path) -> None:
    """Run :mod:`benchmarks.rendering.blender` in a child."""
    root = Path(__file__).resolve().parents[2]
    environment = child_environment()
    environment["PYTHONPATH"] = os.pathsep.join([str(root), environment["PYTHONPATH"]])
    log.parent.mkdir(parents=True, exist_ok=True)
    with log.open("ab") as output:
        subprocess.run(
            [sys.executable, "-m", "benchmarks.rendering.blender", *map(str, words)],
            check=True, env=environment, stdout=output, stderr=output,
        )  # fmt: skip


def saved_scene(job: RenderJob, folder: Path) -> Path:
    """The job as a Blender file in ``folder``."""
    job.save(folder / "job")
    blend = folder / "scene.blend"
    blender("save", folder / "job", blend, log=folder / "blender.log")
    return blend
