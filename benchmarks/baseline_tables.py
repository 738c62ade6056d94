"""Run the baseline with many sets of options and put what `whacamole evaluate` finds into one table."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from whacamole.cli.baseline import app
from whacamole.dataset import open_dataset
from whacamole.evaluation import METRICS, Bodies, SequenceScore, evaluate, pooled

WORLD = ("pa_mpjpe", "w_mpjpe", "wa_mpjpe", "h_ate", "h_as", "c_ate", "c_as")
EACH = ("pa_mpjpe", "t_mpjpe", "wa_mpjpe", "c_ate", "c_as")
INTRINSICS = ("t_mpjpe", "w_mpjpe", "wa_mpjpe", "c_as")


def predicted(data: Path, work: Path, runs: Mapping[str, Sequence[object]], split: str) -> dict[str, Path]:
    """Predictions of every set of options; those that are in ``work`` already are kept."""
    chosen = open_dataset(data) if split == "all" else open_dataset(data).split(split)
    ids = [sequence.id for sequence in chosen]
    folders = {}
    for label, options in runs.items():
        out = work / "predictions" / data.name / label.replace(" ", "_")
        folders[label] = out
        if all((out / f"{name}.npz").exists() for name in ids):
            continue
        words = ["run", "--data", data, "--split", split, "--out", out, *options, "--keep", "-q"]
        # A sequence that cannot be done is told on standard error, and missing in the count of sequences.
        app([str(word) for word in words], standalone_mode=False)
    return folders


def table(
    data: Path,
    predictions: Mapping[str, Path],
    metrics: Sequence[str],
    split: str,
    chosen: Sequence[str] = (),
) -> str:
    """Markdown, one row a method.

    *seen* is the share of the labelled people's frames that a prediction has. The mean of a ratio says little
    where one sequence is far off, so the median of C-AS over the sequences stands beside it.

    Args:
        chosen: ids of the sequences that count; all if empty.
    """
    result = evaluate(data, predictions, "whac", split=split, bodies=Bodies(vertices=False))
    rows = _head("method", ["sequences", *_titles(metrics), "C-AS, median"])
    for method in result.methods:
        scores = [score for name, score in method.sequences.items() if not chosen or name in chosen]
        scales = [float(score.values["c_as"]) for score in scores if "c_as" in score.values]
        median = f"{np.median(scales):.2f}" if scales else "–"
        rows.append(_row(method.name, [str(len(scores)), *_cells(scores, metrics), median]))
    return "\n".join(rows)


def by_sequence(data: Path, predictions: Path, metrics: Sequence[str], split: str) -> str:
    """Markdown, one row a sequence; *people* are those labelled and the tracks found."""
    [method] = evaluate(data, predictions, "whac", split=split, bodies=Bodies(vertices=False)).methods
    rows = _head("sequence", ["people", *_titles(metrics)])
    for name, score in method.sequences.items():
        people = score.counts["people"]
        tracks = score.counts["people_matched"] + score.counts["tracks_extra"]
        rows.append(_row(name, [f"{people}, found {tracks}", *_cells([score], metrics)]))
    return "\n".join(rows)


def _titles(metrics: Sequence[str]) -> list[str]:
    return ["seen", *(f"{METRICS[key].label} [{METRICS[key].unit}]".removesuffix(" []") for key in metrics)]


def _cells(scores: Sequence[SequenceScore], metrics: Sequence[str]) -> list[str]:
    seen, wanted = (
        sum(score.counts[key] for score in scores) for key in ("person_frames_scored", "person_frames")
    )
    found = [(pooled(scores, key), METRICS[key].digits) for key in metrics]
    numbers = [f"{value:.{digits}f}" if np.isfinite(value) else "–" for value, digits in found]
    return [f"{100.0 * seen / max(wanted, 1):.0f} %", *numbers]


def _head(first: str, titles: Sequence[str]) -> list[str]:
    return [_row(first, titles), f"| --- |{' ---: |' * len(titles)}"]


def _row(first: str, cells: Sequence[str]) -> str:
    return f"| {first} | {' | '.join(cells)} |"
