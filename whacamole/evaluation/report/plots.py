"""The plots of a sequence: paths seen from above, and errors over time."""

import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from whacamole.errors import EvaluationError
from whacamole.evaluation.catalogue import METRICS
from whacamole.evaluation.report.svg import COLOURS, Line, chart
from whacamole.evaluation.result import Result
from whacamole.evaluation.scores import SequenceScore

Points = npt.NDArray[np.float64]

_CANDIDATES = ("w_mpjpe", "wa_mpjpe", "mpjpe", "pa_mpjpe", "c_rpe_t")
_TRUTH = "#222222"


def plane_of(score: SequenceScore) -> npt.NDArray[np.float64]:
    """Two horizontal directions (2, 3): across ``up``, or of the largest spread where up is not known."""
    up = np.asarray(score.up, dtype=np.float64)
    if not up.any():
        points = np.concatenate([path for key, path in score.paths.items() if key.startswith("truth/")])
        points = points[np.isfinite(points).all(axis=1)]
        return np.asarray(np.linalg.svd(points - points.mean(axis=0), full_matrices=False)[2][:2])
    first = np.eye(3)[0] if abs(up[0]) < 0.9 else np.eye(3)[1]
    first = first - up * (first @ up)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(up, first)])


def trajectories(scores: Sequence[tuple[str, SequenceScore]]) -> str:
    """Paths from above, as in the paper: truth in black, each method in its colour, cameras dashed.

    Args:
        scores: (method, scores of the same sequence).
    """
    first = scores[0][1]
    plane = plane_of(first)
    lines: list[Line] = []
    for key, path in first.paths.items():
        if key.startswith("truth/"):
            lines.append(_from_above("truth" if not lines else "", path, plane, _TRUTH, "camera" in key, 3.0))
    for number, (name, score) in enumerate(scores):
        colour, named = COLOURS[number % len(COLOURS)], False
        for key, path in score.paths.items():
            if key.startswith("prediction/"):
                lines.append(_from_above("" if named else name, path, plane, colour, "camera" in key))
                named = True
    return chart(lines, f"{first.id}: from above", "m", "m", equal=True)


def _from_above(
    label: str, path: Points, plane: Points, colour: str, camera: bool, width: float = 1.6
) -> Line:
    flat = path @ plane.T
    return Line(label, flat[:, 0], flat[:, 1], colour, dashed=camera, width=width, dotted=True)


def error_over_time(scores: Sequence[tuple[str, SequenceScore]], key: str | None = None) -> str | None:
    """A metric at every frame, the mean over people; ``None`` if no method has one.

    Args:
        scores: (method, scores of the same sequence).
        key: a metric with values at frames; otherwise the first that any method has of the world's and the
            camera's.
    """
    wanted = key or next((k for k in _CANDIDATES if any(k in score.values for _, score in scores)), None)
    if wanted is None:
        return None
    metric = METRICS[wanted]
    lines = []
    for number, (name, score) in enumerate(scores):
        values = score.values.get(wanted)
        if values is not None:
            curve = _mean_over_people(values)
            lines.append(
                Line(name, score.frame_index.astype(np.float64), curve, COLOURS[number % len(COLOURS)])
            )
    title = f"{scores[0][1].id}: {metric.label} over time"
    return chart(lines, title, "frame", f"{metric.label} [{metric.unit}]") if lines else None


def _mean_over_people(values: Points) -> Points:
    if values.ndim == 1:
        return values
    count = np.isfinite(values).sum(axis=0)
    total = np.where(np.isfinite(values), values, 0.0).sum(axis=0)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)


def scores_of(result: Result, sequence_id: str) -> list[tuple[str, SequenceScore]]:
    """(method, scores) of one sequence."""
    return [(m.name, m.sequences[sequence_id]) for m in result.methods if sequence_id in m.sequences]


def sequence_plots(result: Result, sequence_id: str) -> dict[str, str]:
    """The SVG plots of a sequence by name."""
    scores = scores_of(result, sequence_id)
    if not scores:
        return {}
    plots = {}
    if any(key.startswith("truth/") for key in scores[0][1].paths):
        plots["trajectories"] = trajectories(scores)
    over_time = error_over_time(scores)
    if over_time is not None:
        plots["error"] = over_time
    return plots


def write_plots(result: Result, folder: Path) -> list[Path]:
    """Write the plots of all sequences as ``<sequence>-trajectories.svg`` and ``<sequence>-error.svg``.

    Raises:
        EvaluationError: the folder cannot be written to.
    """
    written = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for sequence_id in result.ids:
            for name, svg in sequence_plots(result, sequence_id).items():
                path = folder / f"{re.sub(r'[^A-Za-z0-9_.-]', '_', sequence_id)}-{name}.svg"
                path.write_text(svg, encoding="utf-8")
                written.append(path)
    except OSError as error:
        raise EvaluationError(
            f"{folder}: {error.strerror or error}; choose a folder that can be written"
        ) from error
    return written
