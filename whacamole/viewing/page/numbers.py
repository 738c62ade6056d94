"""The statistics of a dataset as HTML: tables of counts with bars."""

from collections.abc import Mapping
from html import escape

from whacamole.dataset.card import TITLES
from whacamole.dataset.statistics import Spread, Statistics

__all__ = ["numbers_html"]

MOST = 14
"""Rows of a table; the rest is summed up."""


def numbers_html(numbers: Statistics) -> str:
    """All tables."""
    counts: Mapping[str, Mapping[str, int]] = {
        "Shots": numbers.shots, "Stages": numbers.stages, "Splits (sequences)": numbers.splits,
        "Sources of the motions": numbers.sources, "Licences of the motions": numbers.licences,
        "Genders": numbers.genders, "Image sizes": numbers.sizes,
    }  # fmt: skip
    tables = [_table(title, list(rows.items())) for title, rows in counts.items() if rows]
    tables += [_table(TITLES[name], _bins(spread), cut=False) for name, spread in numbers.spreads.items()]
    joints = ", ".join(f"{share:.1%} {escape(name)}" for name, share in numbers.joints.items())
    shares = (
        f"<p>Of the instances {numbers.ground_contact:.1%} touch the ground and {numbers.person_contact:.1%} "
        f"another person. Of their joints: {joints or 'none'}. {numbers.motions:,} different motions; "
        f"{numbers.interactive:,} sequences of two people recorded together.</p>"
    )
    return f"{shares}<div class=tables>{''.join(tables)}</div>"


def _bins(spread: Spread) -> list[tuple[str, int]]:
    rows = []
    for number, count in enumerate(spread.counts):
        above = spread.edges[number + 1 : number + 2]
        low = f"{spread.edges[number]:g}"
        rows.append((f"{low} to {above[0]:g}" if above else f"{low} and more", count))
    return rows


def _table(title: str, rows: list[tuple[str, int]], *, cut: bool = True) -> str:
    shown = rows[:MOST] if cut else rows
    rest = sum(count for _, count in rows[len(shown) :])
    if rest:
        shown = [*shown, (f"{len(rows) - len(shown)} others", rest)]
    total = max((count for _, count in shown), default=0) or 1
    body = "".join(
        f"<tr><th>{escape(name)}</th><td>{count:,}</td>"
        f"<td><meter min=0 max={total} value={count}></meter></td></tr>"
        for name, count in shown
    )
    return f"<table><caption>{escape(title)}</caption>{body}</table>"
