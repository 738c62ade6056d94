"""The raster engine's frames, put in place like those of any engine."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from render_jobs.colour import encoded
from render_jobs.devices import DeviceChoice
from render_jobs.encoding import Encoder, OnFrame
from render_jobs.images import Writer, label_writer, picture_writer
from render_jobs.job import RenderJob
from render_jobs.optics import flow_at_infinity
from render_jobs.passes import LABEL_PASSES
from render_jobs.profile import BUILDING, DRAWING, Profile
from render_jobs.raster.context import open_context

if TYPE_CHECKING:
    from render_jobs.raster.canvas import Canvas

Floats = NDArray[np.float32]

FEWEST_MOMENTS, MOST_MOMENTS = 16, 48
"""Pictures drawn for one with blur or depth of field; in between as many as the quality has samples."""

GOLDEN_ANGLE = np.pi * (3 - 5**0.5)

WHITE = 4.0
"""Linear light that becomes white under the ``agx`` tone: two stops of highlights are kept."""


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
) -> None:
    """Render frames of a job by OpenGL; arguments as in :func:`render_jobs.blender.engine.render`.

    The driver chooses the device, so ``device`` does not matter; nothing is written to ``scratch``.

    Raises:
        RenderJobError: a texture cannot be read.
        EngineError: there is no OpenGL, or it cannot show the job.
    """
    with profile.phase(BUILDING):
        devices = open_context(threads)
        from render_jobs.raster.canvas import Canvas  # needs the context

        canvas = Canvas(job)
    on_start(devices)
    with Encoder(out, job.image_format, on_frame, abort, profile) as encoder:
        for frame in frames:
            with profile.phase(DRAWING):
                canvas.set_frame(frame)
                drawn = canvas.labels() if any(name in LABEL_PASSES for name in job.passes) else None
                light = _exposed(canvas, job, frame) if "rgb" in job.passes else None
            encoder.put(frame, partial(_writers, job, frame, drawn, light))


def _writers(
    job: RenderJob, frame: int, drawn: tuple[Floats, ...] | None, light: Floats | None
) -> dict[str, Writer]:
    writers: dict[str, Writer] = {}
    if drawn is not None:
        for name, values in _labels(job, drawn, frame).items():
            writers[name] = label_writer(name, values, job.max_track_id)
    if light is not None:
        writers["rgb"] = picture_writer(_picture(job, light), job, frame)
    return writers


def _labels(job: RenderJob, drawn: tuple[Floats, ...], frame: int) -> dict[str, NDArray[Any]]:
    surface, normal, flow = drawn
    hit = surface[..., 1] > 0
    K, pose = job.camera_with_neighbours()
    now, after = frame + 1, frame + 2
    beyond = flow_at_infinity(K[now], K[after], pose[now], pose[after], job.camera.width, job.camera.height)
    found: dict[str, NDArray[Any]] = {
        "mask": np.rint(surface[..., 0]).astype(np.int32),
        "depth": np.where(hit, surface[..., 1], np.float32(np.inf)),
        "normal": np.where(hit[..., None], normal, np.float32(0.0)),
        "flow": np.where(hit[..., None], flow, beyond),
    }
    return {name: values for name, values in found.items() if name in job.passes}


def _exposed(canvas: Canvas, job: RenderJob, frame: int) -> Floats:
    """Linear light ``(H, W, 3)``: the mean over moments of the exposure and points of the lens."""
    if job.shutter == 0.0 and job.f_number is None:
        return canvas.picture()
    moments = exposure_samples(min(max(job.quality.samples, FEWEST_MOMENTS), MOST_MOMENTS))
    total = np.zeros((job.camera.height, job.camera.width, 3), np.float32)
    for moment, lens in moments:
        canvas.set_frame(frame, moment * job.shutter, lens)
        total += canvas.picture()
    return total / np.float32(len(moments))


def exposure_samples(count: int) -> list[tuple[float, tuple[float, float]]]:
    """Moments −½ … ½ of the exposure and points in the unit disc, each spread evenly, in no relation.

    The points are those of a sunflower; the moments come in the order of binary numbers read backwards.
    """
    index = np.arange(count)
    radius, angle = np.sqrt((index + 0.5) / count), index * GOLDEN_ANGLE
    rank = np.argsort(np.argsort([int(f"{i:08b}"[::-1], 2) for i in range(count)]))
    times = (rank + 0.5) / count - 0.5
    return [
        (float(t), (float(x), float(y)))
        for t, x, y in zip(times, radius * np.cos(angle), radius * np.sin(angle), strict=True)
    ]


def _picture(job: RenderJob, light: Floats) -> Image.Image:
    exposed = light * 2.0**job.exposure
    if job.tone == "agx":  # highlights roll off instead of clipping (Reinhard 2002, extended)
        exposed = exposed * (1.0 + exposed / WHITE**2) / (1.0 + exposed)
    return Image.fromarray(encoded(exposed))
