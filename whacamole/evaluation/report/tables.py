"""Which numbers stand together: the paper's tables, groups of metrics and frames, differences, coverage."""

from collections.abc import Sequence

import numpy as np

from whacamole.evaluation.catalogue import GROUPS, METRICS, metrics_of
from whacamole.evaluation.pooling import (
    CONFIDENCE,
    RESAMPLES,
    GroupBy,
    groups,
    paired_bootstrap,
    pooled,
)
from whacamole.evaluation.report.table import Column, Table
from whacamole.evaluation.result import MethodResult, Result

PAPER: dict[str, tuple[str, tuple[str, ...]]] = {
    "world": (
        "World-frame evaluation",
        ("pa_mpjpe", "w_mpjpe", "wa_mpjpe", "h_ate", "h_as", "c_ate", "c_as"),
    ),
    "camera": ("Camera-frame evaluation", ("mpjpe", "pa_mpjpe", "t_mpjpe", "pve", "pa_pve", "t_pve")),
    "ablation": ("Ablation of the trajectory", ("wa_mpjpe", "w_mpjpe", "h_ate", "c_ate", "c_as")),
    "focal": ("Ablation of the focal length", ("t_mpjpe", "w_mpjpe", "wa_mpjpe")),
}
"""The tables of WHAC (arXiv 2403.12959): title and metrics."""

GROUP_TITLES: dict[GroupBy, str] = {
    "sequence": "By sequence",
    "shot": "By camera move",
    "source": "By motion source",
    "visibility": "By visibility of the person",
}


def column_of(key: str, result: Result) -> Column:
    """A metric as a column; W- and WA-MPJPE carry the length of their segments."""
    metric = METRICS[key]
    length = result.protocol.segment_frames
    suffix = f" {length}" if length and key.startswith(("w_mpjpe", "wa_mpjpe", "sw_")) else ""
    return Column(metric.label + suffix, metric.unit, metric.digits, metric.better)


def methods_table(result: Result, keys: Sequence[str], title: str, *, notes: tuple[str, ...] = ()) -> Table:
    """One row a method."""
    rows = tuple(
        (method.name, tuple(pooled(method.sequences.values(), key) for key in keys))
        for method in result.methods
    )
    return Table(title, tuple(column_of(key, result) for key in keys), rows, notes=notes)


def headline(result: Result) -> Table:
    """The main table of the protocol."""
    keys = result.protocol.headline
    title = f"{result.truth}, {result.split}: protocol {result.protocol.name}"
    return methods_table(result, keys, title, notes=(*_given(result), *_partial(result)))


def paper_tables(result: Result) -> list[Table]:
    """The paper's tables, of the columns that any method has a value for."""
    made: list[Table] = []
    for title, keys in PAPER.values():
        present = [key for key in keys if _has(result, key)]
        if present:
            notes: tuple[str, ...] = () if made else (*_given(result), *_partial(result))
            made.append(methods_table(result, present, title, notes=notes))
    return made


def group_tables(result: Result) -> list[Table]:
    """All metrics, one table for each group of the catalogue that has values."""
    made = []
    for group, title in GROUPS.items():
        keys = [key for key in metrics_of(group) if _has(result, key)]
        if keys:
            made.append(methods_table(result, keys, title))
    return made


def breakdown(result: Result, by: GroupBy, keys: Sequence[str] | None = None) -> Table | None:
    """One row a group and method; ``None`` where the data has no such groups."""
    chosen = [key for key in (keys or result.protocol.headline) if _has(result, key)]
    rows = [
        (f"{label} · {method.name}" if len(result.methods) > 1 else label, values)
        for label, selection in groups(result, by)
        for method in result.methods
        if np.isfinite(
            values := tuple(pooled(method.sequences.values(), key, selection) for key in chosen)
        ).any()
    ]
    if not rows:
        return None
    columns = tuple(column_of(key, result) for key in chosen)
    return Table(GROUP_TITLES[by], columns, tuple(rows), first=by, compare=False)


def differences(result: Result, keys: Sequence[str] | None = None) -> list[Table]:
    """Each later method minus the first, with paired bootstrap intervals."""
    first, *others = result.methods
    made = []
    for other in others:
        rows = []
        for key in keys or result.protocol.headline:
            found = paired_bootstrap(first, other, key)
            if found is not None:
                label = f"{METRICS[key].label}{' [' + METRICS[key].unit + ']' if METRICS[key].unit else ''}"
                rows.append(
                    (f"{label}{' *' if found.clear else ''}", (found.difference, found.low, found.high))
                )
        if rows:
            columns = tuple(Column(label, digits=2) for label in ("difference", "low", "high"))
            note = (
                f"{CONFIDENCE:.0%} percentile interval of {RESAMPLES} paired resamples of whole sequences; "
                "* 0 lies outside"
            )
            title = f"{other.name} minus {first.name}"
            made.append(Table(title, columns, tuple(rows), "metric", (note,), compare=False))
    return made


def coverage(result: Result) -> Table:
    """What was scored and what was not, one row a method."""
    labels = ("sequences", "of", "people", "of", "frames %", "NaN", "extra tracks", "short segments",
              "static people", "static cameras", "no camera")  # fmt: skip
    columns = tuple(Column(label, digits=1 if "%" in label else 0) for label in labels)
    rows = tuple((method.name, _covered(method, len(result.ids))) for method in result.methods)
    return Table("Coverage", columns, rows, compare=False)


def _covered(method: MethodResult, wanted: int) -> tuple[float, ...]:
    n = method.counts
    share = 100.0 * n["person_frames_scored"] / n["person_frames"] if n["person_frames"] else float("nan")
    return (
        len(method.sequences), wanted, n["people_matched"], n["people"], share, n["person_frames_nan"],
        n["tracks_extra"], n["segments_short"], n["people_static"], n["cameras_static"], n["cameras_missing"],
    )  # fmt: skip


def _has(result: Result, key: str) -> bool:
    return any(np.isfinite(pooled(method.sequences.values(), key)) for method in result.methods)


def _given(result: Result) -> tuple[str, ...]:
    """What truth each method was given: a number without it misleads."""
    return tuple(
        f"{method.name} was given true {method.ground_truth_used.replace(',', ', ')}"
        for method in result.methods
        if method.ground_truth_used
    )


def _partial(result: Result) -> tuple[str, ...]:
    """Who was scored on fewer sequences than there are: its numbers are of other data than the others'."""
    return tuple(
        f"{method.name}: {len(method.sequences)} of {len(result.ids)} sequences scored"
        for method in result.methods
        if len(method.sequences) < len(result.ids)
    )
