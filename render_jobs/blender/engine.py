"""The Cycles engine: builds the scene, and puts finished frames in place while the next one renders."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NoReturn

from render_jobs.blender.raw import read_labels
from render_jobs.blender.render import RawFrame, build_scene, render_frames
from render_jobs.devices import DeviceChoice
from render_jobs.images import Writer, label_writer, picture_writer, publish_frame
from render_jobs.job import RenderJob

FRAMES_WAITING = 3
"""Raw frames that may wait to be encoded: a slow disk slows the renderer down instead of filling the disk."""


def render(
    job: RenderJob,
    frames: Sequence[int],
    out: Path,
    scratch: Path,
    device: DeviceChoice,
    threads: int,
    on_start: Callable[[str], None],
    on_frame: Callable[[int, float, float], None],
    abort: Callable[[BaseException], NoReturn],
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
        on_frame: told of each frame that is in its place: number, seconds, CPU seconds of all threads.
        abort: ends the process; used where an exception would be lost.

    Raises:
        RenderJobError: a texture cannot be read.
        EngineError: a GPU was insisted on and there is none.
        RuntimeError: Blender reports an error.
    """
    on_start(build_scene(job, scratch, device, threads))
    slots = threading.Semaphore(FRAMES_WAITING)
    began, cpu_began = time.perf_counter(), time.process_time()

    def finish(raw: RawFrame, seconds: float, cpu_seconds: float) -> None:
        try:
            publish_frame(out, raw.frame, _writers(job, raw), job.image_format)
            for path in (raw.rgb, raw.labels):
                if path is not None:
                    path.unlink(missing_ok=True)
            on_frame(raw.frame, seconds, cpu_seconds)
        except BaseException as error:
            abort(error)
        finally:
            slots.release()

    with ThreadPoolExecutor(1, "encode") as encoder:

        def hand_over(raw: RawFrame) -> None:
            nonlocal began, cpu_began
            slots.acquire()
            now, cpu_now = time.perf_counter(), time.process_time()
            encoder.submit(finish, raw, now - began, cpu_now - cpu_began)
            began, cpu_began = now, cpu_now

        render_frames(job, frames, scratch, hand_over, abort)


def _writers(job: RenderJob, raw: RawFrame) -> dict[str, Writer]:
    writers: dict[str, Writer] = {}
    if raw.rgb is not None:
        writers["rgb"] = picture_writer(raw.rgb, job, raw.frame)
    if raw.labels is not None:
        for name, values in read_labels(raw.labels, job, raw.frame).items():
            writers[name] = label_writer(name, values, job.max_track_id)
    return writers
