"""The whole result as one HTML file that needs nothing else: tables, plots, choices, what was left out."""

from html import escape

from whacamole.evaluation.pooling import pooled
from whacamole.evaluation.report.plots import sequence_plots
from whacamole.evaluation.report.table import Table
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

MAX_PLOTTED = 24
"""Sequences with plots in the report: the worst first, so that the file stays small."""

MAX_OPEN = 30
"""Rows of a breakdown that is open from the start."""

_STYLE = """
body{font:15px/1.5 system-ui,sans-serif;max-width:1280px;margin:2rem auto;padding:0 1rem;color:#222}
table{border-collapse:collapse;margin:.4rem 0 1.2rem;font-variant-numeric:tabular-nums}
th,td{padding:.2rem .7rem;text-align:right;border-bottom:1px solid #ddd}
th:first-child,td:first-child{text-align:left}
th{border-bottom:2px solid #222;font-weight:600;white-space:nowrap;vertical-align:bottom}
th small{display:block;font-weight:400;color:#555}
td:first-child{white-space:nowrap}
td.best{font-weight:700}
td.words{text-align:left}
.scroll{overflow-x:auto}
.plots{display:flex;flex-wrap:wrap;gap:.5rem}
.note{color:#555;font-size:13px;margin:.1rem 0}
.bad{color:#a02020}
details{margin:.8rem 0}
summary{cursor:pointer;font-weight:600}
"""


def as_html(result: Result) -> str:
    """Write the report.

    Sequences are plotted from the worst to the best of the protocol's first metric, at most
    :data:`MAX_PLOTTED`.
    """
    title = f"{result.truth}, {result.split}: {', '.join(m.name for m in result.methods)}"
    parts = [
        f"<!doctype html><html lang=en><meta charset=utf-8><title>{escape(title)}</title>",
        "<meta name=viewport content='width=device-width'>",
        f"<style>{_STYLE}</style><h1>{escape(title)}</h1>",
        f"<p class=note>protocol {escape(result.protocol.name)} · whacamole {escape(result.version)}</p>",
        _table(headline(result)),
        _failures(result),
        _table(coverage(result)),
        *(_table(table) for table in differences(result)),
        "<h2>The paper's tables</h2>",
        *(_table(table) for table in paper_tables(result)),
        "<h2>All metrics</h2>",
        *(_table(table) for table in group_tables(result)),
        "<h2>Where</h2>",
        *(_folded(table) for by in GROUP_TITLES if (table := breakdown(result, by)) is not None),
        "<h2>Sequences</h2>",
        "<p class=note>Black: truth. Solid: people, dashed: the camera, dot: the first frame. Each path is "
        "aligned as its ATE is.</p>",
        *_plots(result),
        _notes(result),
        _choices(result),
        "</html>",
    ]
    return "\n".join(part for part in parts if part)


def _folded(table: Table) -> str:
    """A table that is closed at first if it is long."""
    opened = " open" if len(table.rows) <= MAX_OPEN else ""
    return f"<details{opened}><summary>{escape(table.title)}</summary>{_table(table, titled=False)}</details>"


def _table(table: Table, *, titled: bool = True) -> str:
    best = table.best()
    head = "".join(f"<th>{escape(c.label)}<small>{escape(c.hint)}</small></th>" for c in table.columns)
    rows = []
    for r, cells in enumerate(table.cells()):
        marked = "".join(
            f"<td{' class=best' if (r, c) in best else ''}>{escape(cell)}</td>"
            for c, cell in enumerate(cells[1:])
        )
        rows.append(f"<tr><td>{escape(cells[0])}</td>{marked}</tr>")
    notes = "".join(f"<p class=note>{escape(note)}</p>" for note in table.notes)
    title = f"<h3>{escape(table.title)}</h3>" if titled else ""
    return (
        f"{title}<div class=scroll><table><thead><tr><th>{escape(table.first)}</th>{head}</tr></thead>"
        f"<tbody>{''.join(rows)}</tbody></table></div>{notes}"
    )


def _failures(result: Result) -> str:
    lines = [
        f"<li class=bad>{escape(method.name)} · {escape(sequence_id)}: {escape(reason)}</li>"
        for method in result.methods
        for sequence_id, reason in method.failures.items()
    ]
    return f"<h3>Not scored</h3><ul>{''.join(lines)}</ul>" if lines else ""


def _plots(result: Result) -> list[str]:
    key = result.protocol.headline[0]

    def badness(sequence_id: str) -> float:
        found = [m.sequences[sequence_id] for m in result.methods if sequence_id in m.sequences]
        value = pooled(found, key)
        return value if value == value else -1.0  # NaN differs from itself

    order = sorted(result.ids, key=badness, reverse=True)
    parts = []
    for number, sequence_id in enumerate(order[:MAX_PLOTTED]):
        plots = sequence_plots(result, sequence_id)
        if plots:
            opened = " open" if number < 3 else ""
            parts.append(
                f"<details{opened}><summary>{escape(sequence_id)}</summary>"
                f"<div class=plots>{''.join(plots.values())}</div></details>"
            )
    if len(order) > MAX_PLOTTED:
        parts.append(f"<p class=note>The {MAX_PLOTTED} worst of {len(order)} sequences are plotted.</p>")
    return parts


def _notes(result: Result) -> str:
    lines = {
        f"{method.name}: {note}"
        for method in result.methods
        for s in method.sequences.values()
        for note in s.notes
    }
    return (
        "<h2>Notes</h2>" + "".join(f"<p class=note>{escape(line)}</p>" for line in sorted(lines))
        if lines
        else ""
    )


def _choices(result: Result) -> str:
    rows = "".join(
        f"<tr><td>{escape(name)}</td><td>{escape(value)}</td><td class=words>{escape(about)}</td></tr>"
        for name, value, about in result.protocol.choices()
    )
    return f"<h2>Protocol {escape(result.protocol.name)}</h2><div class=scroll><table>{rows}</table></div>"
