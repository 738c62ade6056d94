"""Where the camera is: film-crew camera moves around people, in NumPy and SciPy alone."""

from camera_rigs.errors import PlanError
from camera_rigs.export import to_nerfstudio, to_tum
from camera_rigs.lens import Lens
from camera_rigs.path import CameraPath, look_at
from camera_rigs.plan import Mend, Plan, evidence_from_document, judge_document
from camera_rigs.planning import direct
from camera_rigs.rules import RULES, Evidence, Finding, Limits, judge
from camera_rigs.scene import SCALES
from camera_rigs.shake import Shake
from camera_rigs.shot import Keyframe, Shot
from camera_rigs.shots.catalogue import GROUPS, KINDS, resolve_shots
from camera_rigs.style import Style
from camera_rigs.subject import SubjectTrack
from camera_rigs.world import Obstacle, World

__all__ = [
    "GROUPS",
    "KINDS",
    "RULES",
    "SCALES",
    "CameraPath",
    "Evidence",
    "Finding",
    "Keyframe",
    "Lens",
    "Limits",
    "Mend",
    "Obstacle",
    "Plan",
    "PlanError",
    "Shake",
    "Shot",
    "Style",
    "SubjectTrack",
    "World",
    "direct",
    "evidence_from_document",
    "judge",
    "judge_document",
    "look_at",
    "resolve_shots",
    "to_nerfstudio",
    "to_tum",
]
