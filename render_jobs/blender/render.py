"""A job becomes a Blender scene, and the scene becomes frames.

Two view layers are rendered in one go: ``beauty`` makes the picture; ``labels`` takes one sample at the
centre of every pixel, so that mask, depth, normal and flow tell of one and the same surface, without
antialiasing or blur. The second layer costs about as much as one more sample a pixel. It is Cycles' in any
case; where another engine makes the picture, the two layers are rendered in turn, some frames at a time.

Motion blur is switched off for the second layer. Depth of field is a property of the camera and not of a
layer, so with it the two layers are rendered one after the other, some frames at a time.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

import bpy

from render_jobs.blender.camera import add_camera
from render_jobs.blender.compat import write_bitmap, write_multilayer_exr
from render_jobs.blender.cycles import set_up_cycles
from render_jobs.blender.geometry import add_mesh
from render_jobs.blender.lights import add_light, set_environment
from render_jobs.blender.materials import build_material
from render_jobs.devices import DeviceChoice
from render_jobs.job import RenderJob
from render_jobs.passes import LABEL_PASSES
from render_jobs.profile import DRAWING, WRITING, Profile

BEAUTY_LAYER = "beauty"
LABEL_LAYER = "labels"
CYCLES = "CYCLES"
VIEW_TRANSFORM = {"standard": ("Standard", "None"), "agx": ("AgX", "AgX - Medium High Contrast")}
LENS_BLOCK = 8
"""Frames rendered as pictures, then as labels, where depth of field keeps the two apart."""
EEVEE_BLOCK = 32
"""The same where two engines share the work: changing over takes as long as setting up the scene."""

ALPHA_SEEN = 0.5
"""A surface counts as seen, for the labels, from this opacity on."""


@dataclass(frozen=True)
class RawFrame:
    """What Blender left for a frame.

    Attributes:
        frame: its number.
        rgb: the picture as BMP, display-ready, or None where the job wants none.
        labels: a multilayer EXR, or None where the job wants no label.
    """

    frame: int
    rgb: Path | None
    labels: Path | None


def build_scene(job: RenderJob, scratch: Path, choice: DeviceChoice, threads: int) -> str:
    """Replace whatever Blender holds by the job's scene.

    Args:
        job: the job.
        scratch: a folder for vertex caches, kept until the render has ended.
        choice: the device.
        threads: CPU threads; 0 takes all cores.

    Returns:
        the devices that render, for people to read.

    Raises:
        RenderJobError: a texture cannot be read.
        EngineError: a GPU was insisted on and there is none.
    """
    bpy.ops.wm.read_factory_settings(use_empty=True)
    devices = set_up_cycles(job, choice, threads)
    materials: dict[str, Any] = {}
    for mesh in job.meshes:
        key = mesh.material.model_dump_json()
        if key not in materials:
            materials[key] = build_material(mesh.material)
        add_mesh(mesh, materials[key], scratch)
    for index, light in enumerate(job.lights):
        add_light(light, f"{light.kind}.{index}")
    set_environment(job.environment)
    add_camera(job)
    _set_layers(job)
    _set_output(job)
    return devices


def render_frames(
    job: RenderJob,
    frames: Iterable[int],
    scratch: Path,
    on_frame: Callable[[RawFrame], None],
    abort: Callable[[BaseException], NoReturn],
    profile: Profile,
    painter: str = CYCLES,
) -> None:
    """Render frames of the built scene; consecutive ones in one animation render.

    Args:
        job: the job the scene was built from.
        frames: ascending frame numbers.
        scratch: where raw frames go.
        on_frame: called in between frames, while Blender waits; it owns the files it is given.
        abort: called on an error between frames. Blender would print the exception and go on with the next
            frame, so this must end the process.
        profile: where the time of writing raw frames is counted.
        painter: Blender's name of the engine that makes the picture.
    """
    scene: Any = bpy.context.scene
    wants_rgb = "rgb" in job.passes
    wants_labels = any(name in LABEL_PASSES for name in job.passes)
    scene.render.filepath = str(scratch / "raw_")

    apart = (job.f_number is not None or painter != CYCLES) and wants_rgb and wants_labels
    block = None if not apart else LENS_BLOCK if painter == CYCLES else EEVEE_BLOCK
    layers = {BEAUTY_LAYER: wants_rgb, LABEL_LAYER: wants_labels}

    def picture_path(frame: int) -> Path:
        return scratch / f"rgb_{frame:06d}.bmp"

    rendered_at = 0.0

    def keep_picture(rendered: Any, *_: object) -> None:
        nonlocal rendered_at
        if rendered.render.engine != CYCLES:  # which says itself where its time goes
            profile.add(DRAWING, time.perf_counter() - rendered_at)
        rendered_at = time.perf_counter()
        try:
            if rendered.view_layers[BEAUTY_LAYER].use:
                _save_picture(rendered, picture_path(rendered.frame_current))
        except BaseException as error:
            abort(error)

    def finish(rendered: Any, *_: object) -> None:
        nonlocal rendered_at
        try:
            profile.add(WRITING, time.perf_counter() - rendered_at)
            rendered_at = time.perf_counter()
            frame = rendered.frame_current
            raw = Path(rendered.render.frame_path(frame=frame))
            if not rendered.view_layers[LABEL_LAYER].use:
                raw.unlink()
                if apart:
                    return
            on_frame(
                RawFrame(frame, picture_path(frame) if wants_rgb else None, raw if wants_labels else None)
            )
        except BaseException as error:
            abort(error)

    bpy.app.handlers.render_post.append(keep_picture)
    bpy.app.handlers.render_write.append(finish)
    try:
        for start, stop in _runs(frames, block):
            scene.frame_start, scene.frame_end = start, stop - 1
            for used in ([BEAUTY_LAYER], [LABEL_LAYER]) if apart else ([*layers],):
                for name, wanted in layers.items():
                    scene.view_layers[name].use = wanted and name in used
                scene.render.engine = painter if wants_rgb and BEAUTY_LAYER in used else CYCLES
                scene.camera.data.dof.use_dof = (
                    job.f_number is not None and BEAUTY_LAYER in used and wants_rgb
                )
                rendered_at = time.perf_counter()
                bpy.ops.render.render(animation=True)
    finally:
        bpy.app.handlers.render_post.remove(keep_picture)
        bpy.app.handlers.render_write.remove(finish)


def _runs(frames: Iterable[int], longest: int | None) -> list[tuple[int, int]]:
    """Ascending numbers as half-open ranges of at most ``longest``."""
    runs: list[tuple[int, int]] = []
    for frame in frames:
        if runs and runs[-1][1] == frame and frame - runs[-1][0] != longest:
            runs[-1] = (runs[-1][0], frame + 1)
        else:
            runs.append((frame, frame + 1))
    return runs


def _set_layers(job: RenderJob) -> None:
    scene: Any = bpy.context.scene
    beauty = scene.view_layers[0]
    beauty.name = BEAUTY_LAYER
    labels = scene.view_layers.new(LABEL_LAYER)
    labels.samples = 1
    labels.cycles.use_denoising = False
    labels.use_motion_blur = False
    labels.use_pass_combined = False
    labels.pass_alpha_threshold = ALPHA_SEEN
    labels.use_pass_z = (
        "depth" in job.passes or "flow" in job.passes
    )  # flow needs to know where there is no hit
    labels.use_pass_object_index = "mask" in job.passes
    labels.use_pass_normal = "normal" in job.passes
    labels.use_pass_vector = "flow" in job.passes


def _set_output(job: RenderJob) -> None:
    scene: Any = bpy.context.scene
    scene.render.use_compositing = False
    scene.render.use_sequencer = False
    scene.render.dither_intensity = 0.0
    scene.render.use_motion_blur = job.shutter > 0
    scene.render.motion_blur_shutter = job.shutter
    scene.render.motion_blur_position = "CENTER"
    scene.render.use_file_extension = True
    scene.display_settings.display_device = "sRGB"
    scene.view_settings.view_transform, scene.view_settings.look = VIEW_TRANSFORM[job.tone]
    scene.view_settings.exposure = job.exposure
    write_multilayer_exr(scene.render.image_settings)


def _save_picture(scene: Any, path: Path) -> None:
    """Write the frame just rendered, colour managed, and leave the settings as they were: for raw layers.

    BMP, as it is quick to write and holds no metadata; that of Blender's JPEG tells the time of day.
    """
    image = scene.render.image_settings
    write_bitmap(image)
    bpy.data.images["Render Result"].save_render(str(path), scene=scene)
    write_multilayer_exr(image)
