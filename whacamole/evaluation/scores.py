"""The scores of one sequence: every value at its frame and person, so that any group pools exactly."""

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from whacamole.evaluation.core.alignment import FloatArray
from whacamole.evaluation.records import IntArray

COUNTS = (
    "people",
    "people_matched",
    "people_missing",
    "tracks_extra",
    "person_frames",
    "person_frames_scored",
    "person_frames_missing",
    "person_frames_nan",
    "segments",
    "segments_short",
    "people_static",
    "cameras_static",
    "cameras_missing",
    "people_without_segment",
)
"""What is counted in every sequence, so that nothing left out stays silent."""


@dataclass(eq=False)
class SequenceScore:
    """One sequence, scored.

    Attributes:
        id, source: of the recording.
        frame_index: (T,).
        shots: (T,) camera move of each frame, "" where not known.
        visible: (P, T) visible fraction, NaN where not known.
        values: metric key → array of its level's shape (P, T), (T,), (P,) or (), NaN where there is no value.
        weights: metric key → weights of the same shape, for metrics that do not count every value once.
        counts: see :data:`COUNTS`.
        matches: (true track id, predicted track id, distance) of every matched person.
        notes: one line each.
        paths: curves for the plots: "truth/person/0", "prediction/person/0", "truth/camera",
            "prediction/camera", each (T, 3) [m] with NaN where absent; predictions are moved onto the truth.
        up: direction away from the ground, zeros where not known.
    """

    id: str
    source: str
    frame_index: IntArray
    shots: tuple[str, ...]
    visible: FloatArray
    values: dict[str, npt.NDArray[np.float64]] = field(default_factory=dict)
    weights: dict[str, npt.NDArray[np.float64]] = field(default_factory=dict)
    counts: dict[str, int] = field(default_factory=lambda: dict.fromkeys(COUNTS, 0))
    matches: list[tuple[int, int, float]] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    paths: dict[str, npt.NDArray[np.float64]] = field(default_factory=dict)
    up: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @property
    def shape(self) -> tuple[int, int]:
        """P, T."""
        return self.visible.shape[0], self.visible.shape[1]

    def note(self, line: str) -> None:
        """Add a note once."""
        if line not in self.notes:
            self.notes.append(line)

    def put(
        self, key: str, person: int, rows: IntArray, values: FloatArray, weights: FloatArray | None = None
    ) -> None:
        """Store values (F,) of a person at frames ``rows`` (F,)."""
        self.values.setdefault(key, np.full(self.shape, np.nan))[person, rows] = values
        if weights is not None:
            self.weights.setdefault(key, np.zeros(self.shape))[person, rows] = weights

    def put_frames(self, key: str, rows: IntArray, values: FloatArray) -> None:
        """Store values (F,) of the sequence at frames ``rows``."""
        self.values.setdefault(key, np.full(self.shape[1], np.nan))[rows] = values

    def put_person(self, key: str, person: int, value: float) -> None:
        """Store one value of a person."""
        self.values.setdefault(key, np.full(self.shape[0], np.nan))[person] = value

    def put_path(self, key: str, rows: IntArray, points: FloatArray) -> None:
        """Store a curve (F, 3) at frames ``rows``."""
        self.paths.setdefault(key, np.full((self.shape[1], 3), np.nan))[rows] = points
