"""From camera-frame people and scale-free odometry to people and camera in one metric world."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

from whacamole.baseline import method
from whacamole.baseline.modes import Components, Mode
from whacamole.baseline.odometry import Odometry
from whacamole.baseline.people import PersonEstimate, rest_pelvis
from whacamole.baseline.resampling import Resampling
from whacamole.baseline.rigid import BoolArray, FloatArray, rigid, runs_of
from whacamole.baseline.velocimeter import FPS, WINDOW
from whacamole.body import BodyModel
from whacamole.evaluation.core.alignment import Similarity

SHORTEST = 8
"""Frames of the shortest stretch of a person that says anything about the scale."""

Velocimeter = Callable[[list[FloatArray]], list[FloatArray]]
"""From canonical windows (n, 15, 3) to velocities (n, 3) [m a frame at 30 fps]."""


@dataclass(frozen=True, eq=False)
class Stretch:
    """A person over consecutive frames, in the axes of the odometry's world.

    Attributes:
        person: place in the list of people.
        frames: where in the video.
        joints: (n, 15, 3) [m], the camera's own place left out.
        orient: (n, 3, 3) root in the world.
        root: (n, 3) root relative to the camera, in the world's axes [m].
    """

    person: int
    frames: slice
    joints: FloatArray
    orient: FloatArray
    root: FloatArray

    @property
    def num_frames(self) -> int:
        """n."""
        return len(self.root)


@dataclass(frozen=True, eq=False)
class Recovery:
    """A metric world: its origin and axes are those of the first valid camera.

    Attributes:
        T_world_camera: (T, 4, 4) [m]; identity where not valid.
        camera_valid: (T,).
        scale: metres for a unit of the odometry; NaN where nothing tells it (nobody seen, or no translation).
        paths: (person, frames, path (n, 3) [m] from the velocimeter), one for each stretch.
    """

    T_world_camera: FloatArray
    camera_valid: BoolArray
    scale: float
    paths: tuple[tuple[int, slice, FloatArray], ...]


def recover(
    people: Sequence[PersonEstimate],
    odometry: Odometry,
    fps: float,
    body: BodyModel,
    velocimeter: Velocimeter,
    mode: Mode,
    components: Components = "both",
) -> Recovery:
    """WHAC on one video.

    Args:
        people: estimates in the camera frame, of the odometry's T frames.
        odometry: the camera's trajectory, of no scale.
        fps: of the video.
        body: the model of the estimates.
        velocimeter: a :class:`~whacamole.baseline.velocimeter.MotionVelocimeter`'s ``windows``, or an oracle.
        mode: how exactly.
        components: leave one of the two sources out, for the ablation.
    """
    stretches = [
        stretch
        for index, person in enumerate(people)
        for stretch in _stretches(index, person, odometry, body, mode)
    ]
    paths = _paths(stretches, fps, velocimeter, mode) if components != "vo" else []
    derived = [_derived(stretch, path, odometry) for stretch, path in zip(stretches, paths, strict=False)]
    told = tuple((s.person, s.frames, path) for s, path in zip(stretches, paths, strict=False))
    if components == "mv":
        return _derived_alone(stretches, derived, odometry, told)
    vo = [odometry.T_vo[stretch.frames, :3, 3] for stretch in stretches]
    similarity = _similarity(vo, derived, stretches, mode) if derived else _unscaled()
    known = components == "both" and np.isfinite(similarity.scale) and bool(derived)
    final = method.final_camera(odometry.T_vo, similarity if known else _unscaled())
    scale = float(similarity.scale) if known else float("nan")
    return Recovery(_origin_at_first(final, odometry.valid), odometry.valid, scale, told)


def _stretches(
    index: int, person: PersonEstimate, odometry: Odometry, body: BodyModel, mode: Mode
) -> list[Stretch]:
    joints = body.pose_joints(person.params)[:, list(method.VELOCIMETER_JOINTS)]
    roots = joints[:, 0] if mode.root == "pelvis" else person.params.transl
    orient = Rotation.from_rotvec(person.params.global_orient).as_matrix()
    found = []
    for frames in runs_of(person.valid & odometry.valid, SHORTEST):
        T_vo = odometry.T_vo[frames]
        root = roots[frames]
        if mode.smoothing > 0.0:
            root = gaussian_filter1d(root, mode.smoothing, axis=0, mode="nearest")
        world = method.joints_to_world(joints[frames], T_vo)
        turned = method.turned_roots(T_vo, root)
        found.append(Stretch(index, frames, world, T_vo[:, :3, :3] @ orient[frames], turned))
    return found


def _paths(stretches: list[Stretch], fps: float, velocimeter: Velocimeter, mode: Mode) -> list[FloatArray]:
    """The root's path (n, 3) [m] of every stretch, from its own origin, by the velocimeter."""
    windows: list[FloatArray] = []
    places: list[list[tuple[int, int, FloatArray]]] = []
    evens = [Resampling(stretch.num_frames, fps, FPS) for stretch in stretches]
    for stretch, even in zip(stretches, evens, strict=True):
        joints, orient = even.points(stretch.joints - stretch.joints[:, :1]), even.rotations(stretch.orient)
        places.append([])
        for start, counted in _window_starts(len(joints), mode.overlap):
            windows.append(method.canonicalise(joints[start : start + WINDOW], orient[start]))
            places[-1].append((start, counted, orient[start]))
    velocities = iter(velocimeter(windows))
    paths = []
    for even, place in zip(evens, places, strict=True):
        parts = [
            method.decanonicalise(next(velocities), first)[counted - start :]
            for start, counted, first in place
        ]
        paths.append(even.back(method.trajectory(np.concatenate(parts))))
    return paths


def _window_starts(num_frames: int, overlap: bool) -> list[tuple[int, int]]:
    """(first frame, first frame whose velocity counts) of the windows that cover the frames once."""
    if not overlap:
        return [(start, start) for start in range(0, num_frames, WINDOW)]
    half = WINDOW // 2
    later = range(WINDOW, num_frames, half)
    return [(0, 0), *((start - half, start) for start in later)]


def _derived(stretch: Stretch, path: FloatArray, odometry: Odometry) -> FloatArray:
    """Camera centres (n, 3) [m] derived from a person's path."""
    R_vo = odometry.T_vo[stretch.frames, :3, :3]
    in_camera = np.swapaxes(R_vo, -1, -2)
    T_camera_human = rigid(in_camera @ stretch.orient, np.einsum("tij,tj->ti", in_camera, stretch.root))
    derived = method.derived_camera(method.human_poses(stretch.orient, path), T_camera_human)
    return derived[:, :3, 3]


def _similarity(
    vo: list[FloatArray], derived: list[FloatArray], stretches: list[Stretch], mode: Mode
) -> Similarity:
    if mode.alignment == "similarity":
        return method.align(vo, derived)
    if mode.alignment == "scale":
        return _scaled(method.align_scale(vo, derived))
    frames = np.bincount([s.person for s in stretches], weights=[s.num_frames for s in stretches])
    longest = int(frames.argmax())
    scales = [
        method.window_scales(path[start : start + WINDOW], target[start : start + WINDOW])
        for stretch, path, target in zip(stretches, vo, derived, strict=True)
        if stretch.person == longest
        for start in range(0, stretch.num_frames, WINDOW)
    ]
    every = np.concatenate(scales)
    return _scaled(float(every.mean()) if every.size else float("nan"))


def _scaled(scale: float) -> Similarity:
    return Similarity(np.array(scale), np.eye(3), np.zeros(3))


def _unscaled() -> Similarity:
    return _scaled(1.0)


def _derived_alone(
    stretches: list[Stretch],
    derived: list[FloatArray],
    odometry: Odometry,
    told: tuple[tuple[int, slice, FloatArray], ...],
) -> Recovery:
    """The camera by the velocimeter: at each frame the mean step of what the people in view say."""
    total, count = np.zeros((len(odometry.valid), 3)), np.zeros(len(odometry.valid))
    for stretch, path in zip(stretches, derived, strict=True):
        total[stretch.frames][1:] += np.diff(path, axis=0)
        count[stretch.frames][1:] += 1.0
    # Where nobody is seen in two frames in a row, a new world begins; the longest of them counts.
    runs = [slice(run.start - 1, run.stop) for run in runs_of(count > 0.0)]
    T_world_camera = np.tile(np.eye(4), (len(count), 1, 1))
    valid = np.zeros(len(count), dtype=bool)
    if runs:
        run = max(runs, key=lambda part: part.stop - part.start)
        steps = total[run] / np.maximum(count[run], 1.0)[:, None]
        T_world_camera[run] = rigid(odometry.T_vo[run, :3, :3], method.trajectory(steps))
        valid[run] = True
    return Recovery(_origin_at_first(T_world_camera, valid), valid, float("nan"), told)


def _origin_at_first(T_world_camera: FloatArray, valid: BoolArray) -> FloatArray:
    """The same world with the first valid camera at its origin (its axes are that camera's already)."""
    poses = T_world_camera.copy()
    first = np.flatnonzero(valid)[:1]
    poses[valid, :3, 3] -= poses[first, :3, 3]
    return poses


def place_people(
    people: Sequence[PersonEstimate], recovery: Recovery, body: BodyModel
) -> list[tuple[PersonEstimate, PersonEstimate]]:
    """Every person in the camera frame and in the world: T_h^w = T_c^w T_h^c, on SMPL-X parameters.

    In the world a person is valid where the person and the camera are known.
    """
    placed = []
    for person in people:
        world = person.params.transformed(recovery.T_world_camera, rest_pelvis(body, person.params))
        known = person.valid & recovery.camera_valid
        placed.append((person, PersonEstimate(person.track_id, world, known)))
    return placed
