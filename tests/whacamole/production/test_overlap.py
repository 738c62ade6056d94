"""Labelling beside rendering: in order, never before its frame is there, and never left waiting."""

import time
from collections.abc import Callable
from pathlib import Path

import pytest

from render_jobs.profile import Profile
from whacamole.dataset import DatasetLayout
from whacamole.production import overlap
from whacamole.production.overlap import FrameGate, beside
from whacamole.production.profiling import SequenceProfile, profile_as_dict, profile_table, read_profiles

FRAMES = 5
MISSING = [1, 2, 4]

Told = Callable[[int], None]


@pytest.fixture
def job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setattr(overlap, "missing_frames", lambda folder: MISSING)
    return tmp_path


def test_each_frame_is_labelled_after_it_is_there_and_all_are_told_once(job: Path) -> None:
    events: list[tuple[str, int]] = []
    said: list[tuple[str, object]] = []

    def render(on_frame: Told) -> str:
        for frame in reversed(MISSING):
            time.sleep(0.01)
            events.append(("there", frame))
            on_frame(frame)
        return "rendered"

    def label(ready: Told, done: Told) -> str:
        for frame in range(FRAMES):
            ready(frame)
            events.append(("labelled", frame))
            time.sleep(0.01)
            done(frame)
        return "labelled"

    def say(event: str, **facts: object) -> None:
        said.append((event, facts.get("done", facts.get("index"))))

    profile = Profile()
    assert beside(job, render, label, say, FRAMES, profile) == ("rendered", "labelled")
    assert [frame for what, frame in events if what == "labelled"] == list(range(FRAMES))
    for frame in MISSING:
        assert events.index(("there", frame)) < events.index(("labelled", frame))
    assert [index for event, index in said if event == "frame"] == [4, 2, 1]
    (done,) = (value for event, value in said if event == "step")
    aloud = [index for event, index in said if event == "labelled"]
    assert aloud == list(range(int(str(done)), FRAMES)), "silent while frames render, told one by one after"
    assert 0.01 * FRAMES <= profile.seconds[overlap.LABELLING] < 5.0


def test_a_renderer_that_fails_ends_the_labelling_and_its_error_is_the_one_told(job: Path) -> None:
    def render(on_frame: Told) -> None:
        on_frame(1)
        raise OSError("the renderer crashed")

    def label(ready: Told, done: Told) -> None:
        for frame in range(FRAMES):
            ready(frame)

    with pytest.raises(OSError, match="the renderer crashed"):
        beside(job, render, label, lambda *_, **__: None, FRAMES, Profile())


def test_what_the_labelling_raises_is_told_once_the_frames_are_there(job: Path) -> None:
    rendered = []

    def render(on_frame: Told) -> None:
        for frame in MISSING:
            on_frame(frame)
            rendered.append(frame)

    def label(ready: Told, done: Told) -> None:
        raise ValueError("wrong shape")

    with pytest.raises(ValueError, match="wrong shape"):
        beside(job, render, label, lambda *_, **__: None, FRAMES, Profile())
    assert rendered == MISSING


def test_a_gate_lets_through_what_was_never_missing() -> None:
    gate = FrameGate([3])
    gate.wait(0)
    gate.close()
    gate.wait(1)
    with pytest.raises(Exception, match="frame 3 was not rendered"):
        gate.wait(3)


def test_phases_and_the_rest_add_up_to_the_wall_time(tmp_path: Path) -> None:
    layout = DatasetLayout(tmp_path)
    one = SequenceProfile.of(4, 10.0, {"take": 2.0, "samples": 7.0, "encode": 3.0, "labels": 1.0})
    two = SequenceProfile.of(6, 5.0, {"take": 1.0, "draw": 3.5, "encode": 0.5})
    assert one.phases["other"] == pytest.approx(1.0)
    for name, profile in (("a-00", one), ("b-00", two)):
        profile.save(layout, name)
        assert sum(profile.phases.values()) == pytest.approx(profile.wall)
    kept = read_profiles(tmp_path, ["a-00", "b-00", "never-made-00"])
    assert kept == {"a-00": one, "b-00": two}
    total = profile_as_dict(kept)["sum"]
    assert total["wall"] == 15.0
    assert total["frames"] == 10
    assert sum(total["phases"].values()) == pytest.approx(15.0)
    assert total["meanwhile"] == {"encode": 3.5, "labels": 1.0}
    assert profile_table(kept).row_count == len(total["phases"]) + 1 + len(total["meanwhile"])
