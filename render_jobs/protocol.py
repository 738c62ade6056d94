"""What a worker and the process that starts it agree on."""

from __future__ import annotations

ENGINES = {
    "cycles": "render_jobs.blender.engine",
    "raster": "render_jobs.raster.engine",
    "eevee": "render_jobs.blender.eevee",
}
"""The module behind each engine; imported only when used, in the worker."""

BY_ITSELF = ("cycles", "raster")
"""What is chosen where no engine is named, best first. EEVEE without a GPU is slower than Cycles."""

LOG_FILE = "render.log"
"""In the job folder: everything that a worker prints."""

FAILED, BAD_JOB, NO_ENGINE = 1, 2, 3
"""Exit statuses of a worker: another try may help; it cannot; not on this machine."""
