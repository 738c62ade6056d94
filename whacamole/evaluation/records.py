"""What is compared: a recording of people and a camera, true or predicted.

Truth and prediction have the same type, so that any source of one can stand for the other. Every reader, of a
dataset, of a benchmark or of a method's output, returns a :class:`Recording`.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Literal

import numpy as np
import numpy.typing as npt

from whacamole.evaluation.core.alignment import FloatArray

BoolArray = npt.NDArray[np.bool_]
IntArray = npt.NDArray[np.intp]

MOST = 1e6
"""Metres, radians or coefficients beyond which a value is taken for damage."""

NOT_RIGID = 0.01
"""How far R Rᵀ of a camera's pose may be from the identity."""

BodyKind = Literal["smplx", "smplh", "smpl"]
Space = Literal["world", "camera"]
SPACES: tuple[Space, ...] = ("world", "camera")


def usable(array: FloatArray) -> BoolArray:
    """Which rows (T,) of (T, …) are finite and within :data:`MOST`."""
    return np.asarray((np.abs(array) < MOST).all(axis=tuple(range(1, array.ndim))))  # NaN compares false


@dataclass(frozen=True, eq=False)
class Placement:
    """Where a body's root is in one space.

    Attributes:
        orient: (T, 3) axis-angle.
        transl: (T, 3) the parameter ``transl`` [m]; the pelvis is at transl + j0.
    """

    orient: FloatArray
    transl: FloatArray


@dataclass(frozen=True, eq=False)
class PersonTrack:
    """One person over T frames, in parameters of a body model of the SMPL family.

    Attributes:
        track_id: as the source names the person.
        kind: which model the parameters belong to.
        betas: (B,) or (T, B).
        body_pose: (T, 21, 3), for SMPL (T, 23, 3): axis-angle.
        valid: (T,) frames that count; the others may hold anything, NaN included.
        world, camera: the root in each space, ``None`` where the source does not say.
        gender: "neutral", "male" or "female".
        left_hand_pose, right_hand_pose: (T, 15, 3), or (T, n) principal components about the mean hand, or
            ``None``.
        jaw_pose, leye_pose, reye_pose, expression: (T, 3) and (T, 10), or ``None`` for zero.
        model_sha256: of the model file, "" where the source does not say.
    """

    track_id: int
    kind: BodyKind
    betas: FloatArray
    body_pose: FloatArray
    valid: BoolArray
    world: Placement | None = None
    camera: Placement | None = None
    gender: str = "neutral"
    left_hand_pose: FloatArray | None = None
    right_hand_pose: FloatArray | None = None
    jaw_pose: FloatArray | None = None
    leye_pose: FloatArray | None = None
    reye_pose: FloatArray | None = None
    expression: FloatArray | None = None
    model_sha256: str = ""


@dataclass(frozen=True, eq=False)
class CameraTrack:
    """A camera over T frames, OpenCV axes.

    Attributes:
        T_world_camera: camera to world (T, 4, 4) [m].
        valid: (T,).
        K: (T, 3, 3) [px], or ``None``.
    """

    T_world_camera: FloatArray
    valid: BoolArray
    K: FloatArray | None = None

    def checked(self) -> "CameraTrack":
        """The same without the frames whose pose is not finite, beyond :data:`MOST`, or not rigid."""
        R = np.where(usable(self.T_world_camera)[:, None, None], self.T_world_camera[:, :3, :3], 0.0)
        rigid = np.abs(R @ np.swapaxes(R, -1, -2) - np.eye(3)).max(axis=(1, 2), initial=0.0) < NOT_RIGID
        return replace(self, valid=self.valid & rigid & (np.linalg.det(R) > 0.0))


@dataclass(frozen=True, eq=False)
class GroundContact:
    """Body parts on the ground: ``part_names`` (C,) and ``touching`` (P, T, C)."""

    part_names: tuple[str, ...]
    touching: BoolArray


@dataclass(frozen=True, eq=False)
class Recording:
    """People and a camera over T frames.

    Attributes:
        id: of the sequence.
        frame_index: (T,) ascending frame numbers.
        fps: frames a second.
        people, camera: who and what was there; ``camera`` is ``None`` where the source has none.
        contact: labels, or ``None``.
        joints: stored joints (P, T, 55, 3) [m] by space, where the source has them (kind "smplx").
        visible_fraction: (P, T), NaN or ``None`` where not known.
        shots: (T,) name of the camera move at each frame, or ``None``.
        source: where the motion comes from.
        up: direction away from the ground in the world, or ``None`` where not known.
        method, ground_truth_used: of a prediction: its method and the truths it was given, comma separated.
        notes: what a reader had to assume, one line each.
        by_position: whether ``frame_index`` counts the frames of the video from 0, whatever numbers the truth
            gives them.
    """

    id: str
    frame_index: IntArray
    fps: float
    people: tuple[PersonTrack, ...]
    camera: CameraTrack | None = None
    contact: GroundContact | None = None
    joints: Mapping[Space, FloatArray] = field(default_factory=dict)
    visible_fraction: FloatArray | None = None
    shots: tuple[str, ...] | None = None
    source: str = ""
    up: tuple[float, float, float] | None = None
    method: str = ""
    ground_truth_used: str = ""
    notes: tuple[str, ...] = ()
    by_position: bool = False

    @property
    def num_frames(self) -> int:
        """T."""
        return len(self.frame_index)
