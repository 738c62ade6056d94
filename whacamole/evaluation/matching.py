"""Which predicted track is which person: one assignment a sequence (Hungarian), and how well it fits."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import linear_sum_assignment

from whacamole.evaluation.core.alignment import FloatArray, align
from whacamole.evaluation.core.pose import distances
from whacamole.evaluation.figure import Figure
from whacamole.evaluation.records import SPACES, IntArray, Space

FAR = 1.0
"""Distances are cut here: half a body off in the image is as wrong as the other side of it."""

ACCEPTED = 0.5
"""A pair whose mean distance over its common frames is larger is no match."""

_NEAREST = 0.05


@dataclass(frozen=True)
class Match:
    """A true person and the predicted track assigned to it.

    ``truth`` and ``prediction`` count the people of the recordings; ``distance`` is what :func:`match_tracks`
    minimises over the common frames.
    """

    truth: int
    prediction: int
    distance: float


def match_tracks(
    truth: Sequence[Figure], prediction: Sequence[Figure], frame_of_prediction: IntArray
) -> list[Match]:
    """Assign predicted tracks to people.

    The cost of a pair is its mean over the frames that either has: where both are, the mean distance of the
        22 body
    joints in the normalised image (x/z, y/z; no focal length is needed) by the height of the person in it, at
    most :data:`FAR`; where only one is, :data:`FAR`. Without camera-frame bodies on both sides the distance
    is that of the joints in the world after a rigid alignment of the pair, in metres. Pairs beyond
    :data:`ACCEPTED` are not matched.

    Args:
        truth, prediction: people of both recordings.
        frame_of_prediction: row of the truth for each row of the prediction, −1 for none.
    """
    if not truth or not prediction:
        return []
    cost = np.full((len(truth), len(prediction)), FAR)
    apart = np.full(cost.shape, np.inf)
    ours, theirs = ([_bodies(figure) for figure in side] for side in (truth, prediction))
    for j, track in enumerate(prediction):
        rows = frame_of_prediction[track.rows]
        for i, person in enumerate(truth):
            _, at_truth, at_track = np.intersect1d(person.rows, rows, return_indices=True)
            if len(at_truth):
                common = np.minimum(_distance(ours[i], theirs[j], at_truth, at_track), FAR)
                union = len(person.rows) + int((rows >= 0).sum()) - len(at_truth)
                cost[i, j] = (common.sum() + FAR * (union - len(at_truth))) / union
                apart[i, j] = common.mean()
    pairs = zip(*linear_sum_assignment(cost), strict=True)
    return [Match(int(i), int(j), float(apart[i, j])) for i, j in pairs if apart[i, j] < ACCEPTED]


def _bodies(figure: Figure) -> dict[Space, FloatArray | None]:
    """Body joints (F, 22, 3) in each space."""
    both = {space: figure.joints(space) for space in SPACES}
    return {space: None if joints is None else joints[:, :22] for space, joints in both.items()}


def _distance(
    ours: dict[Space, FloatArray | None],
    theirs: dict[Space, FloatArray | None],
    at_truth: IntArray,
    at_track: IntArray,
) -> FloatArray:
    """Distance on the common frames (F,)."""
    truth, prediction = ours["camera"], theirs["camera"]
    if truth is not None and prediction is not None:
        return _image_distance(prediction[at_track], truth[at_truth])
    truth, prediction = ours["world"], theirs["world"]
    if truth is None or prediction is None:
        return np.full(len(at_truth), np.inf)
    source, target = prediction[at_track].reshape(-1, 3), truth[at_truth].reshape(-1, 3)
    apart = distances(align(source, target, with_scale=False), target)
    return np.asarray(apart.reshape(len(at_truth), -1).mean(axis=1))


def _image_distance(prediction: FloatArray, truth: FloatArray) -> FloatArray:
    flat, in_front = zip(*(_normalised(joints) for joints in (prediction, truth)), strict=True)
    height = np.maximum(np.ptp(flat[1][..., 1], axis=1), 1e-3)
    apart = np.linalg.norm(flat[0] - flat[1], axis=-1).mean(axis=1) / height
    return np.where(in_front[0] & in_front[1], apart, FAR)


def _normalised(joints: FloatArray) -> tuple[FloatArray, npt.NDArray[np.bool_]]:
    """(x/z, y/z) of joints (F, K, 3), and whether all are in front of the camera (F,)."""
    depth = joints[..., 2]
    return joints[..., :2] / np.maximum(depth, _NEAREST)[..., None], (depth > _NEAREST).all(axis=1)
