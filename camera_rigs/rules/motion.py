"""Rules about how the camera moves: finite and rigid, speed, acceleration, jerk, turn, zoom, horizon."""

import numpy as np

from camera_rigs.rules.evidence import Evidence, Finding, worst
from camera_rigs.smoothing import rate_of_change

RIGID = 1e-6
"""Largest deviation of a rotation matrix from an orthonormal, right-handed one."""


def finite(evidence: Evidence) -> list[Finding]:
    """Every number is finite and every pose is a rigid motion."""
    path = evidence.path
    R = path.T_world_camera[:, :3, :3]
    broken = ~np.isfinite(path.T_world_camera).all(axis=(1, 2)) | ~np.isfinite(path.K).all(axis=(1, 2))
    R = np.where(broken[:, None, None], np.eye(3), R)
    error = np.abs(R @ R.transpose(0, 2, 1) - np.eye(3)).max(axis=(1, 2))
    error = np.where(np.linalg.det(R) < 0.0, 2.0, error)
    frames = np.arange(evidence.first, evidence.last + 1)
    return worst("finite", "off a rigid pose", frames, np.where(broken, np.inf, error), RIGID)


def _bounded(evidence: Evidence, rule: str, unit: str, order: int, own: float) -> list[Finding]:
    values = rate_of_change(evidence.path.location, order, evidence.path.fps)
    frames = evidence.first + np.arange(len(values)) + order // 2
    slack = evidence.shake.bound(order) * np.sqrt(3.0) if evidence.shake else 0.0
    limit = own + evidence.subject.motion_bound(order) + float(slack)
    return worst(rule, unit, frames, values, limit)


def speed(evidence: Evidence) -> list[Finding]:
    """The camera is no faster than a rig, plus the people it travels with."""
    return _bounded(evidence, "speed", "m/s", 1, evidence.limits.speed)


def acceleration(evidence: Evidence) -> list[Finding]:
    """The velocity of the camera does not jump."""
    return _bounded(evidence, "acceleration", "m/s²", 2, evidence.limits.acceleration)


def jerk(evidence: Evidence) -> list[Finding]:
    """The acceleration of the camera does not jump."""
    return _bounded(evidence, "jerk", "m/s³", 3, evidence.limits.jerk)


def turn(evidence: Evidence) -> list[Finding]:
    """The camera neither whips nor flips."""
    R = evidence.path.T_world_camera[:, :3, :3]
    cosine = 0.5 * (np.einsum("tij,tij->t", R[:-1], R[1:]) - 1.0)
    # The Frobenius distance is 2√2 sin(angle/2): exact where the arc cosine of a tiny angle loses its digits.
    half = np.linalg.norm(R[1:] - R[:-1], axis=(1, 2)) / (2.0 * np.sqrt(2.0))
    angle = np.where(
        cosine > 0.0, 2.0 * np.arcsin(np.clip(half, 0.0, 1.0)), np.arccos(np.clip(cosine, -1.0, 1.0))
    )
    slack = evidence.shake.angle_bound(1) * np.sqrt(3.0) if evidence.shake else 0.0
    frames = evidence.first + np.arange(len(angle))
    limit = evidence.limits.turn + float(np.degrees(slack))
    return worst("turn", "°/s", frames, np.degrees(angle) * evidence.path.fps, limit)


def zoom(evidence: Evidence) -> list[Finding]:
    """The focal length does not jump."""
    change = np.abs(np.diff(np.log(evidence.path.focal))) * evidence.path.fps
    frames = evidence.first + np.arange(len(change))
    return worst("zoom", "1/s", frames, change, evidence.limits.zoom)


def horizon(evidence: Evidence) -> list[Finding]:
    """The horizon is level and the camera is not upside down."""
    right, down = evidence.path.T_world_camera[:, :3, 0], evidence.path.T_world_camera[:, :3, 1]
    tilt = np.degrees(np.arctan2(np.abs(right[:, 2]), np.hypot(right[:, 0], right[:, 1])))
    tilt = np.where(down[:, 2] > 0.0, 180.0 - tilt, tilt)
    slack = np.degrees(2.0 * evidence.shake.angle_bound()) if evidence.shake else 0.0
    frames = np.arange(evidence.first, evidence.last + 1)
    return worst("horizon", "°", frames, tilt, evidence.limits.horizon + float(slack))
