"""The farm: every task ends once, whatever happens on the way."""

from __future__ import annotations

import pickle
import threading
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from render_jobs import EngineError, RenderJobError, WorkerError
from render_jobs.errors import PostponedError
from render_jobs.farm import Outcome, run_farm

LOG = Path("render.log")


@settings(max_examples=50, derandomize=True, deadline=None)
@given(
    crashes=st.lists(st.integers(0, 4), max_size=12),
    attempts=st.integers(1, 4),
    workers=st.integers(1, 4),
    spare=st.integers(0, 3),
)
def test_every_task_ends_once_after_as_many_attempts_as_it_needs(
    crashes: list[int], attempts: int, workers: int, spare: int
) -> None:
    tried: Counter[int] = Counter()
    lock = threading.Lock()

    def work(task: int) -> int:
        with lock:
            tried[task] += 1
            if tried[task] <= crashes[task]:
                raise WorkerError("it crashed", LOG)
        return task * task

    with ThreadPoolExecutor(workers) as pool:
        outcomes = list(
            run_farm(pool, work, range(len(crashes)), in_flight=workers + spare, attempts=attempts)
        )
    final = {outcome.task: outcome for outcome in outcomes if outcome.final}
    assert sorted(final) == list(range(len(crashes)))
    assert len(outcomes) == sum(tried.values()) == sum(min(count + 1, attempts) for count in crashes)
    for task, count in enumerate(crashes):
        done = count < attempts
        assert final[task].result == (task * task if done else None)
        assert (final[task].error is None) == done
        assert final[task].attempts == min(count + 1, attempts)


@pytest.mark.parametrize(
    ("error", "tries"),
    [
        (WorkerError("killed", LOG), 3),
        (OSError("No space left on device"), 3),
        (RenderJobError("the mesh is broken"), 1),
        (EngineError("no driver"), 1),
    ],
)
def test_what_cannot_be_mended_by_trying_is_not_tried_again(error: Exception, tries: int) -> None:
    def work(_: str) -> None:
        raise error

    with ThreadPoolExecutor(1) as pool:
        outcomes = list(run_farm(pool, work, ["only"], in_flight=1))
    assert [outcome.attempts for outcome in outcomes] == list(range(1, tries + 1))
    assert [outcome.final for outcome in outcomes] == [False] * (tries - 1) + [True]
    assert outcomes[-1].error is error


def test_a_task_that_always_crashes_holds_up_nothing() -> None:
    def work(task: str) -> str:
        if task == "bad":
            raise WorkerError("it crashed", LOG)
        return task

    with ThreadPoolExecutor(1) as pool:
        order = [outcome.task for outcome in run_farm(pool, work, ["bad", "a", "b", "c"], in_flight=1)]
    assert order == ["bad", "a", "b", "c", "bad", "bad"]


def test_what_cannot_be_done_now_costs_no_attempt_and_holds_up_nothing() -> None:
    asked: Counter[str] = Counter()

    def work(task: str) -> str:
        asked[task] += 1
        if task == "taken" and asked[task] <= 5:
            raise PostponedError("somebody else makes it")
        return task

    with ThreadPoolExecutor(1) as pool:
        outcomes = list(run_farm(pool, work, ["taken", "a", "b"], in_flight=1, attempts=2, pause=0.01))
    assert [outcome.task for outcome in outcomes if outcome.error is None] == ["a", "b", "taken"]
    assert outcomes[-1].attempts == 1
    assert asked["taken"] == 6


def test_patience_ends() -> None:
    def work(_: str) -> None:
        raise PostponedError("the disk is full", patience=0.2)

    with ThreadPoolExecutor(1) as pool:
        *before, last = run_farm(pool, work, ["only"], in_flight=1, pause=0.05)
    assert len(before) >= 2
    assert not any(outcome.final for outcome in before)
    assert last.final
    assert str(last.error) == "the disk is full"


def test_errors_travel_between_machines() -> None:
    for error in (WorkerError("it crashed", LOG), PostponedError("full", 3.0), EngineError("no driver")):
        back = pickle.loads(pickle.dumps(error))  # noqa: TID251
        assert type(back) is type(error)
        assert str(back) == str(error)
        assert vars(back) == vars(error)


def test_tasks_are_read_as_they_are_needed_and_stopping_stops() -> None:
    read: list[int] = []

    def endless() -> Iterator[int]:
        number = 0
        while True:
            read.append(number)
            yield number
            number += 1

    with ThreadPoolExecutor(2) as pool:
        farm = run_farm(pool, lambda task: task, endless(), in_flight=4)
        first: Outcome[int, int] = next(farm)
        farm.close()
    assert first.final
    assert len(read) <= 4 + 4


def test_limits_must_make_sense() -> None:
    with ThreadPoolExecutor(1) as pool, pytest.raises(ValueError, match="must be positive"):
        list(run_farm(pool, str, [1], in_flight=0))
