"""Where the time goes: what Blender prints is added up to the phases of a frame."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from render_jobs.blender.phases import LogFollower, Phases
from render_jobs.profile import DENOISING, LABELLING, SAMPLING, SYNCHRONISING, Profile, since_start

LINES = [
    ("00.00", "beauty | Synchronizing object | floor.0"),
    ("00.50", "beauty | Updating Scene BVH | Building"),
    ("01.00", "beauty | Sample 0/16"),
    ("02.00", "beauty | Sample 1/16"),
    (None, "Intel(R) Open Image Denoise 2.3.3"),
    ("09.00", "beauty | Sample 16/16"),
    ("09.00", "beauty | Finished"),
    ("09.25", "labels | Synchronizing object | floor.0"),
    ("09.50", "labels | Sample 0/1"),
    ("10.00", "labels | Sample 1/1"),
    ("10.00", "labels | Finished"),
]
DENOISER_SEEN = 8.0


def _line(frame: int, clock: str | None, rest: str) -> bytes:
    if clock is None:
        return rest.encode()
    memory = "Mem:139.51M (Peak 402.83M)"
    return f"Fra:{frame} {memory} | Time:00:{clock} | Mem:107.43M, Peak:255.09M | Scene, {rest}".encode()


def test_every_second_of_a_frame_is_counted_once_under_what_was_done_in_it() -> None:
    profile = Profile()
    phases = Phases(profile, "labels")
    for frame, began in ((0, 100.0), (1, 200.0)):
        for clock, rest in LINES:
            at = DENOISER_SEEN if clock is None else float(clock)
            phases.hear(_line(frame, clock, rest), began + at)
        phases.hear(b"Saved: 'raw_0001.exr'", began + 10.1)
    assert profile.seconds == pytest.approx(
        {SYNCHRONISING: 2 * 1.5, SAMPLING: 2 * 7.0, DENOISING: 2 * 1.0, LABELLING: 2 * 0.5}
    )


def test_hours_are_read_and_lines_of_others_are_not() -> None:
    profile = Profile()
    phases = Phases(profile, "labels")
    for clock in ("00:01.00", "01:00:01.50"):
        line = f"Fra:7 Mem:1.00M (Peak 1.00M) | Time:{clock} | Remaining:00:11.94 | Mem:1.00M, Peak:1.00M"
        phases.hear(f"{line} | Scene, beauty | Sample 1/16".encode(), 0.0)
    phases.hear(b"Fra: what a texture's name may be", 1.0)
    assert profile.seconds == pytest.approx({SYNCHRONISING: 1.0, SAMPLING: 3600.5})


def test_only_what_is_added_to_the_log_counts(tmp_path: Path) -> None:
    log = tmp_path / "render.log"
    old, new = _line(0, "05.00", "beauty | Finished"), _line(1, "02.00", "beauty | Finished")
    log.write_bytes(old + b"\n")
    profile = Profile()
    with LogFollower(log, Phases(profile, "labels")), log.open("ab") as stream:
        stream.write(new[:20])
        stream.flush()
        time.sleep(0.05)
        stream.write(new[20:] + b"\n")
    assert profile.seconds == {SYNCHRONISING: 2.0}
    with LogFollower(tmp_path / "none.log", Phases(profile, "labels")):
        pass


def test_the_age_of_this_process_is_known() -> None:
    first = since_start()
    time.sleep(0.02)
    assert 0.0 < first < since_start() < 24 * 3600
