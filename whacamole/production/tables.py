"""Tables that keep ids whole: folded in a narrow terminal, on one line in a file or a pipe."""

import sys

from rich.console import Console
from rich.table import Column, Table

__all__ = ["table_console", "table_of"]

PIPED_WIDTH = 240
"""Columns of a table that is not shown in a terminal."""


def table_console() -> Console:
    """Return the console that tables are printed to."""
    return Console(width=None if sys.stdout.isatty() else PIPED_WIDTH)


def table_of(*names: str) -> Table:
    """Return a table of these columns, in which nothing is cut off."""
    return Table(*(Column(name, overflow="fold") for name in names))
