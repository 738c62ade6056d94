"""Rules about what the camera sees: look-at, in frame, hidden."""

import numpy as np

from camera_rigs.lens import achieved_fraction
from camera_rigs.rules.evidence import Evidence, Finding, worst
from camera_rigs.scene import SCALES, Scale
from camera_rigs.shots.catalogue import KINDS
from camera_rigs.smoothing import at
from camera_rigs.spherical import Array, cartesian_to_spherical, wrap

OUT_SHARE = 0.1
"""In a clip so short that the allowed time would cover it, people may be out for this share of the frames."""


def look_at(evidence: Evidence) -> list[Finding]:
    """The camera looks at the anchor; a pan without tilt at its azimuth."""
    findings = []
    slack = np.degrees(evidence.shake.angle_bound() * np.sqrt(3.0)) if evidence.shake else 0.0
    for shot, begin, end in evidence.settled():
        aim = KINDS[shot.kind].aim
        if aim == "own":
            continue
        part = slice(begin - evidence.first, end + 1 - evidence.first)
        towards = -evidence.offsets[SCALES[shot.scale].anchor][part]
        forward = evidence.path.forward[part]
        if aim == "azimuth" and not shot.parameters.get("tilt", False):
            error = np.abs(wrap(_azimuth(towards) - _azimuth(forward)))
        else:
            error = _angle(towards, forward)
        distance = np.linalg.norm(towards, axis=-1)
        allowed = evidence.limits.look_at + slack + _displacement_angle(evidence, float(distance.min()))
        findings += worst("look-at", "°", np.arange(begin, end + 1), np.degrees(error), allowed)
    return findings


def _displacement_angle(evidence: Evidence, distance: float) -> float:
    """The angle [°] by which a displacement of the shake turns the direction to the anchor."""
    if evidence.shake is None:
        return 0.0
    return float(np.degrees(np.arctan2(evidence.shake.bound(0) * np.sqrt(3.0), max(distance, 1e-6))))


def _azimuth(direction: Array) -> Array:
    azimuth: Array = np.arctan2(direction[..., 1], direction[..., 0])
    return azimuth


def _angle(a: Array, b: Array) -> Array:
    """The angle (…) [rad] between vectors (…, 3), exact for small ones."""
    sine, cosine = np.linalg.norm(np.cross(a, b), axis=-1), np.einsum("...i,...i->...", a, b)
    angle: Array = np.arctan2(sine, cosine)
    return angle


def in_frame(evidence: Evidence) -> list[Finding]:
    """Neck and pelvis of everybody (the neck in medium shots and close-ups) are in the image."""
    subject, path = evidence.subject, evidence.path
    joints = np.stack([evidence.of_people(subject.people_neck), evidence.of_people(subject.people_pelvis)])
    pixels, depth = path.project(joints.transpose(2, 0, 1, 3))
    x, y = pixels[..., 0], pixels[..., 1]
    seen = (depth > 0.0) & (x >= 0.0) & (x < path.width) & (y >= 0.0) & (y < path.height)
    out = np.zeros(path.num_frames, dtype=bool)
    for shot in evidence.shots:
        part = slice(max(shot.start - evidence.first, 0), max(shot.end + 1 - evidence.first, 0))
        wanted = seen[part] if SCALES[shot.scale].anchor == "pelvis" else seen[part, :1]
        if shot.kind == "over-shoulder":
            focus = 1 - int(shot.number("person"))
            wanted = wanted[..., focus : focus + 1]
        out[part] |= ~wanted.all(axis=(1, 2))
    return _longest(evidence, "in-frame", out, evidence.limits.out_seconds)


def occlusion(evidence: Evidence) -> list[Finding]:
    """No obstacle hides most of the joints that the shot frames."""
    if not evidence.world.obstacles:
        return []
    subject = evidence.subject
    eye = evidence.path.location
    neck = evidence.world.hides(eye, evidence.of_people(subject.people_neck))
    pelvis = evidence.world.hides(eye, evidence.of_people(subject.people_pelvis))
    hidden = np.zeros(len(eye), dtype=bool)
    for anchor, begin, end in evidence.per_scale():
        part = slice(begin - evidence.first, end + 1 - evidence.first)
        joints = [neck[:, part], pelvis[:, part]] if anchor == "pelvis" else [neck[:, part]]
        hidden[part] = np.mean(joints, axis=(0, 1)) > 0.5
    return _longest(evidence, "occlusion", hidden, evidence.limits.hidden_seconds)


def _longest(evidence: Evidence, rule: str, bad: Array, seconds: float) -> list[Finding]:
    """The finding for the longest run of bad frames (N,) if it takes longer than allowed."""
    allowed = min(seconds, OUT_SHARE * evidence.subject.num_frames / evidence.subject.fps)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], bad.astype(int), [0]])))
    starts, stops = edges[::2], edges[1::2]
    return worst(rule, "s", starts + evidence.first, (stops - starts) / evidence.subject.fps, allowed)


def fraction(evidence: Evidence) -> list[Finding]:
    """At keyframes that ask for a fraction of the view the people fill it."""
    findings = []
    for shot, keyframes in evidence.settled_keyframes():
        scale = SCALES[shot.scale]
        asked = [(k.frame, k.frac) for k in keyframes if k.frac is not None]
        if not asked:
            continue
        errors = [abs(_achieved(evidence, scale, frame) / frac - 1.0) for frame, frac in asked]
        slack = 0.0
        if evidence.shake is not None:
            slack = 2.0 * evidence.shake.bound(0) * float(np.sqrt(3.0)) / min(k.r for k in keyframes)
        frames = [frame for frame, _ in asked]
        findings += worst("fraction", "of it", frames, errors, evidence.limits.fraction + slack)
    return findings


def _achieved(evidence: Evidence, scale: Scale, frame: float) -> float:
    """The fraction of the height of the view that the people fill at a frame of the path."""
    subject = evidence.subject
    offset = evidence.location_at(frame) - at(subject.anchor(scale.anchor), frame)
    r, theta, _ = cartesian_to_spherical(offset)
    above, below = (at(signal, frame) for signal in subject.extent(scale.anchor))
    focal = at(evidence.path.focal, frame - evidence.first)
    return float(achieved_fraction(above, below, r, scale.measured_from(theta), focal, evidence.path.height))
