"""What the velocimeter learns from: joints and root orientation of a person in a metric world, at 30 fps."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from whacamole.baseline.method import VELOCIMETER_JOINTS
from whacamole.baseline.resampling import Resampling
from whacamole.baseline.rigid import FloatArray, runs_of
from whacamole.baseline.velocimeter import FPS
from whacamole.body import BodyModel, BodyParams
from whacamole.errors import BaselineError
from whacamole.motion import MotionPerson, find_motions, read_motion

SHORTEST = 8
"""Frames of the shortest clip that is worth a window."""


@dataclass(frozen=True, eq=False)
class Clip:
    """A person over n frames at 30 fps in a world with z up.

    Attributes:
        joints: (n, 15, 3) [m], the velocimeter's joints.
        orient: (n, 3, 3) root orientation.
        camera: (n, 3, 3) camera-to-world rotation where a rendered camera filmed it, else ``None``.
        motion: id of the motion.
    """

    joints: FloatArray
    orient: FloatArray
    motion: str
    camera: FloatArray | None = None

    @property
    def num_frames(self) -> int:
        """n."""
        return len(self.joints)


@dataclass(frozen=True, eq=False)
class Performance:
    """A person of a motion file, still to be put on a body: what clips of many shapes are made from."""

    motion: str
    person: MotionPerson

    def params(self, body: BodyModel, betas: FloatArray, body_pose: FloatArray | None = None) -> BodyParams:
        """Parameters on a body of shape ``betas`` (10,), the path scaled with the length of the legs.

        Args:
            body_pose: (T, 21, 3) in place of the motion's own.
        """
        still = BodyParams.zeros(self.person.num_frames, betas)
        scale = body.pelvis_height(betas) / body.pelvis_height(np.zeros_like(betas))
        return BodyParams(
            betas=betas,
            expression=still.expression,
            global_orient=self.person.global_orient,
            transl=self.person.pelvis * scale - body.rest_joints(betas)[0],
            body_pose=self.person.body_pose if body_pose is None else body_pose,
            left_hand_pose=still.left_hand_pose,
            right_hand_pose=still.right_hand_pose,
            jaw_pose=still.jaw_pose,
            leye_pose=still.leye_pose,
            reye_pose=still.reye_pose,
        )


def clip_of(params: BodyParams, body: BodyModel, motion: str) -> Clip:
    """The clip of a person whose parameters are in the world."""
    joints = body.pose_joints(params)[:, list(VELOCIMETER_JOINTS)]
    return Clip(joints, Rotation.from_rotvec(params.global_orient).as_matrix(), motion)


def performances(path: Path) -> list[Performance]:
    """Every person of every motion below ``path``, at least :data:`SHORTEST` frames long.

    Raises:
        MotionError: a file cannot be used.
        BaselineError: there is nothing to learn from.
    """
    found = []
    for file in find_motions(path):
        motion = read_motion(file)
        found += [Performance(motion.id, person) for person in motion.people if person.num_frames >= SHORTEST]
    if not found:
        raise BaselineError(f"{path}: no motion of at least {SHORTEST} frames; name a folder of motions")
    return found


def dataset_clips(root: Path, split: str) -> list[Clip]:
    """Clips of a split of a rendered dataset, with the camera that filmed them; people out of view are cut
    out.

    Raises:
        DatasetError: the dataset or the split is not there.
    """
    from whacamole.dataset import open_dataset

    clips = []
    for sequence in open_dataset(root).split(split):
        people, camera = sequence.people, sequence.camera
        for index, valid in enumerate(people["valid"]):
            joints = np.asarray(people["joints_world"][index], dtype=np.float64)[:, list(VELOCIMETER_JOINTS)]
            orient = Rotation.from_rotvec(people["global_orient_world"][index]).as_matrix()
            for run in runs_of(np.asarray(valid, dtype=bool), SHORTEST):
                even = Resampling(run.stop - run.start, float(camera["fps"]), FPS)
                turns = (orient[run], np.asarray(camera["T_world_camera"][run, :3, :3]))
                turned = [even.rotations(turn) for turn in turns]
                motion = str(people["motion_id"][index])
                clips.append(Clip(even.points(joints[run]), turned[0], motion, turned[1]))
    return clips


def windows_of(clips: Iterable[Clip], length: int) -> Iterator[Clip]:
    """Cut clips into windows of ``length`` frames end to end, the rest of a clip as a shorter window."""
    for clip in clips:
        for start in range(0, clip.num_frames, length):
            part = slice(start, start + length)
            if clip.num_frames - start >= SHORTEST:
                camera = None if clip.camera is None else clip.camera[part]
                yield Clip(clip.joints[part], clip.orient[part], clip.motion, camera)
