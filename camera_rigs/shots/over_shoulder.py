"""Over the shoulder: behind one of two people, past the shoulder, with the other one in view."""

from dataclasses import dataclass

import numpy as np

from camera_rigs.errors import PlanError
from camera_rigs.scene import PAIR_DISTANCE, SCALES, Scene, Span, View
from camera_rigs.shot import Draft, Move, keyframe_at, record
from camera_rigs.shots.pace import RIG_SPEED, Range, draw
from camera_rigs.smoothing import at, smootherstep
from camera_rigs.spherical import Array, cartesian_to_spherical, spherical_to_cartesian, wrap

BEHIND: Range = (1.0, 1.4)
"""Range [m] of the distance behind the neck: the shoulder fills the edge of the frame, not its half."""

BESIDE: Range = (0.45, 0.65)
"""Range [m] sideways of the neck: enough to see past the head."""

ABOVE = 0.15
"""Height [m] of the camera over the neck: at eye level."""

ARRIVAL_SHARE = 0.7
"""Share of the shot in which the camera travels to the shoulder; for the rest it stays there."""


@dataclass(frozen=True)
class Shoulder:
    """Whose shoulder, on which side, and how far from it.

    Attributes:
        person: index of the person seen from behind; the other one is in focus.
        side: +1 past the right shoulder, −1 past the left.
        behind, beside: distances from the neck [m].
    """

    person: int
    side: int
    behind: float
    beside: float


def plan_over_shoulder(scene: Scene, span: Span, view: View, *, shoulder: Shoulder) -> Draft:
    """From `view` to the place at `shoulder` and stay there, looking at the other person's neck."""
    check_pair(scene)
    frames = span.frames
    anchor = scene.anchor(view.scale, frames)
    spot = shoulder_place(scene, shoulder, span.lo, span.hi)
    r, theta, phi = cartesian_to_spherical(spot - anchor)
    start_phi = view.phi + float(at(scene.subject.azimuth, span.start))
    phi = np.unwrap(phi)
    phi = phi - phi[0] + start_phi + float(wrap(phi[0] - start_phi))
    come = smootherstep((frames - span.start) / (ARRIVAL_SHARE * span.length))
    eye = anchor + spherical_to_cartesian(
        view.r + come * (r - view.r),
        view.theta + come * (theta - view.theta),
        start_phi + come * (phi - start_phi),
    )
    focus = scene.subject.smooth_people_neck[1 - shoulder.person][span.lo : span.hi + 1]
    target = anchor + come[:, None] * (focus - anchor)
    ends = [span.start] if span.start == span.end else [span.start, span.end]
    keyframes = tuple(
        keyframe_at(scene, view.scale, k, eye[k - span.lo], view.focal, target=target[k - span.lo])
        for k in ends
    )
    parameters = {
        "person": shoulder.person,
        "side": shoulder.side,
        "behind": shoulder.behind,
        "beside": shoulder.beside,
    }
    shot = record("over-shoulder", view.scale, span, parameters, keyframes)
    return Draft(shot, Move.level(span, eye, target, view.focal))


def plan_over_shoulder_rand(
    rng: np.random.Generator,
    scene: Scene,
    span: Span,
    view: View,
    *,
    calm: float = 1.0,
    behind: Range = BEHIND,
    beside: Range = BESIDE,
) -> Draft:
    """Over the nearest of the four shoulders, if the camera can be there in time."""
    shoulders = _shoulders(rng, behind, beside)
    here = view.location(scene, span.start)
    places = [shoulder_place(scene, shoulder, span.start, span.start)[0] for shoulder in shoulders]
    nearest = int(np.argmin([np.linalg.norm(place - here) for place in places]))
    reach = RIG_SPEED * ARRIVAL_SHARE * span.length / scene.fps / 1.875 * calm
    if np.linalg.norm(places[nearest] - here) > max(reach, 1e-6):
        raise PlanError("over-shoulder: the next shoulder is too far away to travel there in time")
    return plan_over_shoulder(scene, span, view, shoulder=shoulders[nearest])


def over_shoulder_view_rand(rng: np.random.Generator, scene: Scene, focal: float) -> View:
    """A view to open a plan with: over one of the four shoulders."""
    check_pair(scene)
    shoulders = _shoulders(rng, BEHIND, BESIDE)
    place = shoulder_place(scene, shoulders[int(rng.integers(4))], 0, 0)[0]
    return View.from_location(scene, 0, place, SCALES["medium"], focal)


def check_pair(scene: Scene) -> None:
    """Raise `PlanError` unless there are two people at a distance in `PAIR_DISTANCE`."""
    if (reason := refuse_over_shoulder(scene)) is not None:
        raise PlanError(reason)


def refuse_over_shoulder(scene: Scene) -> str | None:
    """Why the shot cannot apply to the people, or None."""
    subject = scene.subject
    if subject.num_people != 2:
        return f"over-shoulder needs two people, the motion has {subject.num_people}"
    apart = np.linalg.norm(subject.people_neck[0] - subject.people_neck[1], axis=-1)
    share = float(np.mean((apart < PAIR_DISTANCE[0]) | (apart > PAIR_DISTANCE[1])))
    if share > 0.25:
        low, high = PAIR_DISTANCE
        return (
            f"over-shoulder needs people {low} to {high} m apart, these are not for {share:.0%} of the time"
        )
    return None


def shoulder_place(scene: Scene, shoulder: Shoulder, lo: int, hi: int) -> Array:
    """Where (N, 3) [m] the camera stands at a shoulder in the frames `lo` to `hi`."""
    near, far = scene.subject.smooth_people_neck[[shoulder.person, 1 - shoulder.person], lo : hi + 1]
    azimuth = scene.pair_azimuth[lo : hi + 1] + (0.0 if shoulder.person == 0 else np.pi)
    back = np.stack([np.cos(azimuth), np.sin(azimuth), np.zeros_like(azimuth)], axis=-1)
    right = np.stack([-back[:, 1], back[:, 0], np.zeros_like(azimuth)], axis=-1)
    apart = np.linalg.norm((near - far)[:, :2], axis=-1, keepdims=True)
    place: Array = 0.5 * (near + far) + (0.5 * apart + shoulder.behind) * back
    place += shoulder.side * shoulder.beside * right
    place[:, 2] = near[:, 2] + ABOVE
    return place


def _shoulders(rng: np.random.Generator, behind: Range, beside: Range) -> list[Shoulder]:
    far, wide = draw(rng, behind), draw(rng, beside)
    return [Shoulder(person, side, far, wide) for person in (0, 1) for side in (-1, 1)]
