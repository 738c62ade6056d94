"""Blender's engines: build the scene, and put finished frames in place while the next one renders."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NoReturn

from render_jobs.blender.eevee_settings import set_up_eevee
from render_jobs.blender.phases import DENOISER_VERBOSITY, LogFollower, Phases
from render_jobs.blender.raw import read_labels
from render_jobs.blender.render import CYCLES, LABEL_LAYER, RawFrame, build_scene, render_frames
from render_jobs.devices import DeviceChoice
from render_jobs.encoding import Encoder, OnFrame
from render_jobs.images import Writer, label_writer, picture_writer, read_picture
from render_jobs.job import RenderJob
from render_jobs.profile import BUILDING, Profile
from render_jobs.protocol import LOG_FILE


def render(
    job: RenderJob,
    frames: Sequence[int],
    out: Path,
    scratch: Path,
    device: DeviceChoice,
    threads: int,
    on_start: Callable[[str], None],
    on_frame: OnFrame,
    abort: Callable[[BaseException], NoReturn],
    profile: Profile,
    painter: str = CYCLES,
) -> None:
    """Render frames of a job with Cycles.

    Args:
        job: the job.
        frames: ascending frame numbers.
        out: the output folder.
        scratch: a folder for temporary files.
        device: where to render.
        threads: CPU threads; 0 takes all cores.
        on_start: told the devices once the scene stands.
        on_frame: told of each frame that is in its place.
        abort: ends the process; used where an exception would be lost.
        profile: where the time goes.
        painter: Blender's name of the engine that makes the picture; the labels are Cycles' in any case.

    Raises:
        RenderJobError: a texture cannot be read.
        EngineError: a GPU was insisted on and there is none.
        RuntimeError: Blender reports an error.
    """
    os.environ.setdefault(*DENOISER_VERBOSITY)
    with profile.phase(BUILDING):
        devices = build_scene(job, scratch, device, threads)
        if painter != CYCLES:
            set_up_eevee(job)
            devices = f"EEVEE by OpenGL; labels by Cycles on {devices}"
    on_start(devices)
    with (
        Encoder(out, job.image_format, on_frame, abort, profile) as encoder,
        LogFollower(out.parent / LOG_FILE, Phases(profile, LABEL_LAYER)),
    ):
        render_frames(
            job,
            frames,
            scratch,
            lambda raw: encoder.put(raw.frame, lambda: _writers(job, raw)),
            abort,
            profile,
            painter,
        )


def _writers(job: RenderJob, raw: RawFrame) -> dict[str, Writer]:
    """What writes each pass of a raw frame; its files are read at once and removed."""
    writers: dict[str, Writer] = {}
    if raw.rgb is not None:
        writers["rgb"] = picture_writer(read_picture(raw.rgb), job, raw.frame)
        raw.rgb.unlink()
    if raw.labels is not None:
        for name, values in read_labels(raw.labels, job, raw.frame).items():
            writers[name] = label_writer(name, values, job.max_track_id)
        raw.labels.unlink()
    return writers
