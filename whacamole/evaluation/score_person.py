"""All metrics of one matched person."""

import numpy as np

from whacamole.errors import EvaluationError
from whacamole.evaluation.core.alignment import FloatArray, umeyama
from whacamole.evaluation.core.contact import detection_counts, ratios, standing
from whacamole.evaluation.core.pose import (
    acceleration_error,
    jitter,
    joint_angle_error,
    point_error,
    procrustes_error,
    root_aligned_error,
)
from whacamole.evaluation.core.world import (
    egocentric_velocity_error,
    foot_sliding,
    path_error,
    root_translation_error,
    segment_error,
)
from whacamole.evaluation.joints import MPJAE_JOINTS, root_of, still_joints
from whacamole.evaluation.pairing import Pair
from whacamole.evaluation.protocol import Protocol
from whacamole.evaluation.score_vertices import VertexOptions, VertexScores, score_vertices
from whacamole.evaluation.scores import SequenceScore


def score_person(
    pair: Pair, protocol: Protocol, fps: float, options: VertexOptions | None, score: SequenceScore
) -> None:
    """Score one person and put the values into ``score``.

    Args:
        pair: the person and its track.
        protocol: the choices.
        fps: of acceleration and jitter.
        options: what vertices need, ``None`` to leave all metrics of vertices out.
        score: is added to.
    """
    if pair.note:
        score.note(pair.note)
    surface = _vertices(pair, protocol, options, score)
    if surface is not None:
        pair.regressed = surface.regressed
        for key, values in surface.errors.items():
            score.put(key, pair.index, pair.rows, values)
    _camera_frame(pair, protocol, fps, score)
    _world(pair, protocol, fps, score)
    if surface is not None:
        _feet(pair, protocol, fps, surface.feet, score)


def _vertices(
    pair: Pair, protocol: Protocol, options: VertexOptions | None, score: SequenceScore
) -> VertexScores | None:
    if options is None:
        return None
    try:
        return score_vertices(pair, protocol, options)
    except EvaluationError as error:
        score.note(f"no vertex metrics: {error}")
        return None


def _camera_frame(pair: Pair, protocol: Protocol, fps: float, score: SequenceScore) -> None:
    """Errors relative to the camera; PA-MPJPE, which needs no frame, from the bodies themselves."""
    joints = pair.joints("camera")
    any_space = joints or pair.joints("world")
    if any_space is None:
        score.note("no joint metrics: the prediction places no body in the camera's frame or the world")
        return
    score.put("pa_mpjpe", pair.index, pair.rows, procrustes_error(*any_space))
    if joints is None:
        score.note("no camera-frame metrics: the prediction has no body in the camera's frame")
        return
    prediction, truth = joints
    roots = [root_of(side, pair.joint_set, protocol.root) for side in joints]
    score.put("mpjpe", pair.index, pair.rows, root_aligned_error(prediction, truth, *roots))
    score.put("t_mpjpe", pair.index, pair.rows, point_error(prediction, truth))
    centred = [side - root[:, None] for side, root in zip(joints, roots, strict=True)]
    accel = acceleration_error(centred[0], centred[1], fps, pair.frames, protocol.accel_trim)
    score.put("accel", pair.index, pair.rows, accel)
    _angles(pair, joints, score)


def _angles(pair: Pair, joints: tuple[FloatArray, FloatArray], score: SequenceScore) -> None:
    both = [figure.joint_rotations("camera") for figure in (pair.prediction, pair.truth)]
    if both[0] is None or both[1] is None:
        return
    nine = list(MPJAE_JOINTS)
    prediction, truth = both[0][pair.at_prediction][:, nine], both[1][pair.at_truth][:, nine]
    score.put("mpjae", pair.index, pair.rows, joint_angle_error(prediction, truth))
    turn = umeyama(*joints).rotation[:, None]
    score.put("pa_mpjae", pair.index, pair.rows, joint_angle_error(turn @ prediction, truth))


def _world(pair: Pair, protocol: Protocol, fps: float, score: SequenceScore) -> None:
    joints, roots = pair.joints("world"), pair.roots("world")
    if joints is None or roots is None:
        score.note("no world metrics: the prediction places no body in the world")
        return
    prediction, truth = joints
    rows = pair.segments()
    score.counts["segments"] += len(rows)
    score.counts["segments_short"] += sum(len(segment) <= protocol.fit_frames for segment in rows)
    score.counts["people_without_segment"] += not rows
    for suffix, with_scale in (("", protocol.with_scale), ("_rigid", False)):
        for name, fit in (("w_mpjpe", protocol.fit_frames), ("wa_mpjpe", None)):
            error = segment_error(prediction, truth, rows, fit_frames=fit, with_scale=with_scale)
            score.put(name + suffix, pair.index, pair.rows, error)
    still = still_joints(pair.joint_set) if protocol.jitter_joints == "emdb" else ()
    score.put("jitter", pair.index, pair.rows, jitter(prediction, fps, pair.frames, still))
    (orient, root), (orient_truth, root_truth) = roots
    erve = egocentric_velocity_error(root, root_truth, orient, orient_truth, pair.frames)
    score.put("erve", pair.index, pair.rows, erve)
    _paths(pair, protocol, (root, root_truth), score)


def _paths(
    pair: Pair, protocol: Protocol, roots: tuple[FloatArray, FloatArray], score: SequenceScore
) -> None:
    """Errors of the root's path over the whole sequence."""
    transl = pair.transl("world") if protocol.rte_root == "transl" else None
    if transl is None and protocol.rte_root == "transl":
        score.note("rte_root=transl: the source gives no transl in the world, RTE is of joint 0")
    rte = root_translation_error(*(transl or roots))
    if rte is not None:
        score.put("rte", pair.index, pair.rows, rte)
    path = path_error(*roots, with_scale=protocol.with_scale)
    score.put_path(f"truth/person/{pair.index}", pair.rows, roots[1])
    if path is None:
        score.counts["people_static"] += 1
        score.put_path(f"prediction/person/{pair.index}", pair.rows, roots[0] - roots[0][:1] + roots[1][:1])
        return
    score.put_path(f"prediction/person/{pair.index}", pair.rows, path.aligned)
    score.put_person("h_ate", pair.index, path.mean)
    score.put_person("h_ate_rmse", pair.index, path.rmse)
    if not np.isfinite(path.scale):
        score.note("a predicted root does not move: H-ATE at the middle of the true path, no H-AS")
    elif protocol.with_scale:
        score.put_person("h_as", pair.index, path.scale)


def _feet(
    pair: Pair, protocol: Protocol, fps: float, feet: tuple[FloatArray, FloatArray], score: SequenceScore
) -> None:
    """Foot sliding, and contact told by displacement."""
    prediction = pair.prediction.place(feet[0], "world", pair.at_prediction)
    truth = pair.truth.place(feet[1], "world", pair.at_truth)
    if prediction is None or truth is None:
        return
    still = protocol.still_speed / fps
    score.put("foot_sliding", pair.index, pair.rows, *foot_sliding(prediction, truth, pair.frames, still))
    labels, told = standing(truth, pair.frames, still)
    predicted, _ = standing(prediction, pair.frames, still)
    for name, (values, weights) in ratios(detection_counts(predicted, labels, told)).items():
        score.put(f"foot_{name}", pair.index, pair.rows, values, weights)
