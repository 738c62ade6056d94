"""The director: which shot when, joined into one camera path without a jump."""

from collections.abc import Sequence

import numpy as np

from camera_rigs.lens import Lens
from camera_rigs.path import path_from_rig
from camera_rigs.plan import Plan
from camera_rigs.shots.arc import plan_arc
from camera_rigs.shots.base import SCALES, Move, Scene, Shot, Span, View
from camera_rigs.shots.tracking import plan_tracking
from camera_rigs.smoothing import smootherstep
from camera_rigs.spherical import Array
from camera_rigs.subject import SubjectTrack
from camera_rigs.world import World

LAMBDA_BBOX = 2.0
TRANSITION_SECONDS = 1.0
MIN_SHOT_SECONDS = 1.5
MAX_SHOT_SECONDS = 4.0


def direct(
    subject: SubjectTrack,
    lens: Lens,
    world: World,
    shots: str | Sequence[str],
    rng: np.random.Generator,
) -> Plan:
    """Plan a camera for the people."""
    scene = Scene(subject, lens, world)
    scale = SCALES["full" if rng.random() < 0.5 else "medium"]
    theta = np.radians(rng.uniform(70.0, 95.0))
    view = View(
        scale,
        scene.radius(0, rng.uniform(scale.frac_min, scale.frac_max), theta, scale),
        theta,
        np.radians(rng.uniform(-60.0, 60.0)),
        lens.focal,
    )
    spans = spans_of(subject.num_frames, subject.fps, rng)
    travel = np.ptp(subject.smooth_pelvis, axis=0).max()
    planned: list[Shot] = []
    for span in spans:
        if travel >= LAMBDA_BBOX and subject.num_people == 1:
            shot = plan_tracking(scene, span, view)
        elif len(planned) % 2 == 0:
            degrees = rng.choice([-1.0, 1.0]) * rng.uniform(8.0, 15.0) * span.length / scene.fps
            shot = plan_arc(scene, span, view, delta_phi=float(np.radians(degrees)))
        else:
            goal = np.radians(rng.uniform(60.0, 95.0))
            shot = plan_arc(scene, span, view, delta_theta=float(goal - view.theta), kind="arc-vertical")
        planned.append(shot)
        eye = shot.move.eye[span.end - span.lo]
        view = View.from_location(scene, span.end, eye, view.scale, view.focal)
    eye, target, focal, roll = compose([s.move for s in planned], [s.end for s in planned[:-1]], subject)
    return Plan(path_from_rig(eye, target, focal, roll, lens, subject.fps), tuple(planned))


def spans_of(num_frames: int, fps: float, rng: np.random.Generator) -> list[Span]:
    """Cut the frames into shots of MIN_SHOT_SECONDS to MAX_SHOT_SECONDS."""
    bounds = [0]
    while (num_frames - 1 - bounds[-1]) / fps >= 2.0 * MIN_SHOT_SECONDS:
        left = (num_frames - 1 - bounds[-1]) / fps
        seconds = rng.uniform(MIN_SHOT_SECONDS, min(MAX_SHOT_SECONDS, left - MIN_SHOT_SECONDS))
        bounds.append(bounds[-1] + max(1, round(seconds * fps)))
    bounds.append(num_frames - 1)
    half = round(0.5 * TRANSITION_SECONDS * fps)
    return [
        Span(a, b, max(a - half, 0), min(b + half, num_frames - 1))
        for a, b in zip(bounds[:-1], bounds[1:], strict=True)
    ]


def compose(moves: list[Move], joints: list[int], subject: SubjectTrack) -> tuple[Array, Array, Array, Array]:
    """Blend overlapping moves: eye, target (T, 3), focal, roll (T,)."""
    n = subject.num_frames
    half = 0.5 * TRANSITION_SECONDS * subject.fps
    eye, target, focal, roll = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros(n), np.zeros(n)
    for i, move in enumerate(moves):
        frames = np.arange(move.lo, move.lo + len(move.eye))
        weight = np.ones(len(frames))
        if i > 0:
            weight *= smootherstep((frames - joints[i - 1] + half) / (2 * half))
        if i < len(joints):
            weight *= 1.0 - smootherstep((frames - joints[i] + half) / (2 * half))
        eye[frames] += weight[:, None] * move.eye
        target[frames] += weight[:, None] * move.target
        focal[frames] += weight * move.focal
        roll[frames] += weight * move.roll
    return eye, target, focal, roll
