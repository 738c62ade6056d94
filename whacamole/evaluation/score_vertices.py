"""Vertex errors of one person, a block of frames at a time."""

from dataclasses import dataclass

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


@dataclass(frozen=True, eq=False)
class VertexScores:
    """Per-frame errors, and what other metrics need of the vertices.

    Attributes:
        errors: metric key → (F,) [mm].
        feet: predicted and true foot points (F, 4, 3) [m], local.
        regressed: true and predicted regressed joints (F, 14, 3) [m], local, or ``None``.
    """

    errors: dict[str, FloatArray]
    feet: tuple[FloatArray, FloatArray]
    regressed: tuple[FloatArray, FloatArray] | None


def score_vertices(pair: Pair, protocol: Protocol, options: VertexOptions) -> VertexScores:
    """Pose both bodies, a block of frames at a time, and compare their surfaces.

    All happens in the true body's own frame, pelvis at the origin and root not turned: distances do not
    change, and the true vertices need no transform.

    Raises:
        EvaluationError: the meshes differ and no mapping fits, or a joint regressor is wanted and not given.
    """
    surfaces = _Surfaces(pair, protocol, options)
    frames = max(1, BLOCK // max(len(body.weights) for body in surfaces.bodies))
    rows = np.arange(len(pair.rows))
    blocks = [surfaces.compare(rows[start : start + frames]) for start in range(0, len(rows), frames)]
    joined = {key: np.concatenate([block[key] for block in blocks]) for key in blocks[0]}
    feet = joined.pop("feet"), joined.pop("feet_truth")
    regressed = None
    if "regressed" in joined:
        regressed = joined.pop("regressed_truth"), joined.pop("regressed")
    return VertexScores(joined, feet, regressed)


class _Surfaces:
    """The two bodies of a pair and what stays the same for all blocks."""

    def __init__(self, pair: Pair, protocol: Protocol, options: VertexOptions) -> None:
        self.pair, self.protocol, self.options = pair, protocol, options
        self.bodies = _bodies(pair)
        self._moves = _moves(pair)
        self._parts = _parts(self.bodies[1])

    def compare(self, at: IntArray) -> dict[str, FloatArray]:
        """Errors at some rows, with "feet", "feet_truth" and, if wanted, "regressed", "regressed_truth"."""
        pair, bodies = self.pair, self.bodies
        raw = pair.prediction.local_vertices(pair.at_prediction[at])
        ours = pair.truth.local_vertices(pair.at_truth[at])
        theirs = _mapped(raw, bodies, self.options)
        found: dict[str, FloatArray] = {"feet": raw[:, bodies[0].feet], "feet_truth": ours[:, bodies[1].feet]}
        joints = [both[at] for both in pair.local_joints]
        sets = _sets(pair, joints)
        if self.protocol.joints == "h36m14":
            sets = _regress(theirs, self.options), _regress(ours, self.options)
            found |= {"regressed": sets[0], "regressed_truth": sets[1]}
        scored = bodies[1].scored
        found["pa_pve"] = _procrustes(theirs[:, scored], ours[:, scored], sets, self.protocol)
        if self._moves is not None:
            found |= self._placed(theirs, ours, joints, sets, (self._moves[0][at], self._moves[1][at]))
        return found

    def _placed(
        self,
        theirs: Float32Array,
        ours: Float32Array,
        joints: list[FloatArray],
        sets: tuple[FloatArray, FloatArray],
        moves: tuple[FloatArray, FloatArray],
    ) -> dict[str, FloatArray]:
        """Errors that need both bodies in the camera's frame."""
        turn, shift = moves
        moved, scored = _turned(theirs, turn), self.bodies[1].scored
        root = root_of(_turned(sets[0], turn), self.pair.joint_set, self.protocol.root)
        gap = root - root_of(sets[1], self.pair.joint_set, self.protocol.root)
        found = {
            key: point_error(moved[:, scored] + by[:, None].astype(np.float32), ours[:, scored])
            for key, by in (("t_pve", shift), ("pve", -gap))
        }
        placed = _turned(joints[0], turn)
        for key, regions in self._parts.items():
            found[key] = _part_error(moved, ours, placed, joints[1], regions)
        return found


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
