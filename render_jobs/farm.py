"""Many tasks over any ``concurrent.futures`` executor: threads that watch children, or a cluster's scheduler.

A task that fails is tried again, up to a limit, unless trying again cannot help; the others go on. No state
is kept here: what is done is known from what the tasks leave on disk, so that a farm can be stopped and
started again.
"""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, wait
from dataclasses import dataclass
from typing import Generic, TypeVar

from render_jobs.errors import EngineError, RenderJobError, WorkerError

Task = TypeVar("Task")
Result = TypeVar("Result")

DEFAULT_ATTEMPTS = 3


@dataclass(frozen=True)
class Outcome(Generic[Task, Result]):
    """How a task ended, or one attempt at it.

    Attributes:
        task: what was to be done.
        result: what it gave, None where it failed.
        error: what went wrong, None where nothing did.
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
) -> Iterator[Outcome[Task, Result]]:
    """Do all tasks and yield the outcome of every attempt as it ends.

    A failed task goes to the end of the queue, so that one that crashes every time holds up nothing. Leaving
    the iteration early (an interrupt, say) cancels what has not begun.

    Args:
        executor: where the work is done; it stays the caller's to shut down.
        work: does one task; must be picklable, like the tasks, if the executor is in other processes.
        tasks: read as they are needed, so there may be any number.
        in_flight: tasks handed to the executor at a time, at least as many as it has workers.
        attempts: how often a task is tried.
        retry: whether an error leaves hope for another attempt.

    Raises:
        ValueError: ``in_flight`` or ``attempts`` is not positive.
    """
    if in_flight < 1 or attempts < 1:
        raise ValueError(f"in_flight {in_flight} and attempts {attempts} must be positive")
    fresh = iter(tasks)
    again: deque[_Attempt[Task]] = deque()
    running: dict[Future[Result], _Attempt[Task]] = {}
    try:
        while True:
            while len(running) < in_flight and (attempt := _next(fresh, again)) is not None:
                running[executor.submit(work, attempt.task)] = attempt
            if not running:
                return
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                outcome = _judge(future, running.pop(future), attempts, retry)
                if not outcome.final:
                    again.append(_Attempt(outcome.task, outcome.attempts + 1, time.monotonic()))
                yield outcome
    finally:
        for future in running:
            future.cancel()


@dataclass(frozen=True)
class _Attempt(Generic[Task]):
    task: Task
    number: int
    began: float


def _next(fresh: Iterator[Task], again: deque[_Attempt[Task]]) -> _Attempt[Task] | None:
    """The next thing to try: new tasks first."""
    for task in fresh:
        return _Attempt(task, 1, time.monotonic())
    return again.popleft() if again else None


def _judge(
    future: Future[Result], attempt: _Attempt[Task], attempts: int, retry: Callable[[BaseException], bool]
) -> Outcome[Task, Result]:
    seconds = time.monotonic() - attempt.began
    try:
        return Outcome(attempt.task, future.result(), None, attempt.number, final=True, seconds=seconds)
    except (Exception, CancelledError) as error:
        final = attempt.number >= attempts or not retry(error)
        return Outcome(attempt.task, None, error, attempt.number, final=final, seconds=seconds)
