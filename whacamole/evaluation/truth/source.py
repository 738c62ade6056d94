"""What every ground truth is: a list of sequence ids and a way to read one."""

from collections.abc import Callable, Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Protocol

from whacamole.errors import EvaluationError
from whacamole.evaluation.records import Recording
from whacamole.evaluation.truth.dataset import DatasetTruth
from whacamole.evaluation.truth.egobody import EgoBodyTruth
from whacamole.evaluation.truth.emdb import EmdbTruth
from whacamole.evaluation.truth.rich import RichTruth
from whacamole.evaluation.truth.threedpw import ThreedpwTruth


class TruthSource(Protocol):
    """Ground truth of many sequences, read one at a time."""

    @property
    def name(self) -> str:
        """As tables name it."""

    def ids(self, split: str) -> list[str]:
        """Sequence ids of a split, sorted.

        Raises:
            EvaluationError: no such split, or it is empty.
        """

    def read(self, sequence_id: str) -> Recording:
        """One sequence.

        Raises:
            EvaluationError: its files cannot be used; one line.
        """


SOURCES: Mapping[str, tuple[Callable[[Path], TruthSource], tuple[str, ...]]] = MappingProxyType(
    {
        "whacamole": (DatasetTruth, ("sequences",)),
        "3dpw": (ThreedpwTruth, ("sequenceFiles",)),
        "rich": (RichTruth, ("scan_calibration", "data/scan_calibration")),
        "egobody": (EgoBodyTruth, ("data_info_release.csv",)),
        "emdb": (EmdbTruth, ("P0", "P1", "P2", "P3", "P4", "P5", "P6", "P7", "P8", "P9")),
    }
)
"""Kinds of ground truth: how to open one, and the names in its folder that tell it."""


def open_truth(root: Path, kind: str = "auto") -> TruthSource:
    """Open a folder of ground truth.

    Args:
        root: the folder.
        kind: a name of :data:`SOURCES`, or "auto": by what the folder holds.

    Raises:
        EvaluationError: not a folder, or of no known kind.
    """
    if not root.is_dir():
        raise EvaluationError(
            f"{root}: not a folder; give a dataset made by `whacamole render` or a benchmark's folder"
        )
    if kind != "auto":
        if kind not in SOURCES:
            raise EvaluationError(f"no ground truth of kind {kind!r}, only auto, {', '.join(SOURCES)}")
        return SOURCES[kind][0](root)
    for open_source, marks in SOURCES.values():
        if any((root / mark).exists() for mark in marks):
            return open_source(root)
    raise EvaluationError(
        f"{root}: neither a dataset (sequences/) nor EMDB (P0/ …), 3DPW (sequenceFiles/), "
        "RICH (scan_calibration/) or EgoBody (data_info_release.csv)"
    )
