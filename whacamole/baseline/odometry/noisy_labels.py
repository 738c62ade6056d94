"""The true trajectory, spoiled and stripped of its scale: an oracle, for ablations."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from whacamole.baseline.odometry.trajectory import Odometry, Scene
from whacamole.baseline.rigid import FloatArray, inverse, rigid
from whacamole.errors import BaselineError
from whacamole.seeds import generator


@dataclass(frozen=True)
class PathNoise:
    """Errors of relative poses, frame to frame; they add up, as odometry drifts.

    Attributes:
        rotation: standard deviation of a step's rotation about each axis [degrees].
        translation: of a step's translation along each axis, as a share of the root mean square step.
    """

    rotation: float = 0.03
    translation: float = 0.05

    def times(self, factor: float) -> "PathNoise":
        """All of it times a factor."""
        return PathNoise(self.rotation * factor, self.translation * factor)


def drift_rand(rng: np.random.Generator, T_world_camera: FloatArray, noise: PathNoise) -> FloatArray:
    """Poses (T, 4, 4) whose relative poses have noise on them, in the unit of the true ones."""
    relative = inverse(T_world_camera[:-1]) @ T_world_camera[1:]
    length = np.sqrt((relative[:, :3, 3] ** 2).sum(axis=-1).mean()) if len(relative) else 0.0
    turn = Rotation.from_rotvec(np.radians(noise.rotation) * rng.normal(size=(len(relative), 3))).as_matrix()
    shift = noise.translation * length * rng.normal(size=(len(relative), 3))
    steps = rigid(relative[:, :3, :3] @ turn, relative[:, :3, 3] + shift)
    poses = [T_world_camera[0]]
    for step in steps:
        poses.append(poses[-1] @ step)
    return np.stack(poses)


@dataclass(frozen=True)
class NoisyLabelsOdometry:
    """``noisy-labels``: not an estimate; every report says so.

    Attributes:
        noise: its size.
        seed: of the noise.
    """

    noise: PathNoise = PathNoise()
    seed: int = 0
    name: str = "noisy-labels"

    def track(self, scene: Scene) -> Odometry:
        """The sequence's camera with noise, without its scale.

        Raises:
            BaselineError: the footage is no sequence of a dataset.
        """
        sequence = scene.footage.sequence
        if sequence is None:
            raise BaselineError("--vo noisy-labels needs a dataset with labels; choose opencv for a video")
        rng = generator(self.seed, sequence.id, 0, "odometry noise")
        poses = drift_rand(rng, np.asarray(sequence.camera["T_world_camera"], dtype=np.float64), self.noise)
        # A scale and a frame of its own before normalisation: what follows cannot lean on either.
        world = rigid(Rotation.random(random_state=rng).as_matrix(), rng.normal(size=3))
        scaled = world @ poses
        scaled[:, :3, 3] *= np.exp(rng.uniform(-2.0, 2.0))
        return Odometry.from_poses(scaled, np.ones(len(poses), dtype=bool), ("camera",))
