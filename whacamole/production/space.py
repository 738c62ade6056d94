"""Whether the disk can hold it."""

import shutil

from render_jobs.errors import PostponedError
from whacamole.production.worklist import SequenceOrder

__all__ = ["check_room"]

MEGABYTE = 1024**2


def check_room(order: SequenceOrder, patience_s: float) -> None:
    """Make sure that one more sequence has room.

    Raises:
        PostponedError: it has not.
    """
    free = shutil.disk_usage(order.root).free
    needed = 64 * MEGABYTE
    if free < needed:
        raise PostponedError(
            f"{order.root}: {free / MEGABYTE:.0f} MB free, {needed / MEGABYTE:.0f} MB needed; make room",
            patience_s,
        )
