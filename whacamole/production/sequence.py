"""Making one sequence: read, stage, plan, render, label, finish. Complete in the dataset, or absent."""

import contextlib
import shutil
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from camera_rigs import Finding, Plan, PlanError
from render_jobs import PASSES, JobResult, RenderJob, missing_frames, quality_preset, run_job
from render_jobs.profile import STARTING, Profile, since_start
from render_jobs.standby import Standby
from whacamole.body import BodyModel
from whacamole.dataset import DatasetLayout, Sequence, SequenceLayout, write_summary
from whacamole.dataset.video import write_video
from whacamole.errors import MotionError, TakeError
from whacamole.labels.camera import Film
from whacamole.motion import Motion, MotionFile, read_motion
from whacamole.production.bodies import body_of
from whacamole.production.filming import camera_neighbours, film_of, plan_camera
from whacamole.production.labelling import write_labels
from whacamole.production.locations import places_of
from whacamole.production.overlap import beside
from whacamole.production.place import make_in_place
from whacamole.production.preview import write_preview
from whacamole.production.profiling import SequenceProfile
from whacamole.production.worker import Say
from whacamole.production.worklist import SequenceOrder, motion_checksum
from whacamole.recipe import Recipe
from whacamole.take import Take, stage_take

__all__ = ["make_sequence", "take_of"]

VIDEO_QUALITY = 12
"""Constant rate factor of rgb.mp4: a training set is no place to save the last third (benchmarks/disk.py)."""

SUBDIVISION = {"draft": 0, "standard": 0, "high": 1}
"""Levels for skin and clothes: the mesh is fine enough for all but close-ups."""


def make_sequence(
    order: SequenceOrder, say: Say, *, threads: int, device: str, silence_s: float, memory_mb: float | None
) -> None:
    """Make one sequence and move it into the dataset; do nothing where it is there already.

    Whatever an earlier attempt left behind is used where it belongs to the same work (finished frames), and
    made again where it does not.

    Args:
        threads: processor threads of the renderer; 0 takes all cores.
        device: "auto", "cpu" or "gpu".
        silence_s: seconds without a finished frame after which the renderer counts as hung.
        memory_mb: what the renderer may hold; None is no limit.

    Raises:
        MotionError, TakeError: the motion cannot be used.
        PlanError: no shot applies.
        RenderJobError: the frames cannot be rendered.
        PostponedError: another process is making this very sequence.
    """
    profile = Profile()
    profile.add(STARTING, since_start())
    rendered = 0
    run = partial(
        run_job,
        engine=order.recipe.engine,
        threads=threads,
        device=device,
        timeout=silence_s,
        memory_limit_mb=memory_mb,
    )

    def fill(sequence: SequenceLayout, work: Path) -> None:
        nonlocal rendered
        with Standby(order.recipe.engine, work / "standby.log") as standby:  # it loads Blender while we stage
            rendered = _make_in(order, sequence, work, say, profile, partial(run, standby=standby))

    if make_in_place(order.root, order.sequence_id, fill):
        layout = DatasetLayout(order.root)
        SequenceProfile.of(rendered, since_start(), profile.seconds).save(layout, order.sequence_id)


def _make_in(
    order: SequenceOrder,
    sequence: SequenceLayout,
    work: Path,
    say: Say,
    profile: Profile,
    run: Callable[..., JobResult],
) -> int:
    """Make all files of the sequence in the folder ``sequence``; return how many frames were rendered.

    Args:
        run: renders the job in the folder it is given.
    """
    recipe = order.recipe
    say("step", name="scene")
    with profile.phase("take"):
        body = body_of(recipe)
        take = take_of(order, textures=work / "textures")
    say("step", name="plan")
    with profile.phase("plan"):
        plan = plan_camera(take, recipe, order.shot_index)
    if plan.findings and not recipe.allow_breaches:
        raise PlanError(_breach(order, plan.findings[0]))
    film = film_of(take, plan, recipe, order.shot_index)
    folder = work / "job"
    with profile.phase("save the job"):
        job = render_job(take, plan, film, recipe)
        job.save(folder)
        shutil.rmtree(sequence.folder, ignore_errors=True)
        sequence.folder.mkdir(parents=True)
    there = take.num_frames - len(missing_frames(folder))
    say("step", name="render", frames=take.num_frames, done=there)

    def render(on_frame: Callable[[int], None]) -> int:
        result = run(folder, on_frame=on_frame)
        profile.merge(result.profile)
        return result.frames

    frames, labels = beside(
        folder,
        render,
        lambda ready, done: write_labels(
            take, plan, body, folder / "out", sequence, film, ready, done, recipe
        ),
        say,
        take.num_frames,
        profile,
    )
    with profile.phase("finish"):
        for name in job.passes:
            (folder / "out" / name).rename(sequence.folder / name)
        if recipe.image_format == "mp4":
            _to_video(sequence, take.num_frames, plan.path.fps)
        facts = _facts(order, take, plan, body, labels)
        write_preview(Sequence(order.sequence_id, sequence, facts), body)
        write_summary(sequence, facts)
    return frames


def _to_video(sequence: SequenceLayout, frames: int, fps: float) -> None:
    """Put the colour frames into one file, from pictures without loss."""
    files = (sequence.folder / PASSES["rgb"].file(frame, "png") for frame in range(frames))
    write_video(sequence.video, (np.asarray(Image.open(file)) for file in files), fps, quality=VIDEO_QUALITY)
    shutil.rmtree(sequence.folder / "rgb")


def _readable(files: tuple[MotionFile, ...], fps: float) -> list[Motion]:
    """Read the motions of further people; a damaged one costs one person, not the sequence."""
    motions = []
    for file in files:
        with contextlib.suppress(MotionError):  # told where it would have a sequence of its own
            motions.append(read_motion(file, fps=fps))
    return motions


def take_of(order: SequenceOrder, *, textures: Path | None) -> Take:
    """Read the motions of an order and stage them.

    Args:
        textures: folder for textures; None stages for planning alone.

    Raises:
        MotionError, TakeError: the motion cannot be used; the message names its file.
        BodyModelError: the recipe's body model cannot be used.
    """
    recipe = order.recipe
    motion = read_motion(order.motion, fps=recipe.fps)
    try:
        return stage_take(
            motion,
            body_of(recipe),
            frames=recipe.frames,
            seed=recipe.seed,
            shot_index=order.shot_index,
            textures=textures,
            places=places_of(recipe, DatasetLayout(order.root)),
            companions=_readable(order.companions, recipe.fps),
            subdivision=SUBDIVISION[recipe.quality],
            uv_textures=recipe.textures,
        )
    except TakeError as error:
        raise TakeError(f"{motion.path}: {error}") from error


def _breach(order: SequenceOrder, finding: Finding) -> str:
    measured = (
        f"{finding.rule} at frame {finding.frame}, {finding.value:.3g} where the limit is {finding.limit:.3g}"
    )
    return (
        f"{order.sequence_id}: no camera keeps all rules ({measured}); try other --shots or --allow-breaches"
    )


def render_job(take: Take, plan: Plan, film: Film, recipe: Recipe) -> RenderJob:
    """Return the job that films ``take`` by ``plan``."""
    focus = film.focus_distance
    people = tuple(mesh for performer in take.performers for mesh in performer.meshes)
    return RenderJob(
        camera=plan.path,
        camera_neighbours=camera_neighbours(plan.path),
        meshes=take.stage.meshes + people,
        lights=take.stage.lights,
        environment=take.stage.environment,
        shutter=film.shutter,
        f_number=None if focus is None else film.f_number,
        focus_distance=None if focus is None else np.pad(focus, 1, mode="edge"),
        exposure=film.exposure,
        noise=film.noise,
        quality=quality_preset(recipe.quality),
        passes=recipe.passes,
        image_format="png" if recipe.image_format == "mp4" else recipe.image_format,  # encoded at the end
        seed=film.noise_seed,
    )


def _facts(
    order: SequenceOrder, take: Take, plan: Plan, body: BodyModel, labels: dict[str, Any]
) -> dict[str, Any]:
    """Return what ``sequence.json`` says beside the checksums."""
    visible = labels["visible_fraction"][labels["valid"]]
    return {
        "id": order.sequence_id,
        "motion_id": take.motion.id,
        "motion_source": take.motion.source,
        "motion_sha256": motion_checksum(order.motion),
        "motion_licence": take.motion.licence,
        "first_frame": take.first_frame,
        "shot_index": order.shot_index,
        "frames": take.num_frames,
        "fps": plan.path.fps,
        "width": plan.path.width,
        "height": plan.path.height,
        "people": len(take.performers),
        "interactive": take.motion.interactive,
        "shots": [shot.kind for shot in plan.shots],
        "stage": take.stage.name,
        "engine": order.recipe.engine,
        "passes": list(order.recipe.passes),
        "image_format": order.recipe.image_format,
        "body_model": body.name,
        "mean_visible_fraction": round(float(visible.mean()), 6) if visible.size else 0.0,
    }
