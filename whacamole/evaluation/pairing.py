"""A person and the track that was matched to it, cut to the frames both have."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from whacamole.evaluation.core.alignment import FloatArray
from whacamole.evaluation.core.segments import rows_of_segments, segments
from whacamole.evaluation.figure import Figure
from whacamole.evaluation.joints import common_set, joint_rows
from whacamole.evaluation.protocol import JointSet, Protocol
from whacamole.evaluation.records import IntArray, Space


@dataclass(frozen=True, eq=False)
class Timeline:
    """The frames of the truth and where a protocol puts them in time.

    Attributes:
        position: (T,) time of each row of the truth, in frames from the first.
        fps: of acceleration and jitter.
        fps_video: of the recording.
    """

    position: IntArray
    fps: float

    @classmethod
    def of(cls, frame_index: IntArray, fps: float, protocol: Protocol) -> "Timeline":
        """Positions count steps of the recording, so one that keeps every second frame has no gaps."""
        steps = np.diff(frame_index)
        step = int(steps.min()) if len(steps) else 1
        return cls((frame_index - frame_index[:1]) // max(step, 1), protocol.fps or fps)

    @property
    def length(self) -> int:
        """Frames from the first to the last."""
        return int(self.position[-1]) + 1 if len(self.position) else 0


class Pair:
    """What is compared of one person.

    Args:
        index: the person's place in the truth.
        truth, prediction: both bodies.
        frame_of_prediction: row of the truth for each row of the prediction, −1 for none.
        timeline: of the truth.
        protocol: decides joints and what gaps are.

    Attributes:
        rows: rows of the truth (F,).
        at_truth, at_prediction: where they are in the two figures (F,).
        frames: (F,) time of each row, as differences over time see it.
        joint_set: the set compared.
        note: why it is not the one asked for, or ``None``.
    """

    def __init__(
        self,
        index: int,
        truth: Figure,
        prediction: Figure,
        frame_of_prediction: IntArray,
        timeline: Timeline,
        protocol: Protocol,
    ) -> None:
        self.index, self.truth, self.prediction = index, truth, prediction
        self.rows, self.at_truth, self.at_prediction = np.intersect1d(
            truth.rows, frame_of_prediction[prediction.rows], return_indices=True
        )
        closed = protocol.gaps == "close"
        self.frames = np.arange(len(self.rows)) if closed else timeline.position[self.rows]
        self._length = len(self.rows) if closed else timeline.length
        self._protocol = protocol
        kinds = truth.person.kind, prediction.person.kind
        self.joint_set: JointSet
        self.joint_set, self.note = common_set(protocol.joints, kinds)
        self.regressed: tuple[FloatArray, FloatArray] | None = None
        """True and predicted local joints (F, 14, 3) regressed from vertices, for ``h36m14``."""

    def segments(self) -> list[IntArray]:
        """Rows of each segment of the protocol that has any."""
        p = self._protocol
        return rows_of_segments(
            segments(self._length, p.segment_frames, p.tail, p.shortest_tail), self.frames
        )

    def joints(self, space: Space) -> tuple[FloatArray, FloatArray] | None:
        """Predicted and true joints of the set (F, K, 3) [m], ``None`` where either is not known."""
        if self.joint_set == "h36m14":
            return self._regressed(space)
        both = []
        for figure, at in self._sides:
            joints = figure.joints(space)
            if joints is None:
                return None
            both.append(joints[np.ix_(at, joint_rows(self.joint_set, figure.person.kind))])
        return both[0], both[1]

    def _regressed(self, space: Space) -> tuple[FloatArray, FloatArray] | None:
        if self.regressed is None:
            return None
        local = self.regressed[1], self.regressed[0]
        placed = [
            figure.place(points, space, at) for (figure, at), points in zip(self._sides, local, strict=True)
        ]
        return None if placed[0] is None or placed[1] is None else (placed[0], placed[1])

    @property
    def _sides(self) -> tuple[tuple[Figure, IntArray], tuple[Figure, IntArray]]:
        return (self.prediction, self.at_prediction), (self.truth, self.at_truth)

    @cached_property
    def local_joints(self) -> tuple[FloatArray, FloatArray]:
        """Predicted and true joints (F, J, 3) [m], pelvis at the origin, root not turned."""
        return self.prediction.local_joints[self.at_prediction], self.truth.local_joints[self.at_truth]

    def roots(
        self, space: Space
    ) -> tuple[tuple[FloatArray, FloatArray], tuple[FloatArray, FloatArray]] | None:
        """((orientation, pelvis) predicted, the same true): (F, 3, 3) and (F, 3) [m]."""
        both = []
        for figure, at in self._sides:
            root = figure.root(space)
            if root is None:
                return None
            both.append((root[0][at], root[1][at]))
        return both[0], both[1]

    def transl(self, space: Space) -> tuple[FloatArray, FloatArray] | None:
        """Predicted and true parameter ``transl`` (F, 3) [m], from the source where it gives this space."""
        both = []
        for figure, at in self._sides:
            placement = figure.person.world if space == "world" else figure.person.camera
            if placement is None:
                return None
            both.append(placement.transl[figure.rows[at]])
        return both[0], both[1]
