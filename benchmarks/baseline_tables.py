"""Run the baseline with many sets of options and put what `whacamole evaluate` finds into one table."""

import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from whacamole.dataset import open_dataset
from whacamole.evaluation import METRICS, Bodies, evaluate, pooled

WORLD = ("pa_mpjpe", "w_mpjpe", "wa_mpjpe", "h_ate", "h_as", "c_ate", "c_as")
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
        words = ["baseline", "run", "--data", data, "--split", split, "--out", out, *options, "-q"]
        # A sequence that cannot be done is told on standard error, and missing in the count of sequences.
        subprocess.run([sys.executable, "-m", "whacamole", *map(str, words)], check=False)
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
    titles = [f"{METRICS[key].label} [{METRICS[key].unit}]".removesuffix(" []") for key in metrics]
    titles = ["sequences", "seen", *titles, "C-AS, median"]
    rows = [f"| method | {' | '.join(titles)} |", f"| --- |{' ---: |' * len(titles)}"]
    for method in result.methods:
        scores = [score for name, score in method.sequences.items() if not chosen or name in chosen]
        seen, wanted = (
            sum(score.counts[key] for score in scores) for key in ("person_frames_scored", "person_frames")
        )
        cells = [str(len(scores)), f"{100.0 * seen / max(wanted, 1):.0f} %"]
        cells += [f"{pooled(scores, key):.{METRICS[key].digits}f}" for key in metrics]
        scales = [float(score.values["c_as"]) for score in scores if "c_as" in score.values]
        cells.append(f"{np.median(scales):.2f}" if scales else "–")
        rows.append(f"| {method.name} | {' | '.join(cells)} |")
    return "\n".join(rows)
