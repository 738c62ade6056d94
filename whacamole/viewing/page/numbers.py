"""The statistics of a dataset as HTML: tables of counts and shares with bars."""

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
    tables += [_spread(TITLES[name], spread) for name, spread in numbers.spreads.items() if spread.rows()]
    joints = ", ".join(f"{share:.1%} {escape(name)}" for name, share in numbers.joints.items())
    shares = (
        f"<p>Of the instances {numbers.ground_contact:.1%} touch the ground and {numbers.person_contact:.1%} "
        f"another person. Of their joints: {joints or 'none'}. {numbers.motions:,} different motions; "
        f"{numbers.interactive:,} sequences of two people recorded together.</p>"
    )
    return f"{shares}<div class=tables>{''.join(tables)}</div>"


def _spread(title: str, spread: Spread) -> str:
    """How a number is spread over the instances, in percent of them."""
    rows = spread.rows()
    total = sum(count for _, count in rows)
    told = f"least {spread.low:.3g}, mean {spread.mean:.3g}, greatest {spread.high:.3g}"
    return _framed(title, [(name, f"{count / total:.1%}", count) for name, count in rows], told)


def _table(title: str, rows: list[tuple[str, int]]) -> str:
    shown = rows[:MOST]
    rest = sum(count for _, count in rows[len(shown) :])
    if rest:
        shown = [*shown, (f"{len(rows) - len(shown)} others", rest)]
    return _framed(title, [(name, f"{count:,}", count) for name, count in shown])


def _framed(title: str, rows: list[tuple[str, str, int]], told: str = "") -> str:
    """A table of names, numbers in words and bars as long as the numbers."""
    most = max((count for _, _, count in rows), default=0) or 1
    body = "".join(
        f"<tr><th>{escape(name)}</th><td>{text}</td>"
        f'<td><svg class=bar><rect width="{100 * count / most:.1f}%" height="100%"/></svg></td></tr>'
        for name, text, count in rows
    )
    last = f"<tr><td class=told colspan=3>{escape(told)}</td></tr>" if told else ""
    return f"<table><caption>{escape(title)}</caption>{body}{last}</table>"
