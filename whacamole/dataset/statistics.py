"""What is in a dataset, in numbers: one pass over its labels, a sequence in memory at a time.

An instance is one person in one image, as in Table 1 of the WHAC paper; only people in view count.
"""

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from whacamole.dataset.reader import Dataset, Sequence
from whacamole.errors import DatasetError

__all__ = ["Spread", "Statistics", "collect"]

FULL_FRAME_MM = 36.0
"""Width of the sensor that focal lengths in millimetres refer to."""

_BINS: dict[str, tuple[float, ...]] = {
    "distance_m": (0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0, 12.0, 20.0),
    "focal_mm": (0.0, 18.0, 24.0, 35.0, 50.0, 70.0, 100.0, 200.0),
    "visible_fraction": (0.0, 0.2, 0.4, 0.6, 0.8, 0.95),
    "truncation": (0.0, 0.01, 0.1, 0.25, 0.5, 0.75),
    "height_in_image": (0.0, 0.1, 0.25, 0.5, 0.75, 1.0),
}
"""Lower edges of the bins of every distribution; the last bin is open."""


@dataclass
class Spread:
    """A distribution, gathered piece by piece.

    Attributes:
        edges: lower edges of the bins; the last bin is open, values below the first are in the first.
        counts: values in each bin.
        low, high: least and greatest value; meaningless while there is none.
        total: sum of the values.
    """

    edges: tuple[float, ...]
    counts: list[int] = field(default_factory=list)
    low: float = float("inf")
    high: float = float("-inf")
    total: float = 0.0

    def __post_init__(self) -> None:
        """Begin with empty bins."""
        self.counts = self.counts or [0] * len(self.edges)

    def rows(self) -> list[tuple[str, int]]:
        """The bins in words with their counts, without those of nothing before and after."""
        filled = [number for number, count in enumerate(self.counts) if count]
        names = [f"{low:g} to {high:g}" for low, high in pairwise(self.edges)]
        names.append(f"{self.edges[-1]:g} and more")
        return list(zip(names, self.counts, strict=True))[filled[0] : filled[-1] + 1] if filled else []

    def add(self, values: NDArray[Any]) -> None:
        """Count values of any shape."""
        if not values.size:
            return
        bins = np.clip(np.searchsorted(self.edges, values.ravel(), side="right") - 1, 0, None)
        found = np.bincount(bins, minlength=len(self.edges))
        self.counts = [old + int(new) for old, new in zip(self.counts, found, strict=True)]
        self.low, self.high = min(self.low, float(values.min())), max(self.high, float(values.max()))
        self.total += float(values.sum(dtype=np.float64))

    @property
    def mean(self) -> float:
        """The mean; 0 where there is no value."""
        return self.total / max(1, sum(self.counts))

    def as_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        if not any(self.counts):
            return {"edges": list(self.edges), "counts": self.counts}
        numbers = {"least": self.low, "mean": self.mean, "greatest": self.high}
        return {**{key: round(value, 4) for key, value in numbers.items()}, "edges": list(self.edges),
                "counts": self.counts}  # fmt: skip


@dataclass
class Statistics:
    """What a dataset holds.

    Attributes:
        sequences, frames, instances, people: how many; people are tracks, counted in every sequence.
        seconds: length of all sequences together.
        interactive: sequences of motions recorded with two people.
        motions: number of different motions, of anybody.
        licences, sources, shots, stages, genders, sizes, splits: how often each; shots and genders are
            counted once a shot and once a person, the others once a sequence.
        body_models: name and checksum of the models the labels refer to.
        spreads: distributions over instances: distance of the pelvis [m], focal length for a sensor 36 mm
            wide [mm], visible fraction, truncation, height of the person's box over that of the image.
        joints: share of joints of instances that are ``outside``, ``hidden`` and ``seen``.
        ground_contact, person_contact: share of instances that touch the ground, another person.
        beta_mean, beta_deviation: of the shape coefficients over people.
    """

    sequences: int = 0
    frames: int = 0
    instances: int = 0
    people: int = 0
    seconds: float = 0.0
    interactive: int = 0
    motions: int = 0
    licences: dict[str, int] = field(default_factory=dict)
    sources: dict[str, int] = field(default_factory=dict)
    shots: dict[str, int] = field(default_factory=dict)
    stages: dict[str, int] = field(default_factory=dict)
    genders: dict[str, int] = field(default_factory=dict)
    sizes: dict[str, int] = field(default_factory=dict)
    splits: dict[str, int] = field(default_factory=dict)
    body_models: dict[str, str] = field(default_factory=dict)
    spreads: dict[str, Spread] = field(
        default_factory=lambda: {name: Spread(edges) for name, edges in _BINS.items()}
    )
    joints: dict[str, float] = field(default_factory=dict)
    ground_contact: float = 0.0
    person_contact: float = 0.0
    beta_mean: list[float] = field(default_factory=list)
    beta_deviation: list[float] = field(default_factory=list)

    def as_dict(self) -> dict[str, Any]:
        """Return plain values for JSON."""
        spreads = {name: spread.as_dict() for name, spread in self.spreads.items()}
        return {**asdict(self), "spreads": spreads, "seconds": round(self.seconds, 3)}


def collect(dataset: Dataset) -> Statistics:
    """Count what a dataset holds.

    Raises:
        DatasetError: a file of a sequence is missing or broken.
    """
    result, tally = Statistics(), _Tally()
    for sequence in dataset:
        try:
            _count_sequence(sequence, result, tally)
            _count_instances(sequence, result, tally)
        except KeyError as error:
            raise DatasetError(
                f"{sequence.layout.folder}: holds no {error}; run `whacamole check`, then render it again"
            ) from error
    for name in ("licences", "sources", "shots", "stages", "genders", "sizes"):
        setattr(result, name, _ordered(tally.counters.get(name, Counter())))
    result.splits = {
        path.stem: len(path.read_text(encoding="utf-8").split())
        for path in sorted(dataset.layout.splits.glob("*.txt"))
    }
    _finish(result, tally)
    return result


@dataclass
class _Tally:
    """Sums that become shares at the end."""

    counters: dict[str, Counter[str]] = field(default_factory=dict)
    motions: set[str] = field(default_factory=set)
    joints: NDArray[np.int64] = field(default_factory=lambda: np.zeros(3, np.int64))
    ground: int = 0
    person: int = 0
    betas: list[NDArray[Any]] = field(default_factory=list)

    def count(self, name: str, values: Iterable[object]) -> None:
        self.counters.setdefault(name, Counter()).update(str(value) for value in values)


def _count_sequence(sequence: Sequence, result: Statistics, tally: _Tally) -> None:
    facts, people = sequence.facts, sequence.people
    result.sequences += 1
    result.frames += len(sequence)
    result.people += len(people["track_id"])
    result.seconds += len(sequence) / float(facts["fps"])
    result.interactive += bool(facts.get("interactive"))
    result.body_models[str(people["body_model"])] = str(people["body_model_sha256"])
    tally.motions |= {str(motion) for motion in people["motion_id"]}
    tally.betas.append(people["betas"])
    width, height = sequence.size
    tally.count("licences", [facts.get("motion_licence", "not stated")])
    tally.count("sources", [facts.get("motion_source", "not stated")])
    tally.count("shots", facts.get("shots", ()))
    tally.count("stages", [facts.get("stage", "not stated")])
    tally.count("genders", people["gender"])
    tally.count("sizes", [f"{width}x{height}"])


def _count_instances(sequence: Sequence, result: Statistics, tally: _Tally) -> None:
    people, contact = sequence.people, sequence.contact
    width, height = sequence.size
    valid = people["valid"]
    instances = int(valid.sum())
    result.instances += instances
    focal = np.broadcast_to(sequence.camera["K"][:, 0, 0], valid.shape)[valid]
    boxes = people["bbox_xyxy"][valid]
    values: Mapping[str, NDArray[Any]] = {
        "distance_m": np.linalg.norm(people["joints_camera"][valid][:, 0], axis=-1),
        "focal_mm": focal * FULL_FRAME_MM / width,
        "visible_fraction": people["visible_fraction"][valid],
        "truncation": people["truncation"][valid],
        "height_in_image": (boxes[:, 3] - boxes[:, 1]) / height,
    }
    for name, spread in result.spreads.items():
        spread.add(values[name])
    tally.joints += np.bincount(people["joint_visibility"][valid].ravel(), minlength=3)[:3]
    tally.ground += int((contact["ground_contact"].any(axis=-1) & valid).sum())
    tally.person += int((contact["person_contact"].any(axis=(1, 3)) & valid).sum())


def _finish(result: Statistics, tally: _Tally) -> None:
    result.motions = len(tally.motions)
    instances, joints = max(1, result.instances), max(1, int(tally.joints.sum()))
    shares = (tally.joints / joints).tolist()
    result.joints = {
        name: round(share, 4) for name, share in zip(("outside", "hidden", "seen"), shares, strict=True)
    }
    result.ground_contact = round(tally.ground / instances, 4)
    result.person_contact = round(tally.person / instances, 4)
    if tally.betas:
        betas = np.concatenate(tally.betas).astype(np.float64)
        result.beta_mean = np.round(betas.mean(axis=0), 3).tolist()
        result.beta_deviation = np.round(betas.std(axis=0), 3).tolist()


def _ordered(counter: Counter[str]) -> dict[str, int]:
    """Return the counts, the most frequent first, then by name."""
    return dict(sorted(counter.items(), key=lambda item: (-item[1], item[0])))
