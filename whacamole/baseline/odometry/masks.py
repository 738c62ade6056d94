"""Where people are in an image, so that odometry looks past them: by labels, or by what the estimator
found."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from whacamole.baseline.footage import Footage
from whacamole.baseline.odometry.features import load_cv2
from whacamole.baseline.odometry.trajectory import Masker
from whacamole.baseline.people import PersonEstimate
from whacamole.baseline.rigid import BoolArray, FloatArray
from whacamole.body import NUM_JOINTS, PARENTS, BodyModel
from whacamole.errors import BaselineError

MASK_SOURCES = ("detector", "labels", "none")
"""``detector``: the people that the estimator found. ``labels``: the dataset's masks, true data. ``none``:
nobody."""

_FLESH = 0.13  # metres about a bone that are masked
_HEAD = 0.16  # metres about the head joint


def masker_of(
    source: str, footage: Footage, people: Sequence[PersonEstimate], K: FloatArray, body: BodyModel
) -> Masker | None:
    """The masker of a source.

    Raises:
        BaselineError: no such source, or the footage has no labels.
    """
    if source == "none":
        return None
    if source == "detector":
        return _Bones(people, K, body)
    sequence = footage.sequence
    if source != "labels":
        raise BaselineError(f"masks {source!r}: expected {', '.join(MASK_SOURCES)}")
    if sequence is None:
        raise BaselineError("--masks labels needs a dataset with labels; choose detector for a video")
    return lambda frame, _: np.asarray(sequence.mask(frame) > 0)


class _Bones:
    """Draws the bones of everybody found, as thick as people are."""

    def __init__(self, people: Sequence[PersonEstimate], K: FloatArray, body: BodyModel) -> None:
        self._valid = [person.valid for person in people]
        self._joints = [body.pose_joints(person.params) for person in people]
        self._K = K

    def __call__(self, frame: int, image: NDArray[np.uint8]) -> BoolArray:
        cv2 = load_cv2()
        canvas = np.zeros(image.shape[:2], dtype=np.uint8)
        K = self._K[frame]
        for valid, joints in zip(self._valid, self._joints, strict=True):
            if not valid[frame] or joints[frame, :, 2].min() <= 0.1:
                continue
            local = joints[frame]
            pixels = local[:, :2] / local[:, 2:] * K[[0, 1], [0, 1]] + K[:2, 2]
            width = K[0, 0] / local[:, 2]
            spots = np.round(np.clip(pixels, -1e4, 1e4)).astype(int)
            for joint in range(1, NUM_JOINTS):
                thick = max(1, round(2.0 * _FLESH * float(width[joint])))
                cv2.line(canvas, tuple(spots[PARENTS[joint]]), tuple(spots[joint]), 1, thick)
            cv2.circle(canvas, tuple(spots[15]), max(1, round(_HEAD * float(width[15]))), 1, -1)
        return canvas > 0
