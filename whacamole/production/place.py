"""The place where one sequence is made: locked, resumable, and moved into the dataset in one step."""

import fcntl
import json
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from render_jobs.errors import PostponedError
from whacamole.dataset.layout import DatasetLayout, SequenceLayout
from whacamole.errors import DatasetError

__all__ = ["attempts_so_far", "is_finished", "lock_of", "make_in_place", "note_attempt"]

ATTEMPTS = "attempts.jsonl"
"""In the work folder: a line for each attempt that failed."""

KEPT_LOGS = (ATTEMPTS, "worker.log", "job/render.log")


def make_in_place(root: Path, sequence_id: str, fill: Callable[[SequenceLayout, Path], None]) -> bool:
    """Make a sequence and move it into the dataset; do nothing where it is there already.

    Args:
        root: the dataset.
        fill: makes all files of the sequence in the folder it is given; its second argument is a folder for
            what it needs meanwhile, which holds what earlier attempts left there.

    Returns:
        whether it was made here.

    Raises:
        PostponedError: another process is making this very sequence.
    """
    layout = DatasetLayout(root)
    final, work = layout.sequence(sequence_id), layout.work_of(sequence_id)
    work.mkdir(parents=True, exist_ok=True)
    with lock_of(work, sequence_id):
        to_make = not final.summary.exists()
        if to_make:
            unfinished = SequenceLayout(work / "sequence")
            fill(unfinished, work)
            final.folder.parent.mkdir(exist_ok=True)
            unfinished.folder.rename(final.folder)
        _keep_logs(layout, sequence_id)
    shutil.rmtree(work, ignore_errors=True)
    return to_make


def is_finished(root: Path, sequence_id: str) -> bool:
    """Whether the sequence is in the dataset."""
    return DatasetLayout(root).sequence(sequence_id).summary.exists()


@contextmanager
def lock_of(work: Path, sequence_id: str) -> Iterator[None]:
    """Hold the sequence's lock, which the system lets go of when the process ends, however it ends.

    Raises:
        PostponedError: another process holds it.
        DatasetError: the file system has no locks.
    """
    with (work / "lock").open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise PostponedError(f"{sequence_id}: another process is making it") from None
        except OSError as error:
            raise DatasetError(
                f"{work}: its file system gives no locks ({error.strerror}); choose an --out on one that "
                "does (NFS 4, Lustre mounted with flock)"
            ) from error
        yield


def note_attempt(work: Path, facts: dict[str, Any]) -> None:
    """Add a failed attempt to the record of a sequence."""
    with (work / ATTEMPTS).open("a", encoding="utf-8") as stream:
        stream.write(json.dumps(facts) + "\n")


def attempts_so_far(work: Path) -> list[dict[str, Any]]:
    """Return the failed attempts at a sequence that is not finished, or at one whose logs were kept."""
    try:
        lines = (work / ATTEMPTS).read_text(encoding="utf-8").splitlines()
    except OSError:
        return []
    found = []
    for line in lines:
        try:
            found.append(json.loads(line))
        except json.JSONDecodeError:  # cut short by a full disk
            continue
    return found


def _keep_logs(layout: DatasetLayout, sequence_id: str) -> None:
    """Keep what tells why attempts failed, where some did."""
    work = layout.work_of(sequence_id)
    if not (work / ATTEMPTS).exists():
        return
    kept = layout.logs / sequence_id
    kept.mkdir(parents=True, exist_ok=True)
    for name in KEPT_LOGS:
        if (work / name).exists():
            (work / name).replace(kept / Path(name).name)
