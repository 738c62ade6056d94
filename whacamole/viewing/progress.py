"""The bar of what takes its time here: on a terminal alone, and gone when it is done."""

from rich.console import Console
from rich.progress import Progress

__all__ = ["passing_bar"]


def passing_bar(*, quiet: bool) -> Progress:
    """Return a bar on stderr that leaves nothing behind; none if ``quiet`` or in a pipe."""
    console = Console(stderr=True)
    return Progress(console=console, transient=True, disable=quiet or not console.is_terminal)
