"""Vertex errors of one person, a block of frames at a time."""

from dataclasses import dataclass

import numpy as np

from whacamole.body import JOINT_INDEX
from whacamole.errors import EvaluationError
from whacamole.evaluation.bodies import Body, Float32Array
from whacamole.evaluation.core.alignment import FloatArray, umeyama
from whacamole.evaluation.core.surface import Region, aligned_error, region_errors, surface_similarity
from whacamole.evaluation.joints import H36M14, joint_rows, root_of
from whacamole.evaluation.pairing import Pair
from whacamole.evaluation.protocol import Protocol
from whacamole.evaluation.records import IntArray

BLOCK = 1_400_000
"""Vertices of a body held at once (frames × V): bounds the memory."""

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
    change, and neither side needs a transform after it is posed.

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
        turn, shift = (None, None) if self._moves is None else (self._moves[0][at], self._moves[1][at])
        raw = pair.prediction.local_vertices(pair.at_prediction[at], turn)
        ours = pair.truth.local_vertices(pair.at_truth[at])
        theirs = _mapped(raw, bodies, self.options)
        back = np.eye(3) if turn is None else turn  # a row times R is its column times Rᵀ
        found: dict[str, FloatArray] = {
            "feet": _points(raw, bodies[0].feet) @ back,
            "feet_truth": _points(ours, bodies[1].feet),
        }
        joints = [both[at] for both in pair.local_joints]
        if turn is not None:
            joints[0] = _turned(joints[0], turn)
        sets = _sets(pair, joints)
        if self.protocol.joints == "h36m14":
            sets = _regress(theirs, self.options), _regress(ours, self.options)
            found |= {"regressed": sets[0] @ back, "regressed_truth": sets[1]}
        scored = bodies[1].scored
        both = theirs[scored], ours[scored]
        if shift is not None:
            found |= self._placed(both, joints, sets, shift)
        by_joints = self.protocol.pa_vertices == "joints"
        similarity = umeyama(*sets) if by_joints else surface_similarity(*both)
        return found | {"pa_pve": aligned_error(*both, similarity)}

    def _placed(
        self,
        surfaces: tuple[Float32Array, Float32Array],
        joints: list[FloatArray],
        sets: tuple[FloatArray, FloatArray],
        shift: FloatArray,
    ) -> dict[str, FloatArray]:
        """Errors that need both bodies in the camera's frame."""
        roots = [root_of(side, self.pair.joint_set, self.protocol.root) for side in sets]
        regions = {"t_pve": [Region(None, shift.T)], "pve": [Region(None, (roots[1] - roots[0]).T)]}
        for key, parts in self._parts.items():
            regions[key] = [Region(rows, (joints[1] - joints[0])[:, anchor].T) for rows, anchor in parts]
        errors = region_errors(*surfaces, [region for each in regions.values() for region in each])
        return {key: np.mean([errors.pop(0) for _ in each], axis=0) for key, each in regions.items()}


def _points(surface: Float32Array, rows: IntArray) -> FloatArray:
    """A few vertices (F, n, 3) of a surface (V, 3, F)."""
    return surface[rows].transpose(2, 0, 1).astype(np.float64)


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
    return points @ np.swapaxes(turn, -1, -2)


def _mapped(vertices: Float32Array, bodies: tuple[Body, Body], options: VertexOptions) -> Float32Array:
    """Predicted vertices in the truth's topology."""
    if bodies[0].topology == bodies[1].topology:
        return vertices
    matrix = options.mapping
    shape = getattr(matrix, "shape", (0, 0))
    if len(shape) != 2 or shape[1] != len(vertices) or shape[0] != len(bodies[1].weights):
        raise EvaluationError(
            f"meshes {bodies[0].topology} and {bodies[1].topology} have no common vertices; add --vertex-map"
        )
    mapped: Float32Array = matrix @ vertices.reshape(len(vertices), -1)  # type: ignore[operator]
    return mapped.reshape(shape[0], *vertices.shape[1:])


def _regress(vertices: Float32Array, options: VertexOptions) -> FloatArray:
    """The 14 joints (F, 14, 3) [m] of vertices (V, 3, F)."""
    if options.regressor is None or options.regressor.shape[1] != len(vertices):
        raise EvaluationError("joints=h36m14 are regressed from SMPL vertices; add --joint-regressor")
    flat = options.regressor[list(H36M14)] @ vertices.reshape(len(vertices), -1)
    return flat.reshape(len(H36M14), *vertices.shape[1:]).transpose(2, 0, 1)


def _sets(pair: Pair, joints: list[FloatArray]) -> tuple[FloatArray, FloatArray]:
    kinds = pair.prediction.person.kind, pair.truth.person.kind
    both = [j[:, joint_rows(pair.joint_set, kind)] for j, kind in zip(joints, kinds, strict=True)]
    return both[0], both[1]


def _parts(body: Body) -> dict[str, list[tuple[IntArray, int]]]:
    """By metric: scored vertices that a part moves by more than half, and the joint they are aligned at."""
    if body.kind != "smplx":
        return {}
    weights = body.weights[body.scored]
    regions = {
        "left": ([JOINT_INDEX["left_wrist"], *range(25, 40)], JOINT_INDEX["left_wrist"]),
        "right": ([JOINT_INDEX["right_wrist"], *range(40, 55)], JOINT_INDEX["right_wrist"]),
        "face": (
            [JOINT_INDEX[name] for name in ("head", "jaw", "left_eye", "right_eye")],
            JOINT_INDEX["neck"],
        ),
    }
    found = {
        name: (np.flatnonzero(weights[:, joints].sum(axis=1) > _PART_WEIGHT), anchor)
        for name, (joints, anchor) in regions.items()
    }
    return {"pve_hands": [found["left"], found["right"]], "pve_face": [found["face"]]}
