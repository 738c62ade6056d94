"""A table, and the five ways of writing it."""

import csv
import io
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Column:
    """A column of numbers.

    Attributes:
        label: heading.
        unit: "" for a plain ratio.
        digits: decimals.
        better: "lower", "higher", "one" or "none": which of the values is set off as the best.
    """

    label: str
    unit: str = ""
    digits: int = 1
    better: str = "none"

    @property
    def heading(self) -> str:
        """Label with its unit and the way that is better."""
        unit = f" [{self.unit}]" if self.unit else ""
        return f"{self.label}{unit}{f' {self._arrow}' if self._arrow else ''}"

    @property
    def hint(self) -> str:
        """Unit and the way that is better."""
        return f"{self.unit} {self._arrow}".strip()

    @property
    def _arrow(self) -> str:
        return {"lower": "↓", "higher": "↑", "one": "→ 1"}.get(self.better, "")

    def show(self, value: float) -> str:
        """A value as text, "–" for none."""
        return f"{round(value, self.digits) + 0.0:.{self.digits}f}" if np.isfinite(value) else "–"


@dataclass(frozen=True)
class Table:
    """Rows of numbers with a name each.

    Attributes:
        title: one line.
        columns: of the numbers.
        rows: (name, one value a column); NaN for none.
        first: heading of the names.
        notes: lines below the table.
        compare: whether rows compete, so that the best of a column is set off.
    """

    title: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[str, tuple[float, ...]], ...]
    first: str = "method"
    notes: tuple[str, ...] = ()
    compare: bool = True

    def best(self) -> set[tuple[int, int]]:
        """(row, column) of the best values, as printed; none in a column whose values do not differ."""
        found = set()
        for c, column in enumerate(self.columns):
            values = np.array([row[1][c] for row in self.rows], dtype=float)
            if not self.compare or column.better == "none" or np.isfinite(values).sum() < 2:
                continue
            distance = {"lower": values, "higher": -values, "one": np.abs(values - 1.0)}[column.better]
            least = np.round(distance, column.digits)
            if np.nanmin(least) == np.nanmax(least):
                continue
            found |= {(int(r), c) for r in np.flatnonzero(least == np.nanmin(least))}
        return found

    def cells(self) -> list[list[str]]:
        """All rows as text, names first."""
        return [
            [name, *(column.show(value) for column, value in zip(self.columns, values, strict=True))]
            for name, values in self.rows
        ]


def as_text(table: Table) -> str:
    """For a terminal: columns in line, the best marked with ``*``."""
    best = table.best()
    rows = [[table.first, *(column.heading for column in table.columns)], *table.cells()]
    for r, c in best:
        rows[r + 1][c + 1] += "*"
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = [
        "  ".join(
            [row[0].ljust(widths[0]), *(cell.rjust(w) for cell, w in zip(row[1:], widths[1:], strict=True))]
        )
        for row in rows
    ]
    rule = "-" * max(len(line) for line in lines)
    return "\n".join(
        [table.title, lines[0].rstrip(), rule, *(line.rstrip() for line in lines[1:]), *table.notes]
    )


def as_markdown(table: Table) -> str:
    """A pipe table, the best in bold."""
    best = table.best()
    rows = table.cells()
    for r, c in best:
        rows[r][c + 1] = f"**{rows[r][c + 1]}**"
    head = [table.first, *(column.heading for column in table.columns)]
    rule = ["---", *(["---:"] * len(table.columns))]
    lines = [
        "| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in (head, rule, *rows)
    ]
    notes = [line for note in table.notes for line in ("", note)]
    return "\n".join([f"**{table.title}**", "", *lines, *notes])


_LATEX = {"&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#", "_": r"\_", "{": r"\{", "}": r"\}",
          "~": r"\textasciitilde{}", "^": r"\textasciicircum{}", "\\": r"\textbackslash{}", "°": r"$^\circ$",
          "²": "$^2$", "³": "$^3$", "↓": r"$\downarrow$", "↑": r"$\uparrow$", "→": r"$\to$", "–": "--",
          "≥": r"$\ge$", "…": r"\dots{}", "·": r"$\cdot$"}  # fmt: skip


def _latex(text: str) -> str:
    return "".join(_LATEX.get(character, character) for character in text)


def as_latex(table: Table) -> str:
    """A booktabs table, the best in bold."""
    best = table.best()
    rows = [[_latex(cell) for cell in row] for row in table.cells()]
    for r, c in best:
        rows[r][c + 1] = rf"\textbf{{{rows[r][c + 1]}}}"
    head = [_latex(table.first), *(_latex(column.heading) for column in table.columns)]
    lines = [" & ".join(row) + r" \\" for row in (head, *rows)]
    return "\n".join(
        [
            rf"\begin{{tabular}}{{l{'r' * len(table.columns)}}}",
            r"\toprule",
            lines[0],
            r"\midrule",
            *lines[1:],
            r"\bottomrule",
            r"\end{tabular}",
            *(f"% {note}" for note in (table.title, *table.notes)),
        ]
    )


def as_csv(table: Table) -> str:
    """Comma separated, full precision, empty for no value."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    units = [f"{c.label} [{c.unit}]" if c.unit else c.label for c in table.columns]
    writer.writerow([table.first, *units])
    for name, values in table.rows:
        writer.writerow([name, *("" if not np.isfinite(v) else repr(float(v)) for v in values)])
    return stream.getvalue().rstrip("\n")


def as_dict(table: Table) -> dict[str, Any]:
    """Plain values for JSON, ``None`` for no value."""
    return {
        "title": table.title,
        "columns": [{"label": c.label, "unit": c.unit, "better": c.better} for c in table.columns],
        "rows": [
            {"name": name, "values": [float(v) if np.isfinite(v) else None for v in values]}
            for name, values in table.rows
        ],
        "notes": list(table.notes),
    }


WRITERS: Mapping[str, Callable[[Table], str]] = MappingProxyType(
    {"text": as_text, "markdown": as_markdown, "latex": as_latex, "csv": as_csv}
)
"""Ways of writing a table by name."""
