"""A result as one text, Markdown, LaTeX, CSV or JSON document."""

from typing import Any

import numpy as np

from whacamole.errors import EvaluationError
from whacamole.evaluation.catalogue import METRICS
from whacamole.evaluation.pooling import pooled, summary
from whacamole.evaluation.report.table import WRITERS, Table, as_dict
from whacamole.evaluation.report.tables import (
    GROUP_TITLES,
    breakdown,
    coverage,
    differences,
    group_tables,
    headline,
    paper_tables,
)
from whacamole.evaluation.result import Result


def tables_of(result: Result, detail: str = "headline") -> list[Table]:
    """The tables of a result.

    Args:
        detail: "headline": the protocol's table, differences and coverage; "paper": the paper's tables;
            "all": these, every metric, and breakdowns by sequence, camera move, source and visibility.
    """
    if detail == "paper":
        return [*paper_tables(result), coverage(result)]
    tables = [headline(result), *differences(result), coverage(result)]
    if detail == "all":
        tables += [*paper_tables(result), *group_tables(result)]
        tables += [table for by in GROUP_TITLES if (table := breakdown(result, by)) is not None]
    elif detail != "headline":
        raise EvaluationError(f"no tables {detail!r}, only headline, paper, all")
    return tables


def as_document(result: Result, style: str = "text", detail: str = "headline") -> str:
    """All tables in one of the :data:`~whacamole.evaluation.report.table.WRITERS`.

    Raises:
        EvaluationError: no such style or detail.
    """
    if style not in WRITERS:
        raise EvaluationError(f"no table style {style!r}, only {', '.join(WRITERS)}")
    return "\n\n".join(WRITERS[style](table) for table in tables_of(result, detail))


def as_json(result: Result) -> dict[str, Any]:
    """The result as plain values, ``None`` for no value: summary, sequences, failures, tables, protocol."""
    return {
        "version": result.version,
        "truth": result.truth,
        "split": result.split,
        "complete": result.complete,
        "protocol": result.protocol.as_dict(),
        "units": {key: metric.unit for key, metric in METRICS.items()},
        "methods": [
            {
                "name": method.name,
                "ground_truth_used": method.ground_truth_used,
                "metrics": dict(summary(result)[method.name]),
                "counts": method.counts,
                "failures": method.failures,
                "sequences": {
                    name: {
                        "metrics": {
                            key: value for key in METRICS if np.isfinite(value := pooled([score], key))
                        },
                        "counts": score.counts,
                        "matches": [
                            {"truth": a, "prediction": b, "distance": distance}
                            for a, b, distance in score.matches
                        ],
                        "notes": score.notes,
                    }
                    for name, score in method.sequences.items()
                },
            }
            for method in result.methods
        ],
        "tables": [as_dict(table) for table in tables_of(result, "all")],
    }
