"""Synthetic video datasets of people and cameras in one metric world.

``whacamole.open(folder)`` reads a dataset; the command ``whacamole render`` makes one.
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from whacamole.dataset.reader import open_dataset as open  # noqa: A004

__all__ = ["__version__", "open"]

__version__ = "0.1.0"


def __getattr__(name: str) -> Any:
    """Import the reader when it is first asked for, so that ``whacamole --help`` does not pay for it."""
    if name == "open":
        from whacamole.dataset.reader import open_dataset

        return open_dataset
    raise AttributeError(f"module 'whacamole' has no attribute {name!r}")
