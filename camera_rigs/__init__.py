"""Where the camera is: film-crew camera moves around people, in NumPy and SciPy alone."""

from camera_rigs.director import direct
from camera_rigs.errors import PlanError
from camera_rigs.lens import Lens
from camera_rigs.path import CameraPath, look_at
from camera_rigs.plan import Plan
from camera_rigs.rules import Finding
from camera_rigs.subject import SubjectTrack
from camera_rigs.world import Obstacle, World

__all__ = [
    "CameraPath",
    "Finding",
    "Lens",
    "Obstacle",
    "Plan",
    "PlanError",
    "SubjectTrack",
    "World",
    "direct",
    "look_at",
]
