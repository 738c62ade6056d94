"""Rules about what each shot promises: spacing, direction, radius, place, overlap, staying put."""

import itertools

import numpy as np

from camera_rigs.rules.evidence import Evidence, Finding, worst
from camera_rigs.scene import SCALES
from camera_rigs.shot import Keyframe, Shot
from camera_rigs.shots.tracking import box_overlap, min_keyframe_gap
from camera_rigs.smoothing import at
from camera_rigs.spherical import Array, cartesian_to_spherical, wrap

ARCS = ("arc-horizontal", "arc-vertical", "orbit")
SMALLEST_STEP = np.radians(0.1)
"""Steps [rad] of an arc smaller than this count as no arc: their spacing is in the noise."""


def _spherical(evidence: Evidence, shot: Shot, begin: int, end: int) -> tuple[Array, Array, Array]:
    """(r, θ, φ unwrapped) (n,) of the camera about the shot's anchor from `begin` to `end`."""
    part = slice(begin - evidence.first, end + 1 - evidence.first)
    r, theta, phi = cartesian_to_spherical(evidence.offsets[SCALES[shot.scale].anchor][part])
    return r, theta, np.unwrap(phi)


def _swept(shot: Shot, theta: Array, phi: Array) -> tuple[Array, float]:
    """The angle that an arc sweeps, θ or φ, and the whole of it as it was asked for [rad]."""
    if shot.kind == "arc-vertical":
        return theta, shot.number("delta_theta")
    return phi, shot.number("delta_phi")


def _shake_angle(evidence: Evidence, r: Array) -> float:
    """The angle [rad] by which a shake displaces the camera on its circle."""
    return float(evidence.shake.bound(0) * 2.0 / r.min()) if evidence.shake else 0.0


def equal_spacing(evidence: Evidence) -> list[Finding]:
    """The keyframes of an arc are equally spaced in its angle, on the path as it is."""
    findings = []
    for shot, keyframes in evidence.settled_keyframes():
        if shot.kind not in ARCS or len(keyframes) < 3:
            continue
        times = np.array([k.frame for k in keyframes])
        begin, end = int(np.floor(times[0])), int(np.ceil(times[-1]))
        if end > evidence.last or begin < evidence.first:
            continue
        r, theta, phi = _spherical(evidence, shot, begin, end)
        swept, whole = _swept(shot, theta, phi)
        steps = np.diff(at(swept, times - begin))
        wanted = whole / (len(shot.keyframes) - 1)
        if abs(wanted) < SMALLEST_STEP:
            continue
        slack = 2.0 * _shake_angle(evidence, r) / abs(wanted)
        error = np.abs(steps - wanted) / abs(wanted)
        findings += worst("equal-spacing", "of a step", times[1:], error, evidence.limits.spacing + slack)
    return findings


def monotone(evidence: Evidence) -> list[Finding]:
    """An arc never runs backward."""
    findings = []
    for shot, begin, end in evidence.settled():
        if shot.kind not in ARCS:
            continue
        r, theta, phi = _spherical(evidence, shot, begin, end)
        swept, whole = _swept(shot, theta, phi)
        onward = np.sign(whole) * swept
        backward = np.degrees(np.maximum.accumulate(onward) - onward)
        slack = np.degrees(2.0 * _shake_angle(evidence, r))
        frames = np.arange(begin, end + 1)
        findings += worst("monotone-angle", "°", frames, backward, evidence.limits.backward + slack)
    return findings


def radius(evidence: Evidence) -> list[Finding]:
    """A shot that keeps its distance does; a push never moves away, a pull never nearer."""
    findings = []
    for shot, begin, end in evidence.settled():
        r, _, _ = _spherical(evidence, shot, begin, end)
        frames = np.arange(begin, end + 1)
        if shot.kind in (*ARCS, "tracking", "follow") and not shot.parameters.get("fracs"):
            wanted = shot.number("radius")
            error = np.abs(r / wanted - 1.0)
        elif shot.kind in ("push", "pull") and begin < end:
            wanted = float(r[0])
            way = r if shot.kind == "push" else -r
            error = (way - np.minimum.accumulate(way)) / wanted
        else:
            continue
        slack = 2.0 * evidence.shake.bound(0) / wanted if evidence.shake else 0.0
        findings += worst("radius", "of it", frames, error, evidence.limits.radius + slack)
    return findings


def tracking_place(evidence: Evidence) -> list[Finding]:
    """(r, θ_c, φ_c) is the same at every keyframe of a tracking shot."""
    findings = []
    for shot, keyframes in evidence.settled_keyframes():
        if shot.kind != "tracking":
            continue
        wanted = [shot.number(name) for name in ("radius", "theta", "phi")]
        errors = np.array([_misplacement(evidence, shot, k, *wanted) for k in keyframes])
        frames = np.array([k.frame for k in keyframes])
        slack = evidence.shake.bound(0) * np.sqrt(3.0) if evidence.shake else 0.0
        findings += worst("tracking-place", "m", frames, errors, evidence.limits.place + float(slack))
    return findings


def _misplacement(evidence: Evidence, shot: Shot, k: Keyframe, r: float, theta: float, phi: float) -> float:
    """How far [m] along the sphere the camera is from its place at a keyframe."""
    anchor = at(evidence.subject.anchor(SCALES[shot.scale].anchor), k.frame)
    there = cartesian_to_spherical(evidence.location_at(k.frame) - anchor)
    turned = float(np.abs(wrap(there[2] - k.heading - phi))) * np.sin(theta)
    return float(np.hypot(abs(there[0] - r), r * np.hypot(abs(there[1] - theta), turned)))


def overlap(evidence: Evidence) -> list[Finding]:
    """A keyframe of tracking or pan is set if and only if the boxes overlap by less than λ_overlap."""
    findings = []
    gap = min_keyframe_gap(evidence.subject.fps)
    for shot in evidence.shots:
        if shot.kind not in ("tracking", "pan"):
            continue
        limit = shot.number("lambda_overlap")
        low, high = limit - evidence.limits.overlap, limit + evidence.limits.overlap
        frames = [round(k.frame) for k in shot.keyframes]
        for last, fresh in itertools.pairwise(frames):
            between = box_overlap(evidence.subject, last, last + gap, fresh)
            times = np.arange(last + gap, last + gap + len(between))
            findings += worst("overlap", "IoU without a keyframe", times, between, low, least=True)
            if fresh != shot.end:
                reached = box_overlap(evidence.subject, last, fresh, fresh + 1)
                findings += worst("overlap", "IoU at a new keyframe", np.array([fresh]), reached, high)
    return findings


def fixed_location(evidence: Evidence) -> list[Finding]:
    """The camera of a pan or a static shot stays in its place."""
    findings = []
    for shot, begin, end in evidence.settled():
        if shot.kind not in ("pan", "static"):
            continue
        place = evidence.path.location[begin - evidence.first : end + 1 - evidence.first]
        drift = np.linalg.norm(place - place[0], axis=-1)
        slack = 2.0 * evidence.shake.bound(0) * np.sqrt(3.0) if evidence.shake else 0.0
        frames = np.arange(begin, end + 1)
        findings += worst("fixed-location", "m", frames, drift, evidence.limits.drift + float(slack))
    return findings


def coverage(evidence: Evidence) -> list[Finding]:
    """The shots follow each other without a gap."""
    gaps = np.array([abs(after.start - before.end) for before, after in itertools.pairwise(evidence.shots)])
    frames = np.array([shot.end for shot in evidence.shots[:-1]])
    findings = worst("coverage", "frames between shots", frames, gaps, 0.0)
    outside = max(evidence.shots[0].start - evidence.first, evidence.last - evidence.shots[-1].end, 0)
    frame = evidence.shots[-1].end if evidence.last > evidence.shots[-1].end else evidence.first
    return findings + worst("coverage", "frames without a shot", np.array([frame]), np.array([outside]), 0.0)
