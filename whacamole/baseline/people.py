"""What an estimator gives: a person's SMPL-X parameters in the camera frame, frame by frame."""

from dataclasses import dataclass

import numpy as np

from whacamole.baseline.rigid import BoolArray, FloatArray
from whacamole.body import BodyModel, BodyParams


@dataclass(frozen=True, eq=False)
class PersonEstimate:
    """One person through the T frames of a video.

    Attributes:
        track_id: at least 1.
        params: camera-frame parameters (OpenCV axes), T frames; any finite values where ``valid`` is false.
        valid: (T,) frames in which the person was found.
    """

    track_id: int
    params: BodyParams
    valid: BoolArray

    def __post_init__(self) -> None:
        if self.valid.shape != (self.params.num_frames,):
            raise ValueError(f"valid: shape {self.valid.shape}, expected ({self.params.num_frames},)")


def rest_pelvis(body: BodyModel, params: BodyParams) -> FloatArray:
    """j0 (T, 3) [m], about which the root turns."""
    rest = body.rest_joints(params.betas, params.expression)
    return np.ascontiguousarray(np.broadcast_to(rest, (params.num_frames, *rest.shape[-2:]))[:, 0])
