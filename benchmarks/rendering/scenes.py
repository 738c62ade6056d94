"""Scenes of the product's own for the rendering benchmarks, as jobs and as saved Blender files."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from render_jobs import RenderJob
from render_jobs.processes import child_environment
from whacamole.production.filming import film_of, plan_camera
from whacamole.production.sequence import render_job, take_of
from whacamole.production.worklist import SequenceOrder, work_of
from whacamole.recipe import Recipe

SCENES = {"courtyard": "walk", "living-room": "dance_a", "night-street": "duet"}
"""Stage and motion: daylight from an environment map, lamps in a room, and two people under street lamps."""

WORK = Path("build/benchmarks/rendering")


def order_of(motion: str, recipe: Recipe) -> SequenceOrder:
    """The first sequence of an embedded motion."""
    orders = work_of(recipe, WORK / "none").orders
    return next(order for order in orders if order.motion.id == motion)


def job_of(order: SequenceOrder, textures: Path) -> RenderJob:
    """The very job that ``whacamole render`` renders for the order."""
    take = take_of(order, textures=textures)
    plan = plan_camera(take, order.recipe, order.shot_index)
    film = film_of(take, plan, order.recipe, order.shot_index)
    return render_job(take, plan, film, order.recipe)


def make_job(
    stage: str, size: tuple[int, int], frames: int, *, out: Path, quality: str = "standard"
) -> RenderJob:
    """Dressed people on a stage of :data:`SCENES`, filmed as ``whacamole render`` films them."""
    recipe = Recipe.model_validate(
        {"size": size, "frames": frames, "stages": (stage,), "seed": 3, "quality": quality}
    )
    return job_of(order_of(SCENES[stage], recipe), out / "textures" / stage)


def blender(*words: str | Path, log: Path) -> None:
    """Run :mod:`benchmarks.rendering.blender` in a child."""
    environment = child_environment()
    root = str(Path(__file__).resolve().parents[2])
    environment["PYTHONPATH"] = os.pathsep.join([root, environment["PYTHONPATH"]])
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
