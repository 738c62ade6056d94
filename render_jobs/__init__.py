"""A job in, pixels out: the only package that knows Blender and pyrender."""

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
