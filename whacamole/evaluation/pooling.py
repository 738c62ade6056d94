"""From values at frames to numbers in tables: exact pooling over any group, bootstrap intervals."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Literal

import numpy as np
import numpy.typing as npt

from whacamole.evaluation.catalogue import METRICS
from whacamole.evaluation.result import MethodResult, Result
from whacamole.evaluation.scores import SequenceScore

BoolArray = npt.NDArray[np.bool_]
GroupBy = Literal["sequence", "shot", "source", "visibility"]

VISIBILITY = {
    "all seen (≥ 0.9)": (0.9, np.inf),
    "half seen (0.5 … 0.9)": (0.5, 0.9),
    "hidden (< 0.5)": (-1.0, 0.5),
}
"""Groups of the visible fraction of a person in a frame: from, to."""

RESAMPLES = 2000
CONFIDENCE = 0.95


@dataclass(frozen=True, eq=False)
class Part:
    """The part of a sequence that belongs to a group.

    Attributes:
        people: (P, T) values of a person at a frame that count.
        frames: (T,) values of a frame that count, ``None`` if such values have no place in the group.
        whole: whether it is the whole sequence, so that values of the sequence and of a person count.
    """

    people: BoolArray
    frames: BoolArray | None
    whole: bool


Selection = Callable[[SequenceScore], Part | None]


def whole_sequence(score: SequenceScore) -> Part:
    """Everything."""
    return Part(np.ones(score.shape, dtype=bool), np.ones(score.shape[1], dtype=bool), True)


def moments(score: SequenceScore, key: str, selection: Selection = whole_sequence) -> tuple[float, float]:
    """Σ weight · value and Σ weight of a metric over the part of a sequence that is selected."""
    values, part = score.values.get(key), selection(score)
    if values is None or part is None:
        return 0.0, 0.0
    level = METRICS[key].level
    mask: BoolArray
    if level == "person_frame":
        mask = part.people
    elif level == "frame":
        mask = np.zeros(score.shape[1], dtype=bool) if part.frames is None else part.frames
    else:
        mask = np.full(values.shape, part.whole)
    counted = mask & np.isfinite(values)
    weights = np.where(counted, score.weights.get(key, 1.0), 0.0)
    return float((weights * np.where(counted, values, 0.0)).sum()), float(weights.sum())


def pooled(scores: Iterable[SequenceScore], key: str, selection: Selection = whole_sequence) -> float:
    """Weighted mean of a metric over sequences; NaN without a value.

    Values at frames are pooled over all frames of all sequences, values of a person over people, values of a
    sequence over sequences.
    """
    both = np.array([moments(score, key, selection) for score in scores]).reshape(-1, 2).sum(axis=0)
    return float(both[0] / both[1]) if both[1] > 0 else float("nan")


def groups(result: Result, by: GroupBy) -> Iterator[tuple[str, Selection]]:
    """Labels and selections of the groups that the scored sequences have."""
    scores = [score for method in result.methods for score in method.sequences.values()]
    if by == "sequence":
        for name in sorted({score.id for score in scores}):
            yield name, partial(_if_equal, "id", name)
    elif by == "source":
        for name in sorted({score.source for score in scores if score.source}):
            yield name, partial(_if_equal, "source", name)
    elif by == "shot":
        for name in sorted({shot for score in scores for shot in score.shots if shot}):
            yield name, partial(_of_shot, name)
    else:
        for name, (low, high) in VISIBILITY.items():
            if any(((score.visible >= low) & (score.visible < high)).any() for score in scores):
                yield name, partial(_of_visibility, low, high)


def _if_equal(attribute: str, name: str, score: SequenceScore) -> Part | None:
    return whole_sequence(score) if getattr(score, attribute) == name else None


def _of_shot(name: str, score: SequenceScore) -> Part | None:
    frames = np.array([shot == name for shot in score.shots], dtype=bool)
    if not frames.any():
        return None
    return Part(np.broadcast_to(frames, score.shape), frames, bool(frames.all()))


def _of_visibility(low: float, high: float, score: SequenceScore) -> Part:
    with np.errstate(invalid="ignore"):
        return Part((score.visible >= low) & (score.visible < high), None, False)


@dataclass(frozen=True)
class Interval:
    """A difference of two methods with its bootstrap interval.

    Attributes:
        difference: pooled(second) − pooled(first) over the sequences both have.
        low, high: limits of the interval.
        sequences: how many sequences were resampled.
    """

    difference: float
    low: float
    high: float
    sequences: int

    @property
    def clear(self) -> bool:
        """Whether 0 lies outside."""
        return self.low > 0.0 or self.high < 0.0


def paired_bootstrap(
    first: MethodResult,
    second: MethodResult,
    key: str,
    *,
    seed: int = 0,
    resamples: int = RESAMPLES,
    confidence: float = CONFIDENCE,
) -> Interval | None:
    """Percentile interval of the difference of two methods: whole sequences are resampled, the same for both.

    Frames of a sequence depend on each other, so the sequence is the unit (a cluster bootstrap; Efron and
    Tibshirani 1993). ``None`` with fewer than two sequences that both methods have values for.
    """
    common = sorted(first.sequences.keys() & second.sequences.keys())
    table = np.array(
        [[moments(method.sequences[name], key) for name in common] for method in (first, second)]
    ).reshape(2, len(common), 2)
    table = table[:, (table[..., 1] > 0).all(axis=0)]
    count = table.shape[1]
    if count < 2:
        return None
    rng = np.random.default_rng(seed)
    drawn = rng.multinomial(count, np.full(count, 1.0 / count), size=resamples)
    sums = np.einsum("rs,msk->mrk", drawn, table)
    means = sums[..., 0] / sums[..., 1]
    tail = 50.0 * (1.0 - confidence)
    low, high = np.percentile(means[1] - means[0], [tail, 100.0 - tail])
    total = table.sum(axis=1)
    return Interval(float(np.diff(total[:, 0] / total[:, 1])[0]), float(low), float(high), count)


def summary(result: Result, keys: Sequence[str] | None = None) -> Mapping[str, Mapping[str, float]]:
    """Method name → metric key → pooled value: of the metrics named, or of all that have a value."""
    named = list(METRICS) if keys is None else list(keys)
    return {
        method.name: {
            key: value
            for key in named
            if np.isfinite(value := pooled(method.sequences.values(), key)) or keys
        }
        for method in result.methods
    }
