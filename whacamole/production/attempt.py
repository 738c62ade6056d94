"""One attempt at one sequence: start its worker, watch it, tell how it ended.

This is what a farm hands to its executor, so it may run in a thread here or in a process on another machine.
"""

import contextlib
import errno
import os
import threading
import time
from typing import Any

from render_jobs.clusters import slots_here
from render_jobs.errors import PostponedError, WorkerError
from render_jobs.machine import lease_gpu, usable_cores, usable_memory_mb, visible_gpus
from render_jobs.watch import describe_end, watch_child
from whacamole.dataset import DatasetLayout
from whacamole.dataset.files import write_json
from whacamole.production.means import Limits
from whacamole.production.place import attempts_so_far, is_finished, lock_of, note_attempt
from whacamole.production.pulse import host_name
from whacamole.production.space import check_room
from whacamole.production.worklist import SequenceOrder, failure_note

__all__ = ["AttemptError", "attempt"]

DISK_FULL = (errno.ENOSPC, errno.EDQUOT)

MEMORY_SHARE = 0.9
"""Of what the machine gives; a process that holds more takes the machine down with it."""

GRACE_S = 60.0
"""The watcher of the worker waits longer than the worker waits for its renderer, which knows more to say."""


class AttemptError(Exception):
    """An attempt at a sequence failed; the message is one line.

    Attributes:
        again: whether another attempt may fare better.
    """

    def __init__(self, message: str, *, again: bool = True) -> None:
        super().__init__(message)
        self.again = again


def attempt(order: SequenceOrder, limits: Limits, stop: threading.Event | None = None) -> bool:
    """Make a sequence in a process of its own.

    Args:
        stop: ends the attempt when it is set.

    Returns:
        whether it was made here; False where it was there already.

    Raises:
        AttemptError: the sequence is not there.
        PostponedError: somebody else is making it, or the disk is full.
    """
    if is_finished(order.root, order.sequence_id):
        return False
    if not (order.root / "recipe.json").exists():
        raise AttemptError(
            f"{order.sequence_id}: {order.root} is not there on {host_name()}: every worker needs the "
            "folders of motions and dataset under the same paths"
        )
    work = DatasetLayout(order.root).work_of(order.sequence_id)
    began = time.time()
    try:
        check_room(order, limits.disk_patience_s)
        work.mkdir(parents=True, exist_ok=True)
        with lock_of(work, order.sequence_id):
            failure_note(order).unlink(missing_ok=True)
            write_json(work / "order.json", order.as_dict())
        _run_worker(order, limits, stop)
    except (OSError, AttemptError) as error:
        if is_finished(order.root, order.sequence_id):  # by another run, which took its work folder away
            return False
        if isinstance(error, OSError) and error.errno in DISK_FULL:
            raise _disk_full(order, limits) from error
        failure = error if isinstance(error, AttemptError) else AttemptError(f"{order.sequence_id}: {error}")
        with contextlib.suppress(OSError):
            number = len(attempts_so_far(work)) + 1
            facts = {"attempt": number, "host": host_name(), "began": began, "seconds": time.time() - began}
            note_attempt(work, {**facts, "error": str(failure)})
        if failure is error:
            raise  # never its own cause: Dask follows causes to their end
        raise failure from error
    return True


def _run_worker(order: SequenceOrder, limits: Limits, stop: threading.Event | None) -> None:
    work = DatasetLayout(order.root).work_of(order.sequence_id)
    log = work / "worker.log"
    failure: dict[str, Any] = {}

    def hear(event: dict[str, Any]) -> None:
        if event.get("event") == "failed":
            failure.update(event)

    memory = limits.memory_mb or MEMORY_SHARE * usable_memory_mb()
    options = {
        "--threads": limits.threads or max(1, usable_cores() // slots_here()),
        "--device": limits.device,
        "--silence": limits.silence_s,
        "--memory": memory,
        "--parent": os.getpid(),
        "--run": limits.run,
    }
    words = [str(word) for pair in options.items() for word in pair]
    gpus = () if limits.device == "cpu" else visible_gpus()
    try:
        with lease_gpu(gpus) as gpu:
            end = watch_child(
                [*limits.worker, str(work / "order.json"), *words],
                log,
                hear,
                timeout=limits.silence_s + min(GRACE_S, limits.silence_s),
                time_limit=limits.time_s,
                memory_limit_mb=memory,
                environment=None if gpu is None else gpu.environment,
                stop=stop,
            )
    except WorkerError as error:
        raise AttemptError(f"{order.sequence_id}: {error}") from error
    if end.status == 0:
        return
    if failure.get("disk_full"):
        raise _disk_full(order, limits)
    if failure.get("postponed"):
        raise PostponedError(str(failure["error"]))
    check_room(order, limits.disk_patience_s)  # what fails for want of room need not say so
    if failure:
        raise AttemptError(str(failure["error"]), again=bool(failure["again"]))
    raise AttemptError(f"{order.sequence_id}: {describe_end(end)}; see {log}{_last_line(order)}")


def _disk_full(order: SequenceOrder, limits: Limits) -> PostponedError:
    return PostponedError(f"{order.root}: the disk is full; make room", limits.disk_patience_s)


def _last_line(order: SequenceOrder) -> str:
    log = DatasetLayout(order.root).work_of(order.sequence_id) / "worker.log"
    lines = log.read_text(encoding="utf-8", errors="replace").strip().splitlines()
    return f" ({lines[-1].strip()})" if lines else ""
