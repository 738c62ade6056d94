"""Vertex errors of one person, a block of frames at a time."""

from dataclasses import dataclass, field

import numpy as np

from whacamole.body import JOINT_INDEX
from whacamole.errors import EvaluationError
from whacamole.evaluation.bodies import Body, Float32Array
from whacamole.evaluation.core.alignment import FloatArray, umeyama
from whacamole.evaluation.core.pose import point_error, procrustes_error
from whacamole.evaluation.joints import H36M14, joint_rows, root_of
from whacamole.evaluation.pairing import Pair
from whacamole.evaluation.protocol import Protocol
from whacamole.evaluation.records import IntArray

BLOCK = 450_000
"""Vertices of a body held at once (frames × V): bounds the memory, and stays near the processor's caches."""

_PART_WEIGHT = 0.5


@dataclass(frozen=True, eq=False)
class VertexOptions:
    """What vertex scores need beside the bodies.

    Attributes:
        mapping: sparse (V of truth, V of prediction) that carries a predicted mesh to the truth's topology,
            such as the published SMPL-X to SMPL transfer.
        regressor: (17, V) H36M joints from vertices, for ``joints=h36m14``.
    """

    mapping: object | None = None
    regressor: FloatArray | None = None


@dataclass(eq=False)
class VertexScores:
    """Per-frame errors by metric key (F,), and what other metrics need of the vertices.

    Attributes:
        errors: metric key → (F,).
        feet: predicted and true foot points (F, 4, 3) [m], local.
        regressed: true and predicted regressed joints (F, 14, 3) [m], local, or ``None``.
    """

    errors: dict[str, FloatArray] = field(default_factory=dict)
    feet: tuple[FloatArray, FloatArray] | None = None
    regressed: tuple[FloatArray, FloatArray] | None = None


def score_vertices(pair: Pair, protocol: Protocol, options: VertexOptions) -> VertexScores:
    """Pose both bodies and compare their surfaces.

    All happens in the true body's own frame, pelvis at the origin and root not turned: distances do not
    change, and the true vertices need no transform.

    Raises:
        EvaluationError: the meshes differ and no mapping fits, or a joint regressor is wanted and not given.
    """
    bodies = _bodies(pair)
    moves = _moves(pair)
    F = len(pair.rows)
    keys = ["pa_pve"] + (["pve", "t_pve", "pve_hands", "pve_face"] if moves else [])
    scores = VertexScores({key: np.full(F, np.nan) for key in keys})
    feet = np.zeros((2, F, 4, 3))
    wants_regressed = protocol.joints == "h36m14"
    regressed = np.zeros((2, F, len(H36M14), 3)) if wants_regressed else None
    parts = _parts(bodies[1])
    frames = max(1, BLOCK // max(len(body.weights) for body in bodies))
    for start in range(0, F, frames):
        at = np.arange(start, min(start + frames, F))
        raw = (
            pair.prediction.local_vertices(pair.at_prediction[at]),
            pair.truth.local_vertices(pair.at_truth[at]),
        )
        feet[0, at], feet[1, at] = (v[:, body.feet] for v, body in zip(raw, bodies, strict=True))
        ours, theirs = raw[1], _mapped(raw[0], bodies, options)
        if regressed is not None:
            for side, vertices in enumerate((theirs, ours)):
                regressed[side, at] = _regress(vertices, options)
        joints = [joints[at] for joints in pair.local_joints]
        sets = (regressed[0, at], regressed[1, at]) if regressed is not None else _sets(pair, joints)
        scored = bodies[1].scored
        scores.errors["pa_pve"][at] = _procrustes(theirs[:, scored], ours[:, scored], sets, protocol)
        if moves:
            turn, shift = moves[0][at], moves[1][at]
            moved = _turned(theirs, turn)
            placed_joints = _turned(joints[0], turn)
            root = root_of(_turned(sets[0], turn), pair.joint_set, protocol.root)
            gap = root - root_of(sets[1], pair.joint_set, protocol.root)
            target = ours[:, scored]
            for key, by in (("t_pve", shift), ("pve", -gap)):
                scores.errors[key][at] = point_error(
                    moved[:, scored] + by[:, None].astype(np.float32), target
                )
            for key, regions in parts.items():
                scores.errors[key][at] = _part_error(moved, ours, placed_joints, joints[1], regions)
    scores.feet = feet[0], feet[1]
    scores.regressed = None if regressed is None else (regressed[1], regressed[0])
    return scores


def _bodies(pair: Pair) -> tuple[Body, Body]:
    for figure in (pair.prediction, pair.truth):
        if figure.body is None:
            raise EvaluationError("no body model, so no vertices; add --body-model")
    assert pair.prediction.body is not None
    assert pair.truth.body is not None
    return pair.prediction.body, pair.truth.body


def _moves(pair: Pair) -> tuple[FloatArray, FloatArray] | None:
    """Rotation (F, 3, 3) and translation (F, 3) from the predicted body's own frame to the true one's."""
    roots = pair.roots("camera")
    if roots is None:
        return None
    (R, p), (R_truth, p_truth) = roots
    back = np.swapaxes(R_truth, -1, -2)
    return back @ R, np.einsum("fij,fj->fi", back, p - p_truth)


def _turned(points: FloatArray, turn: FloatArray) -> FloatArray:
    return points @ np.swapaxes(turn, -1, -2).astype(points.dtype)


def _mapped(vertices: Float32Array, bodies: tuple[Body, Body], options: VertexOptions) -> Float32Array:
    """Predicted vertices in the truth's topology."""
    if bodies[0].topology == bodies[1].topology:
        return vertices
    matrix = options.mapping
    shape = getattr(matrix, "shape", (0, 0))
    if len(shape) != 2 or shape[1] != vertices.shape[1] or shape[0] != len(bodies[1].weights):
        raise EvaluationError(
            f"meshes {bodies[0].topology} and {bodies[1].topology} have no common vertices; add --vertex-map"
        )
    flat = vertices.transpose(1, 0, 2).reshape(vertices.shape[1], -1)
    mapped = np.asarray(matrix @ flat, dtype=np.float32)  # type: ignore[operator]
    return mapped.reshape(shape[0], len(vertices), 3).transpose(1, 0, 2)


def _regress(vertices: Float32Array, options: VertexOptions) -> FloatArray:
    if options.regressor is None or options.regressor.shape[1] != vertices.shape[1]:
        raise EvaluationError("joints=h36m14 are regressed from SMPL vertices; add --joint-regressor")
    return np.asarray(options.regressor[list(H36M14)] @ vertices)


def _sets(pair: Pair, joints: list[FloatArray]) -> tuple[FloatArray, FloatArray]:
    kinds = pair.prediction.person.kind, pair.truth.person.kind
    both = [j[:, joint_rows(pair.joint_set, kind)] for j, kind in zip(joints, kinds, strict=True)]
    return both[0], both[1]


def _procrustes(
    prediction: FloatArray,
    truth: FloatArray,
    joints: tuple[FloatArray, FloatArray],
    protocol: Protocol,
) -> FloatArray:
    if protocol.pa_vertices == "vertices":
        return procrustes_error(prediction, truth)
    return point_error(umeyama(joints[0], joints[1]).apply(prediction), truth)


def _parts(body: Body) -> dict[str, list[tuple[IntArray, int]]]:
    """By metric: vertices that a part moves by more than half, and the joint they are aligned at."""
    if body.kind != "smplx":
        return {}
    weights = body.weights
    scored = np.zeros(len(weights), dtype=bool)
    scored[body.scored] = True
    regions = {
        "left": ([JOINT_INDEX["left_wrist"], *range(25, 40)], JOINT_INDEX["left_wrist"]),
        "right": ([JOINT_INDEX["right_wrist"], *range(40, 55)], JOINT_INDEX["right_wrist"]),
        "face": (
            [JOINT_INDEX[name] for name in ("head", "jaw", "left_eye", "right_eye")],
            JOINT_INDEX["neck"],
        ),
    }
    found = {
        name: (np.flatnonzero(scored & (weights[:, joints].sum(axis=1) > _PART_WEIGHT)), anchor)
        for name, (joints, anchor) in regions.items()
    }
    return {"pve_hands": [found["left"], found["right"]], "pve_face": [found["face"]]}


def _part_error(
    prediction: FloatArray,
    truth: FloatArray,
    joints_prediction: FloatArray,
    joints_truth: FloatArray,
    regions: list[tuple[IntArray, int]],
) -> FloatArray:
    """Mean error of regions, each aligned at its joint."""
    errors = []
    for vertices, anchor in regions:
        gap = (joints_prediction[:, anchor] - joints_truth[:, anchor])[:, None].astype(np.float32)
        errors.append(point_error(prediction[:, vertices] - gap, truth[:, vertices]))
    return np.asarray(np.mean(errors, axis=0))
