"""What runs of one dataset agree on through its folder: parts, places, locks, room, signs of life."""

import fcntl
import json
import os
import shutil
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import pytest

from render_jobs.errors import PostponedError
from whacamole.dataset import DatasetLayout, SequenceLayout
from whacamole.dataset.files import write_json
from whacamole.errors import DatasetError, RecipeError
from whacamole.production.attempt import AttemptError, attempt
from whacamole.production.means import Limits, Shard
from whacamole.production.opening import open_dataset_for
from whacamole.production.place import attempts_so_far, make_in_place, note_attempt
from whacamole.production.pulse import Heart, RunRecord, live_runs
from whacamole.production.space import check_disk, check_room, readable_bytes, sequence_bytes, work_bytes
from whacamole.production.status import status_of
from whacamole.production.worklist import SequenceOrder, Worklist, work_of
from whacamole.recipe import Recipe

RECIPE = Recipe(engine="raster", frames=100, limit=7, people=(1, 3))


@pytest.fixture(scope="module")
def worklist(tmp_path_factory: pytest.TempPathFactory) -> Worklist:
    return work_of(RECIPE, tmp_path_factory.mktemp("work") / "data")


@pytest.mark.parametrize("count", [1, 2, 3, 7, 9])
def test_the_parts_are_the_whole_and_share_nothing(worklist: Worklist, count: int) -> None:
    parts = [worklist.part(index, count).orders for index in range(1, count + 1)]
    assert sorted(order.sequence_id for part in parts for order in part) == sorted(
        order.sequence_id for order in worklist.orders
    )
    assert max(map(len, parts)) - min(map(len, parts)) <= 1
    finished = replace(worklist, finished=frozenset(order.sequence_id for order in worklist.orders[:4]))
    assert [finished.part(index, count).orders for index in range(1, count + 1)] == parts


@pytest.mark.parametrize("text", ["0/4", "5/4", "2", "a/b", "1/0", "-1/4", ""])
def test_a_part_that_is_none_is_refused_in_one_line(text: str) -> None:
    with pytest.raises(RecipeError, match="shard") as caught:
        Shard.parse(text)
    assert "\n" not in str(caught.value)


def test_an_order_survives_the_way_to_its_worker(worklist: Worklist) -> None:
    order = worklist.orders[0]
    back = SequenceOrder.from_dict(json.loads(json.dumps(order.as_dict())))
    assert back == order
    assert (back.frames, back.people) == (order.frames, order.people)


def _fill(sequence: SequenceLayout, work: Path) -> None:
    sequence.folder.mkdir()
    write_json(sequence.summary, {"motion_id": "m"})


def test_a_sequence_appears_once_and_leaves_no_work(tmp_path: Path) -> None:
    layout = DatasetLayout(tmp_path)
    assert make_in_place(tmp_path, "a-00", _fill)
    assert not make_in_place(tmp_path, "a-00", lambda *_: pytest.fail("made twice"))
    assert layout.finished() == ["a-00"]
    assert not any(layout.work.iterdir())


def test_only_one_makes_a_sequence_and_the_other_is_put_off(tmp_path: Path) -> None:
    work = DatasetLayout(tmp_path).work_of("a-00")
    work.mkdir(parents=True)
    with (work / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        with pytest.raises(PostponedError, match="another process"):
            make_in_place(tmp_path, "a-00", _fill)
    assert make_in_place(tmp_path, "a-00", _fill)


def test_logs_stay_where_attempts_failed(tmp_path: Path) -> None:
    layout = DatasetLayout(tmp_path)
    work = layout.work_of("a-00")
    (work / "job").mkdir(parents=True)
    (work / "worker.log").write_text("last words")
    (work / "job" / "render.log").write_text("of the renderer")
    note_attempt(work, {"attempt": 1, "error": "it crashed"})
    make_in_place(tmp_path, "a-00", _fill)
    kept = layout.logs / "a-00"
    assert [attempt["error"] for attempt in attempts_so_far(kept)] == ["it crashed"]
    assert (kept / "worker.log").read_text() == "last words"
    assert (kept / "render.log").read_text() == "of the renderer"
    assert not work.exists()


def test_the_first_of_several_runs_begins_the_dataset(tmp_path: Path) -> None:
    layout = DatasetLayout(tmp_path / "data")
    assert open_dataset_for(RECIPE, layout, engine_is_ours=True) == RECIPE
    other = RECIPE.model_copy(update={"engine": "cycles"})
    assert open_dataset_for(other, layout, engine_is_ours=True).engine == "raster"
    with pytest.raises(DatasetError, match="engine raster is now cycles"):
        open_dataset_for(other, layout, engine_is_ours=False)
    longer = RECIPE.model_copy(update={"limit": 9})
    assert open_dataset_for(longer, layout, engine_is_ours=False) == longer
    assert sorted(path.name for path in layout.root.iterdir()) == [".work", "recipe.json", "sequences"]


def test_a_folder_of_other_files_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").touch()
    with pytest.raises(DatasetError, match="holds other files"):
        open_dataset_for(RECIPE, DatasetLayout(tmp_path), engine_is_ours=False)
    assert [path.name for path in tmp_path.iterdir()] == ["thesis.tex"]


class _Disk(NamedTuple):
    total: int
    used: int
    free: int


def test_a_run_that_cannot_fit_is_refused(
    worklist: Worklist, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    orders = worklist.orders
    kept = sum(sequence_bytes(order) for order in orders)
    largest = max(work_bytes(order) for order in orders)
    for free, fits in ((kept + largest + 1, True), (kept + largest - 1, False)):
        disk = _Disk(10**12, 0, int(free))
        monkeypatch.setattr(shutil, "disk_usage", lambda _, disk=disk: disk)
        if fits:
            check_disk(orders, 1, tmp_path / "not" / "there")
            continue
        with pytest.raises(DatasetError, match="7 sequences need about") as caught:
            check_disk(orders, 1, tmp_path / "not" / "there")
        assert "--no-disk-check" in str(caught.value)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: _Disk(10**12, 0, 10**6))
    with pytest.raises(PostponedError, match=r"1\.0 MB left") as put_off:
        check_room(orders[0], 30.0)
    assert put_off.value.patience == 30.0


def test_what_is_asked_for_decides_what_is_needed(worklist: Worklist) -> None:
    order = worklist.orders[0]

    def needs(**changes: object) -> float:
        return sequence_bytes(replace(order, recipe=order.recipe.model_copy(update=changes)))

    assert needs(size=(1280, 720)) > 3.5 * needs(size=(640, 360))
    assert needs(image_format="png") > needs(image_format="jpg") > needs(image_format="mp4")
    assert needs(passes=("rgb", "mask", "depth", "normal", "flow")) > 2 * needs()
    assert readable_bytes(2.44e12) == "2.4 TB"


def test_status_tells_who_is_at_what_and_who_has_died(tmp_path: Path) -> None:
    layout = DatasetLayout(tmp_path / "data")
    open_dataset_for(RECIPE, layout, engine_is_ours=False)
    first, second, third = (order.sequence_id for order in work_of(RECIPE, layout.root).orders[:3])
    now = time.time()
    RunRecord("here-1", "4 jobs", now - 60, now, made=3, frames_s=2.5, left_s=90.0, failed_attempts=1).write(
        layout
    )
    RunRecord("there-2", "part 2/2", now - 60, now, frames_s=1.5, left_s=30.0).write(layout)
    RunRecord("dead-3", "1 job", now - 999, now - 600, frames_s=9.0).write(layout)
    for name, run in ((first, "here-1"), (second, "dead-3")):
        layout.work_of(name).mkdir(parents=True)
        heart = Heart(layout.work_of(name), name, run)
        heart.hear("step", {"name": "render", "frames": 10, "done": 4})
    note_attempt(layout.work_of(first), {"attempt": 1, "error": "SIGABRT"})
    layout.work_of(third).mkdir()
    write_json(layout.work_of(third) / "failed.json", {"error": f"{third}: no camera"})
    state = status_of(layout.root)
    assert [run.name for run in live_runs(layout)] == ["here-1", "there-2"]
    assert (state.frames_s, state.left_s) == (4.0, 90.0)
    text = state.as_text()
    assert "0 of 7 sequences finished, 4.00 frames/s, 1:30 left" in text
    assert f"{first}: rendering, 4 of 10 frames, on " in text
    assert "failed attempt: SIGABRT" in text
    assert f"{second}: rendering, 4 of 10 frames; nobody is at it" in text
    assert f"failed: {third}: no camera" in text
    assert json.loads(json.dumps(state.as_dict()))["begun"][first]["pid"] == os.getpid()


def _begun(worklist: Worklist, tmp_path: Path) -> SequenceOrder:
    layout = DatasetLayout(tmp_path / "data")
    open_dataset_for(RECIPE, layout, engine_is_ours=False)
    return replace(worklist.orders[0], root=layout.root)


def test_a_failed_attempt_is_recorded_and_its_causes_end(worklist: Worklist, tmp_path: Path) -> None:
    order = _begun(worklist, tmp_path)
    with pytest.raises(AttemptError, match="ended with status 3") as caught:
        attempt(order, Limits(worker=(sys.executable, "-c", "raise SystemExit(3)")))
    causes, error = [], caught.value.__cause__
    while error is not None and len(causes) < 10:  # Dask follows them without a limit
        causes.append(error)
        error = error.__cause__
    assert len(causes) < 10
    (record,) = attempts_so_far(DatasetLayout(order.root).work_of(order.sequence_id))
    assert record["attempt"] == 1
    assert "ended with status 3" in record["error"]


def test_what_another_run_has_finished_meanwhile_is_no_failure(worklist: Worklist, tmp_path: Path) -> None:
    order = _begun(worklist, tmp_path)
    summary = DatasetLayout(order.root).sequence(order.sequence_id).summary
    summary.parent.mkdir()
    code = f"open({str(summary)!r}, 'w').close(); raise SystemExit(3)"
    assert attempt(order, Limits(worker=(sys.executable, "-c", code))) is False
