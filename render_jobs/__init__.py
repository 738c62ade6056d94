"""A job in, pixels out: the only package that knows Blender and pyrender.

Each name is loaded when it is first used: a probe or a renderer that starts does not wait for all of them.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from render_jobs.errors import EngineError, RenderJobError, WorkerError
    from render_jobs.job import RenderJob
    from render_jobs.passes import DEFAULT_PASSES, PASSES, RenderPass
    from render_jobs.quality import QUALITIES, Quality, quality_preset
    from render_jobs.run import JobResult, missing_frames, run_job
    from render_jobs.scene import HDRI_NAMES, Environment, Lamp, Light, Material, Mesh, Sun

__all__ = [
    "DEFAULT_PASSES",
    "HDRI_NAMES",
    "PASSES",
    "QUALITIES",
    "EngineError",
    "Environment",
    "JobResult",
    "Lamp",
    "Light",
    "Material",
    "Mesh",
    "Quality",
    "RenderJob",
    "RenderJobError",
    "RenderPass",
    "Sun",
    "WorkerError",
    "missing_frames",
    "quality_preset",
    "run_job",
]

_HOMES = {
    "errors": ("EngineError", "RenderJobError", "WorkerError"),
    "job": ("RenderJob",),
    "passes": ("DEFAULT_PASSES", "PASSES", "RenderPass"),
    "quality": ("QUALITIES", "Quality", "quality_preset"),
    "run": ("JobResult", "missing_frames", "run_job"),
    "scene": ("HDRI_NAMES", "Environment", "Lamp", "Light", "Material", "Mesh", "Sun"),
}
"""By module: the names that it gives to the package."""

_HOME = {name: module for module, names in _HOMES.items() for name in names}


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
