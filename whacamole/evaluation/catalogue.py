"""The list of metrics: what each is called, its unit, which way is better and where it is counted."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

Level = Literal["person_frame", "frame", "person", "sequence"]
Better = Literal["lower", "higher", "one", "none"]
Group = Literal["camera", "world", "motion", "film", "scene", "contact"]


@dataclass(frozen=True)
class Metric:
    """One number.

    Attributes:
        key: its name in results.
        label: its name in tables.
        unit: as printed, "" for a plain ratio.
        level: where its values lie: ``person_frame`` (P, T), ``frame`` (T,), ``person`` (P,), ``sequence``
            ().
        better: which way is better; "one": nearest to 1; "none": a description.
        group: the table it belongs to.
        digits: decimals printed.
        about: one line.
    """

    key: str
    label: str
    unit: str
    level: Level
    better: Better
    group: Group
    digits: int
    about: str


_ALL = (
    Metric("mpjpe", "MPJPE", "mm", "person_frame", "lower", "camera", 1, "joints, root aligned"),
    Metric("pa_mpjpe", "PA-MPJPE", "mm", "person_frame", "lower", "camera", 1, "joints, similarity a frame"),
    Metric("t_mpjpe", "T-MPJPE", "mm", "person_frame", "lower", "camera", 1, "joints in the camera's frame"),
    Metric("pve", "PVE", "mm", "person_frame", "lower", "camera", 1, "vertices, root aligned"),
    Metric("pa_pve", "PA-PVE", "mm", "person_frame", "lower", "camera", 1, "vertices, similarity a frame"),
    Metric("t_pve", "T-PVE", "mm", "person_frame", "lower", "camera", 1, "vertices in the camera's frame"),
    Metric(
        "pve_hands", "PVE-hands", "mm", "person_frame", "lower", "camera", 1, "hand vertices, wrist aligned"
    ),
    Metric("pve_face", "PVE-face", "mm", "person_frame", "lower", "camera", 1, "face vertices, neck aligned"),
    Metric("mpjae", "MPJAE", "°", "person_frame", "lower", "camera", 1, "global angle of nine joints"),
    Metric("pa_mpjae", "PA-MPJAE", "°", "person_frame", "lower", "camera", 1, "the same after PA's rotation"),
    Metric(
        "accel", "Accel", "m/s²", "person_frame", "lower", "camera", 1, "joint acceleration, root aligned"
    ),
    Metric(
        "w_mpjpe", "W-MPJPE", "mm", "person_frame", "lower", "world", 1, "segment aligned on its first frames"
    ),
    Metric(
        "wa_mpjpe", "WA-MPJPE", "mm", "person_frame", "lower", "world", 1, "segment aligned on all its frames"
    ),
    Metric(
        "w_mpjpe_rigid", "W-MPJPE-rigid", "mm", "person_frame", "lower", "world", 1, "W-MPJPE without scale"
    ),
    Metric(
        "wa_mpjpe_rigid",
        "WA-MPJPE-rigid",
        "mm",
        "person_frame",
        "lower",
        "world",
        1,
        "WA-MPJPE without scale",
    ),
    Metric("h_ate", "H-ATE", "mm", "person", "lower", "world", 1, "root path after alignment, mean"),
    Metric("h_ate_rmse", "H-ATE-RMSE", "mm", "person", "lower", "world", 1, "the same, root mean square"),
    Metric("h_as", "H-AS", "", "person", "one", "world", 2, "scale from prediction to truth"),
    Metric("rte", "RTE", "%", "person_frame", "lower", "world", 2, "root path, rigid, by its true length"),
    Metric("erve", "ERVE", "mm", "person_frame", "lower", "motion", 1, "root velocity in the body's frame"),
    Metric(
        "jitter", "Jitter", "10 m/s³", "person_frame", "lower", "motion", 1, "jerk of the predicted joints"
    ),
    Metric(
        "foot_sliding", "FS", "mm", "person_frame", "lower", "motion", 1, "motion of feet that should stand"
    ),
    Metric("c_ate", "C-ATE", "mm", "sequence", "lower", "film", 1, "camera path after alignment, mean"),
    Metric("c_ate_rmse", "C-ATE-RMSE", "mm", "sequence", "lower", "film", 1, "the same, root mean square"),
    Metric("c_as", "C-AS", "", "sequence", "one", "film", 2, "scale from prediction to truth"),
    Metric("c_ate_rigid", "C-ATE-S", "mm", "sequence", "lower", "film", 1, "camera path, rigid, mean"),
    Metric("c_rpe_t", "C-RPE-t", "mm", "frame", "lower", "film", 2, "camera translation a frame"),
    Metric("c_rpe_r", "C-RPE-r", "°", "frame", "lower", "film", 3, "camera rotation a frame"),
    Metric(
        "pair_pa_mpjpe",
        "Pair-PA-MPJPE",
        "mm",
        "frame",
        "lower",
        "scene",
        1,
        "two people, one similarity a frame",
    ),
    Metric(
        "sw_mpjpe",
        "SW-MPJPE",
        "mm",
        "person_frame",
        "lower",
        "scene",
        1,
        "all people and camera, one rigid motion",
    ),
    Metric(
        "sw_camera", "SW-camera", "mm", "frame", "lower", "scene", 1, "the camera's centre in that alignment"
    ),
    Metric("sw_offset", "SW-offset", "mm", "frame", "lower", "scene", 1, "vectors between people and camera"),
    Metric(
        "foot_precision",
        "Foot P",
        "",
        "person_frame",
        "higher",
        "contact",
        3,
        "standing feet, by displacement",
    ),
    Metric(
        "foot_recall", "Foot R", "", "person_frame", "higher", "contact", 3, "standing feet, by displacement"
    ),
    Metric(
        "foot_f1", "Foot F1", "", "person_frame", "higher", "contact", 3, "standing feet, by displacement"
    ),
    Metric(
        "ground_precision", "Ground P", "", "person_frame", "higher", "contact", 3, "labelled ground contact"
    ),
    Metric(
        "ground_recall", "Ground R", "", "person_frame", "higher", "contact", 3, "labelled ground contact"
    ),
    Metric("ground_f1", "Ground F1", "", "person_frame", "higher", "contact", 3, "labelled ground contact"),
)

METRICS: Mapping[str, Metric] = MappingProxyType({metric.key: metric for metric in _ALL})
"""All metrics by key, in the order of the tables."""

GROUPS: Mapping[Group, str] = MappingProxyType(
    {
        "camera": "In the camera's frame",
        "world": "In the world",
        "motion": "Quality of motion",
        "film": "Camera",
        "scene": "The scene as a whole",
        "contact": "Contact",
    }
)
"""Titles of the tables."""


def metrics_of(group: Group) -> tuple[str, ...]:
    """Keys of one table."""
    return tuple(key for key, metric in METRICS.items() if metric.group == group)
