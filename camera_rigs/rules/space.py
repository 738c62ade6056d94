"""Rules about where the camera may be: over the ground, clear of obstacles, walls and people."""

import numpy as np

from camera_rigs.rules.evidence import Evidence, Finding, worst
from camera_rigs.spherical import Array


def _frames(evidence: Evidence) -> Array:
    return np.arange(evidence.first, evidence.last + 1, dtype=float)


def ground(evidence: Evidence) -> list[Finding]:
    """The camera is over the ground."""
    height = evidence.path.location[:, 2] - evidence.world.ground_z
    return worst("ground", "m", _frames(evidence), height, evidence.limits.ground, least=True)


def obstacle(evidence: Evidence) -> list[Finding]:
    """The camera is clear of every obstacle."""
    gap = evidence.world.obstacle_distance(evidence.path.location)
    return worst("obstacle", "m", _frames(evidence), gap, evidence.limits.obstacle, least=True)


def wall(evidence: Evidence) -> list[Finding]:
    """The camera is inside the room, clear of walls and ceiling."""
    gap = evidence.world.wall_distance(evidence.path.location)
    return worst("wall", "m", _frames(evidence), gap, evidence.limits.wall, least=True)


def person(evidence: Evidence) -> list[Finding]:
    """The camera is clear of everybody's box."""
    low = evidence.of_people(evidence.subject.people_box_min)
    high = evidence.of_people(evidence.subject.people_box_max)
    eye = evidence.path.location
    gap = np.maximum(np.maximum(low - eye, eye - high), 0.0)
    distance = np.linalg.norm(gap, axis=-1).min(axis=0)
    return worst("person", "m", _frames(evidence), distance, evidence.limits.person, least=True)
