"""Many tasks over any ``concurrent.futures`` executor: threads that watch children, or a cluster's scheduler.

A task that fails is tried again, up to a limit, unless trying again cannot help; the others go on. No state
is kept here: what is done is known from what the tasks leave on disk, so that a farm can be stopped and
started again.
"""

from __future__ import annotations

import queue
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError, Executor, Future
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

from render_jobs.errors import EngineError, PostponedError, RenderJobError, WorkerError

Task = TypeVar("Task")
Result = TypeVar("Result")

DEFAULT_ATTEMPTS = 3
DEFAULT_PAUSE_S = 5.0


@dataclass(frozen=True)
class Outcome(Generic[Task, Result]):
    """How a task ended, or one attempt at it.

    Attributes:
        task: what was to be done.
        result: what it gave, None where it failed.
        error: what went wrong, None where nothing did; :class:`PostponedError` where it waits.
        attempts: how often it has been tried.
        final: whether it will not be tried again.
        seconds: wall time of this attempt, waiting for a worker included.
    """

    task: Task
    result: Result | None
    error: BaseException | None
    attempts: int
    final: bool
    seconds: float


def may_help(error: BaseException) -> bool:
    """Whether another attempt may fare better: not where the job or the machine is at fault."""
    return isinstance(error, WorkerError) or not isinstance(error, (RenderJobError, EngineError))


def run_farm(
    executor: Executor,
    work: Callable[[Task], Result],
    tasks: Iterable[Task],
    *,
    in_flight: int,
    attempts: int = DEFAULT_ATTEMPTS,
    retry: Callable[[BaseException], bool] = may_help,
    pause: float = DEFAULT_PAUSE_S,
) -> Iterator[Outcome[Task, Result]]:
    """Do all tasks and yield the outcome of every attempt as it ends.

    A failed task goes to the end of the queue, so that one that crashes every time holds up nothing. One that
    raises :class:`PostponedError` is asked for again every ``pause`` seconds, for as long as the error has
    patience. Leaving the iteration early (an interrupt, say) cancels what has not begun.

    Args:
        executor: where the work is done; it stays the caller's to shut down.
        work: does one task; must be picklable, like the tasks, if the executor is in other processes.
        tasks: read as they are needed, so there may be any number.
        in_flight: tasks handed to the executor at a time, at least as many as it has workers.
        attempts: how often a task is tried.
        retry: whether an error leaves hope for another attempt.
        pause: seconds before a task that could not be done is asked for again.

    Raises:
        ValueError: ``in_flight`` or ``attempts`` is not positive.
    """
    if in_flight < 1 or attempts < 1:
        raise ValueError(f"in_flight {in_flight} and attempts {attempts} must be positive")
    waiting = _Waiting(iter(tasks))
    running: dict[Future[Result], _Attempt[Task]] = {}
    ended: queue.SimpleQueue[Future[Result]] = queue.SimpleQueue()
    try:
        while True:
            while len(running) < in_flight and (attempt := waiting.next()) is not None:
                future = executor.submit(work, attempt.task)
                running[future] = replace(attempt, began=time.monotonic())
                future.add_done_callback(ended.put)
            if not running and waiting.empty:
                return
            try:
                future = ended.get(timeout=waiting.until_next if len(running) < in_flight else None)
            except queue.Empty:
                continue  # it is time to ask again for what had to wait
            attempt = running.pop(future)
            outcome, again = _judge(future, attempt, attempts, retry, pause)
            if again is not None:
                waiting.put(again)
            yield outcome
    finally:
        for future in running:
            future.cancel()


@dataclass(frozen=True)
class _Attempt(Generic[Task]):
    """A try at a task.

    Attributes:
        number: from 1.
        began: when it was handed to the executor.
        not_before: when it may be.
        waits_since: since when it has been :class:`PostponedError`, None where it is not.
    """

    task: Task
    number: int = 1
    began: float = 0.0
    not_before: float = 0.0
    waits_since: float | None = None


class _Waiting(Generic[Task]):
    """What is still to be tried: new tasks first, then failed ones, and others when their time comes."""

    def __init__(self, fresh: Iterator[Task]) -> None:
        self._fresh: Iterator[Task] | None = fresh
        self._again: deque[_Attempt[Task]] = deque()
        self._later: deque[_Attempt[Task]] = deque()  # by the time they may be tried, as the pause is one

    def next(self) -> _Attempt[Task] | None:
        if self._fresh is not None:
            for task in self._fresh:
                return _Attempt(task)
            self._fresh = None
        if self._again:
            return self._again.popleft()
        if self._later and self._later[0].not_before <= time.monotonic():
            return self._later.popleft()
        return None

    def put(self, attempt: _Attempt[Task]) -> None:
        (self._later if attempt.not_before else self._again).append(attempt)

    @property
    def empty(self) -> bool:
        return self._fresh is None and not self._again and not self._later

    @property
    def until_next(self) -> float | None:
        """Seconds until something may be tried; None where nothing waits."""
        return max(0.0, self._later[0].not_before - time.monotonic()) if self._later else None


def _judge(
    future: Future[Result],
    attempt: _Attempt[Task],
    attempts: int,
    retry: Callable[[BaseException], bool],
    pause: float,
) -> tuple[Outcome[Task, Result], _Attempt[Task] | None]:
    """The outcome of an attempt, and the next attempt where there is to be one."""
    now = time.monotonic()
    seconds = now - attempt.began
    again: _Attempt[Task] | None = None
    try:
        result = future.result()
        return Outcome(attempt.task, result, None, attempt.number, final=True, seconds=seconds), None
    except PostponedError as error:
        caught: BaseException = error
        since = attempt.began if attempt.waits_since is None else attempt.waits_since
        if error.patience is None or now - since < error.patience:
            again = replace(attempt, not_before=now + pause, waits_since=since)
    except (Exception, CancelledError) as error:
        caught = error
        if attempt.number < attempts and retry(error):
            again = _Attempt(attempt.task, attempt.number + 1)
    return Outcome(attempt.task, None, caught, attempt.number, final=again is None, seconds=seconds), again
