"""Whether the disk can hold it: asked before a run begins, and again before each attempt."""

import shutil
from collections.abc import Sequence
from pathlib import Path

from render_jobs.budget import frame_bytes
from render_jobs.errors import PostponedError
from whacamole.errors import DatasetError
from whacamole.production.worklist import SequenceOrder

__all__ = ["check_disk", "check_room", "readable_bytes", "sequence_bytes", "work_bytes"]

LABEL_BYTES = 8000
"""Of a person in a frame: people.npz, contact.npz, camera.npz (benchmarks/disk.py, as all below)."""

SEQUENCE_BYTES = 400_000
"""Of what a sequence has once: preview, plan, summary."""

WORK_BYTES = 420_000
"""Of a person in a frame while the sequence is made: skin, clothes and hair, for the job and for Blender."""

WORK_ONCE = 40_000_000
"""Of a sequence while it is made: textures, the stage, the frames that are being encoded."""


def sequence_bytes(order: SequenceOrder) -> float:
    """Return what a finished sequence takes."""
    recipe = order.recipe
    frame = frame_bytes(recipe.passes, recipe.image_format, *recipe.size) + order.people * LABEL_BYTES
    return SEQUENCE_BYTES + order.frames * frame


def work_bytes(order: SequenceOrder) -> float:
    """Return what a sequence takes besides, while it is made."""
    return float(WORK_ONCE + order.frames * order.people * WORK_BYTES)


def check_disk(orders: Sequence[SequenceOrder], jobs: int, root: Path) -> None:
    """Make sure that the disk can hold what is still to be made.

    Args:
        orders: what is to be made.
        jobs: how many of them at the same time.
        root: the dataset, or where it will be.

    Raises:
        DatasetError: it cannot.
    """
    meanwhile = sum(sorted((work_bytes(order) for order in orders), reverse=True)[:jobs])
    needed = sum(sequence_bytes(order) for order in orders) + meanwhile
    place = next(folder for folder in (root, *root.parents) if folder.exists())
    free = shutil.disk_usage(place).free
    if needed > free:
        raise DatasetError(
            f"{root}: {len(orders)} sequences need about {readable_bytes(needed)} and the disk has "
            f"{readable_bytes(free)} left; choose another --out, a smaller --size, jpg, fewer --passes or a "
            "--limit (or --no-disk-check, where room will be made in time)"
        )


def check_room(order: SequenceOrder, patience_s: float) -> None:
    """Make sure that this one sequence has room.

    Raises:
        PostponedError: it has not.
    """
    free = shutil.disk_usage(order.root).free
    needed = sequence_bytes(order) + work_bytes(order)
    if free < needed:
        raise PostponedError(
            f"{order.root}: the disk is full: {readable_bytes(free)} left, a sequence needs "
            f"{readable_bytes(needed)}; make room",
            patience_s,
        )


def readable_bytes(count: float) -> str:
    """Return a number of bytes as 3.1 MB, 2.4 TB and so on (powers of ten, as disks are sold)."""
    for unit in ("kB", "MB", "GB"):
        count /= 1000
        if count < 1000:
            return f"{count:.1f} {unit}"
    return f"{count / 1000:.1f} TB"
