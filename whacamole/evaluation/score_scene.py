"""Metrics of the camera, of pairs of people and of the scene as a whole."""

from itertools import combinations

import numpy as np

from whacamole.evaluation.core.alignment import FloatArray
from whacamole.evaluation.core.camera import relative_pose_error
from whacamole.evaluation.core.contact import detection_counts, ratios
from whacamole.evaluation.core.pose import procrustes_error
from whacamole.evaluation.core.segments import rows_of_segments, segments
from whacamole.evaluation.core.shared import shared_world_error
from whacamole.evaluation.core.world import path_error
from whacamole.evaluation.pairing import Pair, Timeline
from whacamole.evaluation.protocol import Protocol
from whacamole.evaluation.records import CameraTrack, IntArray, Recording
from whacamole.evaluation.scores import SequenceScore


def score_camera(
    truth: Recording, prediction: Recording, row_of_truth: IntArray, timeline: Timeline, protocol: Protocol,
    score: SequenceScore,
) -> None:  # fmt: skip
    """C-ATE, C-AS and C-RPE over the frames whose cameras are both known.

    Args:
        row_of_truth: row of the prediction for each row of the truth (T,), −1 for none.
    """
    cameras = _common_cameras(truth.camera, prediction.camera, row_of_truth)
    if cameras is None:
        score.counts["cameras_missing"] += truth.camera is not None
        return
    rows, ours, theirs = cameras
    frames = np.arange(len(rows)) if protocol.gaps == "close" else timeline.position[rows]
    translation, rotation = relative_pose_error(theirs, ours, frames)
    score.put_frames("c_rpe_t", rows, translation)
    score.put_frames("c_rpe_r", rows, rotation)
    centres = theirs[:, :3, 3], ours[:, :3, 3]
    score.put_path("truth/camera", rows, centres[1])
    path = path_error(*centres, with_scale=protocol.with_scale)
    rigid = path_error(*centres, with_scale=False)
    if path is None or rigid is None:
        score.counts["cameras_static"] += 1
        score.put_path("prediction/camera", rows, centres[0] - centres[0][:1] + centres[1][:1])
        return
    score.put_path("prediction/camera", rows, path.aligned)
    found = {"c_ate": path.mean, "c_ate_rmse": path.rmse, "c_ate_rigid": rigid.mean}
    if not np.isfinite(path.scale):
        score.note("the predicted camera does not move: C-ATE at the middle of the true path, no C-AS")
    elif protocol.with_scale:
        found["c_as"] = path.scale
    score.values.update({key: np.array(value) for key, value in found.items()})


def _common_cameras(
    truth: CameraTrack | None, prediction: CameraTrack | None, row_of_truth: IntArray
) -> tuple[IntArray, FloatArray, FloatArray] | None:
    """Rows of the truth with both cameras (F,), the true and the predicted poses (F, 4, 4)."""
    if truth is None or prediction is None:
        return None
    rows = np.flatnonzero(truth.valid & (row_of_truth >= 0) & prediction.valid[row_of_truth])
    if not len(rows):
        return None
    return rows, truth.T_world_camera[rows], prediction.T_world_camera[row_of_truth[rows]]


def score_pairs(pairs: list[Pair], num_frames: int, score: SequenceScore) -> None:
    """Pair-PA-MPJPE: the mean over all pairs of people of a frame."""
    total, count = np.zeros(num_frames), np.zeros(num_frames)
    for first, second in combinations(pairs, 2):
        rows, at_first, at_second = np.intersect1d(first.rows, second.rows, return_indices=True)
        joints = [pair.joints("camera") for pair in (first, second)]
        if joints[0] is None or joints[1] is None:
            joints = [pair.joints("world") for pair in (first, second)]
        if joints[0] is None or joints[1] is None or not len(rows):
            continue
        prediction, truth = (
            np.concatenate([joints[0][side][at_first], joints[1][side][at_second]], axis=1) for side in (0, 1)
        )
        total[rows] += procrustes_error(prediction, truth)
        count[rows] += 1
    if count.any():
        score.values["pair_pa_mpjpe"] = np.where(count > 0, total / np.maximum(count, 1), np.nan)


def score_shared_world(
    pairs: list[Pair], truth: Recording, prediction: Recording, row_of_truth: IntArray, timeline: Timeline,
    protocol: Protocol, score: SequenceScore,
) -> None:  # fmt: skip
    """SW-MPJPE, SW-camera and SW-offset, for predictions that put people and camera into one world."""
    cameras = _common_cameras(truth.camera, prediction.camera, row_of_truth)
    placed = [(pair, pair.joints("world"), pair.roots("world")) for pair in pairs]
    if cameras is None or not placed or any(joints is None or roots is None for _, joints, roots in placed):
        if truth.camera is not None and pairs:
            score.note("no shared-world metrics: the prediction has no camera in the world of its people")
        return
    T, K = truth.num_frames, min(joints[0].shape[1] for _, joints, _ in placed if joints)
    people, roots = np.full((2, len(pairs), T, K, 3), np.nan), np.full((2, len(pairs), T, 3), np.nan)
    for i, (pair, joints, root) in enumerate(placed):
        assert joints is not None
        assert root is not None
        for side in (0, 1):
            people[side, i, pair.rows], roots[side, i, pair.rows] = joints[side][:, :K], root[side][1]
    rows, ours, theirs = cameras
    centres = np.full((2, T, 3), np.nan)
    centres[0, rows], centres[1, rows] = theirs[:, :3, 3], ours[:, :3, 3]
    filmed = np.isfinite(centres[1]).all(axis=-1)
    present = np.isfinite(people[1]).all(axis=(-1, -2))
    cut = segments(timeline.length, protocol.segment_frames, protocol.tail, protocol.shortest_tail)
    error = shared_world_error(
        (people[0], people[1]), (roots[0], roots[1]), (centres[0], centres[1]), (present, filmed),
        rows_of_segments(cut, timeline.position),
    )  # fmt: skip
    for i, pair in enumerate(pairs):
        score.put("sw_mpjpe", pair.index, pair.rows, error.people[i, pair.rows])
    score.values["sw_camera"], score.values["sw_offset"] = error.camera, error.offset


def score_ground_contact(
    pairs: list[Pair], matches: dict[int, int], truth: Recording, prediction: Recording, row_of_truth:
        IntArray,
    score: SequenceScore,
) -> None:  # fmt: skip
    """Precision, recall and F1 of labelled ground contact, for the parts that both sides name."""
    if truth.contact is None or prediction.contact is None:
        return
    names = [name for name in truth.contact.part_names if name in prediction.contact.part_names]
    if not names:
        score.note("no ground-contact metrics: prediction and truth name no part alike")
        return
    ours, theirs = (
        contact.touching[..., [contact.part_names.index(name) for name in names]]
        for contact in (truth.contact, prediction.contact)
    )
    for pair in pairs:
        labels = ours[pair.index, pair.rows]
        predicted = theirs[matches[pair.index], row_of_truth[pair.rows]]
        counts = detection_counts(predicted, labels, np.ones_like(labels))
        for name, (values, weights) in ratios(counts).items():
            score.put(f"ground_{name}", pair.index, pair.rows, values, weights)
