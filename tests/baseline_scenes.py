"""Scenes whose truth is known: embedded people in front of a made-up camera."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from whacamole.baseline.clips import Performance
from whacamole.baseline.modes import Mode
from whacamole.baseline.odometry import Odometry
from whacamole.baseline.people import PersonEstimate, rest_pelvis
from whacamole.baseline.recover import Velocimeter, _window_starts
from whacamole.baseline.resampling import Resampling
from whacamole.baseline.rigid import FloatArray, inverse, rigid, runs_of
from whacamole.baseline.velocimeter import FPS, WINDOW
from whacamole.body import BodyModel, BodyParams
from whacamole.motion import embedded_motions, read_motion


@dataclass(frozen=True, eq=False)
class TrueScene:
    """People in a world and the camera that films them."""

    world: list[BodyParams]
    T_world_camera: FloatArray
    body: BodyModel

    @property
    def num_frames(self) -> int:
        return len(self.T_world_camera)

    def estimates(self, valid: Sequence[NDArray[np.bool_]] | None = None) -> list[PersonEstimate]:
        """Perfect camera-frame estimates."""
        T_camera_world = inverse(self.T_world_camera)
        seen = [params.transformed(T_camera_world, rest_pelvis(self.body, params)) for params in self.world]
        masks = valid or [np.ones(self.num_frames, dtype=bool) for _ in seen]
        return [PersonEstimate(i + 1, p, m) for i, (p, m) in enumerate(zip(seen, masks, strict=True))]

    def odometry(self, scale: float = 0.2) -> Odometry:
        """The true camera in another unit."""
        poses = self.T_world_camera.copy()
        poses[:, :3, 3] *= scale
        return Odometry.from_poses(poses, np.ones(self.num_frames, dtype=bool))

    def in_first_camera(self, points: FloatArray) -> FloatArray:
        """World points (…, 3) in the frame of the first camera: the world of a recovery."""
        T = inverse(self.T_world_camera[0])
        moved: FloatArray = points @ T[:3, :3].T + T[:3, 3]
        return moved


def moving_camera(frames: int, seed: int) -> FloatArray:
    """A smooth camera path (T, 4, 4) that turns, tilts, rolls and goes a few metres."""
    rng = np.random.default_rng(seed)
    time = np.linspace(0.0, 1.0, frames)[:, None]
    waves = rng.normal(size=(3, 6)) * np.array([0.3, 0.2, 0.1, 1.0, 1.0, 0.4])
    path = sum(np.sin(2.0 * (k + 1) * time) * wave for k, wave in enumerate(waves))
    assert isinstance(path, np.ndarray)
    upright = Rotation.from_euler("x", -90.0, degrees=True)
    turned = Rotation.from_rotvec(path[:, :3]) * upright
    return rigid(turned.as_matrix(), path[:, 3:] + np.array([0.0, -4.0, 1.2]))


def true_scene(body: BodyModel, people: Sequence[tuple[str, float]], frames: int, seed: int = 3) -> TrueScene:
    """Embedded motions (file, place on the x axis), each on a body of another shape, from frame 20 on."""
    world = []
    for number, (name, place) in enumerate(people):
        [person] = read_motion(embedded_motions() / name).people
        betas = np.random.default_rng(number).normal(scale=0.7, size=10)
        params = Performance(name, person).params(body, betas).slice(20, 20 + frames)
        shift = np.array([place, 0.0, 0.0]) - params.transl[0] * np.array([1.0, 1.0, 0.0])
        world.append(params.transformed(rigid(np.eye(3), shift), body.rest_joints(betas)[0]))
    return TrueScene(world, moving_camera(frames, seed), body)


def oracle(
    scene: TrueScene, mode: Mode, fps: float = 30.0, valid: Sequence[NDArray[np.bool_]] | None = None
) -> Velocimeter:
    """A velocimeter that knows: the true velocities, canonical, of people who are seen in the valid
    frames."""
    seen = valid or [np.ones(scene.num_frames, dtype=bool) for _ in scene.world]

    def velocities(windows: list[FloatArray]) -> list[FloatArray]:
        truth = []
        for params, mask in zip(scene.world, seen, strict=True):
            for run in runs_of(mask):
                part = params.slice(run.start, run.stop)
                even = Resampling(part.num_frames, fps, FPS)
                pelvis = even.points(scene.body.pose_joints(part)[:, 0])
                orient = even.rotations(Rotation.from_rotvec(part.global_orient).as_matrix())
                steps = np.diff(pelvis, axis=0, prepend=pelvis[:1])
                starts = [start for start, _ in _window_starts(len(pelvis), mode.overlap)]
                truth += [steps[start : start + WINDOW] @ orient[start] for start in starts]
        assert [len(window) for window in windows] == [len(window) for window in truth]
        return truth

    return velocities
