"""Whatever becomes of a child: the parent goes on, finished frames stay, the rest comes out the same."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import psutil
import pytest
from PIL import Image

from render_jobs import (
    Environment,
    Material,
    Mesh,
    Quality,
    RenderJob,
    RenderJobError,
    Sun,
    WorkerError,
    missing_frames,
    run_job,
)
from render_jobs.devices import parse_device
from render_jobs.processes import child_environment
from render_jobs.standby import Standby
from render_jobs.watch import Event, describe_end, watch_child
from render_truth import BOX, BOX_FACES, SQUARE, SQUARE_FACES, camera, moving

FRAMES = 6


def small_job(**changes: object) -> RenderJob:
    """Noisy on purpose: every pixel depends on the seed and on how light is sampled."""
    time_ = np.arange(FRAMES)[:, None]
    path = camera(
        [0.0, -4.0, 1.6] + time_ * [0.1, 0, 0],
        [0, 0, 0.6],
        [50.0] * FRAMES,
        [[32.0, 24.0]] * FRAMES,
        (64, 48),
    )
    box = Mesh("box", moving(BOX, [0.05, 0, 0.02], FRAMES), BOX_FACES, smooth=False, track_id=1)
    settings: dict[str, object] = {
        "camera": path,
        "meshes": (box, Mesh("floor", SQUARE * 5, SQUARE_FACES)),
        "lights": (Sun(angle=20.0),),
        "environment": Environment(kind="hdri", hdri="forest"),
        "passes": ("rgb", "mask", "depth", "normal", "flow"),
        "quality": Quality(name="test", samples=4),
        **changes,
    }
    return RenderJob(**settings)  # type: ignore[arg-type]


def outputs(folder: Path) -> dict[str, bytes]:
    paths = (path for path in sorted((folder / "out").rglob("*")) if path.is_file())
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


@pytest.fixture(scope="module")
def rendered(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An undisturbed run."""
    folder = tmp_path_factory.mktemp("undisturbed") / "job"
    small_job().save(folder)
    told: list[int] = []
    result = run_job(folder, device="cpu", threads=2, timeout=120, on_frame=told.append)
    assert told == list(range(FRAMES)) == list(result.frame_seconds)
    assert result.frames == FRAMES
    assert result.devices == "CPU"
    assert 100 < result.peak_memory_mb < 4000
    return folder


@pytest.mark.blender
def test_nothing_but_the_frames_is_left(rendered: Path) -> None:
    assert len(outputs(rendered)) == 5 * FRAMES
    kept = ["camera.npz", "job.json", "meshes", "out", "render.log"]
    assert sorted(path.name for path in rendered.iterdir()) == kept
    assert missing_frames(rendered) == []


@pytest.mark.blender
def test_a_finished_job_is_not_rendered_again(rendered: Path) -> None:
    before = {path: path.stat().st_mtime_ns for path in rendered.rglob("*.exr")}
    result = run_job(rendered)
    assert (result.frames, result.devices) == (0, "")
    assert {path: path.stat().st_mtime_ns for path in rendered.rglob("*.exr")} == before


@pytest.mark.blender
def test_one_seed_gives_one_picture_whatever_the_order(rendered: Path, tmp_path: Path) -> None:
    """Frames rendered by other processes, in blocks with gaps between, are the same to the byte."""
    small_job().save(tmp_path / "job")
    (tmp_path / "job" / "out").mkdir()
    for name in (
        "rgb/000002.jpg",
        "mask/000002.png",
        "depth/000002.exr",
        "normal/000002.exr",
        "flow/000002.exr",
    ):
        (tmp_path / "job" / "out" / name).parent.mkdir()
        (tmp_path / "job" / "out" / name).write_bytes((rendered / "out" / name).read_bytes())
    (tmp_path / "job" / "out" / "normal" / "000002.exr").unlink()  # not complete: to be rendered again
    assert run_job(tmp_path / "job", device="cpu", threads=1, block=4, timeout=120).frames == FRAMES
    assert outputs(tmp_path / "job") == outputs(rendered)


@pytest.mark.blender
def test_another_seed_gives_other_noise_and_the_same_labels(rendered: Path, tmp_path: Path) -> None:
    small_job(seed=1).save(tmp_path / "job")
    run_job(tmp_path / "job", device="cpu", threads=2, timeout=120)
    mine, other = outputs(rendered), outputs(tmp_path / "job")
    assert mine.keys() == other.keys()
    differing = {name.split("/")[1] for name in mine if mine[name] != other[name]}
    assert differing == {"rgb"}


@pytest.mark.blender
@pytest.mark.parametrize("frames_before", [1, 3])
def test_a_killed_run_leaves_whole_files_and_goes_on_to_the_same_end(
    rendered: Path, tmp_path: Path, frames_before: int
) -> None:
    folder = tmp_path / "job"
    small_job().save(folder)
    worker = subprocess.Popen(
        [sys.executable, "-m", "render_jobs.worker", str(folder), "--device", "cpu", "--threads", "2"],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=child_environment(), text=True,
    )  # fmt: skip
    assert worker.stdout is not None
    with worker.stdout as lines:
        while sum(1 for path in folder.glob("out/rgb/*")) < frames_before:
            assert lines.readline(), "the worker ended by itself"
    worker.kill()
    worker.wait()
    undisturbed = outputs(rendered)
    left = {name: value for name, value in outputs(folder).items() if "/.partial/" not in name}
    assert left
    assert left.items() <= undisturbed.items(), "every file left is complete"
    result = run_job(folder, device="cpu", threads=2, timeout=120)
    assert 0 < result.frames < FRAMES
    assert outputs(folder) == undisturbed
    assert not list(folder.glob("scratch-*"))


@pytest.mark.blender
def test_a_child_in_waiting_renders_the_same_and_is_used_once(rendered: Path, tmp_path: Path) -> None:
    small_job().save(tmp_path / "job")
    with Standby("cycles", tmp_path / "standby.log") as standby:
        waiting = standby.pid
        result = run_job(tmp_path / "job", device="cpu", threads=2, block=4, timeout=120, standby=standby)
        assert standby.put_to_work(["no", "second", "job"]) is None
    assert result.frames == FRAMES
    assert outputs(tmp_path / "job") == outputs(rendered)
    log = (tmp_path / "job" / "render.log").read_text()
    assert log.count("Fra:0 ") > 1, "what Blender says is in the job's own log"
    assert not psutil.pid_exists(waiting)


@pytest.mark.blender
def test_a_child_that_died_waiting_costs_nothing(rendered: Path, tmp_path: Path) -> None:
    small_job().save(tmp_path / "job")
    with Standby("cycles", tmp_path / "standby.log") as standby:
        os.kill(standby.pid, signal.SIGKILL)
        os.waitid(os.P_PID, standby.pid, os.WEXITED | os.WNOWAIT)
        run_job(tmp_path / "job", device="cpu", threads=2, timeout=120, standby=standby)
    assert outputs(tmp_path / "job") == outputs(rendered)


def test_a_child_in_waiting_tells_what_is_wrong_with_its_job(tmp_path: Path) -> None:
    small_job().save(tmp_path / "job")
    (tmp_path / "job" / "camera.npz").write_bytes(b"damaged")
    with (
        Standby("cycles", tmp_path / "standby.log") as standby,
        pytest.raises(RenderJobError, match=r"camera\.npz") as caught,
    ):
        run_job(tmp_path / "job", device="cpu", timeout=120, standby=standby)
    assert not isinstance(caught.value, WorkerError)


def test_a_child_in_waiting_ends_when_there_is_no_job_after_all(tmp_path: Path) -> None:
    with (
        pytest.raises(LookupError, match="the take failed"),
        Standby("raster", tmp_path / "standby.log") as standby,
    ):
        raise LookupError("the take failed")
    assert not psutil.pid_exists(standby.pid)


@pytest.mark.blender
def test_a_damaged_texture_is_named_and_not_tried_again(tmp_path: Path) -> None:
    Image.fromarray(np.zeros((8, 8, 3), np.uint8)).save(tmp_path / "skin.png")
    (tmp_path / "skin.png").write_bytes((tmp_path / "skin.png").read_bytes()[:40])
    mesh = Mesh("floor", SQUARE, SQUARE_FACES, Material(base_color_texture=tmp_path / "skin.png"))
    small_job(meshes=(mesh,)).save(tmp_path / "job")
    with pytest.raises(RenderJobError, match=r"the image is damaged|cannot be read") as caught:
        run_job(tmp_path / "job", device="cpu", timeout=120)
    assert not isinstance(caught.value, WorkerError)
    assert "\n" not in str(caught.value)


def test_a_bad_job_costs_no_child(tmp_path: Path) -> None:
    with pytest.raises(RenderJobError, match="is this a job folder"):
        run_job(tmp_path)
    small_job().save(tmp_path / "job")
    with pytest.raises(RenderJobError, match="device 'quantum' is not one of auto, cpu, gpu, optix"):
        run_job(tmp_path / "job", device="quantum")


def watched(code: str, folder: Path, **limits: float) -> list[Event]:
    """Run Python code as a watched child and return what it said."""
    events: list[Event] = []
    end = watch_child(
        [sys.executable, "-c", code],
        folder / "log",
        events.append,
        timeout=limits.get("timeout"),
        memory_limit_mb=limits.get("memory_limit_mb"),
        time_limit=limits.get("time_limit"),
    )
    return [*events, {"end": describe_end(end)}]


def test_a_child_that_hangs_is_killed(tmp_path: Path) -> None:
    with pytest.raises(WorkerError, match="nothing was finished in 1 s, the process was killed") as caught:
        watched("import time; print('{}', flush=True); time.sleep(600)", tmp_path, timeout=1.0)
    assert caught.value.log == tmp_path / "log"


def test_a_child_that_takes_too_much_memory_is_killed(tmp_path: Path) -> None:
    with pytest.raises(WorkerError, match="over the limit of 200 MB"):
        watched("import time; x = bytearray(300_000_000); time.sleep(600)", tmp_path, memory_limit_mb=200)


def test_a_child_that_is_never_silent_has_a_time_limit(tmp_path: Path) -> None:
    chatter = "import time\nwhile True: print('{}', flush=True); time.sleep(0.05)"
    with pytest.raises(WorkerError, match="it took longer than the limit of 1 s"):
        watched(chatter, tmp_path, timeout=30.0, time_limit=1.0)


def test_a_child_ends_when_its_run_does(tmp_path: Path) -> None:
    stop = threading.Event()
    threading.Timer(0.3, stop.set).start()
    with pytest.raises(WorkerError, match="it was stopped"):
        watch_child(
            [sys.executable, "-c", "import time; time.sleep(600)"],
            tmp_path / "log", print, timeout=None, memory_limit_mb=None, stop=stop,
        )  # fmt: skip


def test_a_child_gets_variables_of_its_own(tmp_path: Path) -> None:
    events: list[Event] = []
    code = "import json, os; print(json.dumps({'gpu': os.environ['CUDA_VISIBLE_DEVICES']}))"
    watch_child(
        [sys.executable, "-c", code], tmp_path / "log", events.append,
        timeout=60, memory_limit_mb=None, environment={"CUDA_VISIBLE_DEVICES": "3"},
    )  # fmt: skip
    assert events == [{"gpu": "3"}]


def test_a_child_that_aborts_says_how_and_leaves_its_log(tmp_path: Path) -> None:
    events = watched("import os, sys; print('last words', file=sys.stderr, flush=True); os.abort()", tmp_path)
    assert events == [{"end": "the process was ended by SIGABRT"}]
    assert "last words" in (tmp_path / "log").read_text()
    assert watched("raise SystemExit(3)", tmp_path) == [{"end": "the process ended with status 3"}]
    assert "was memory short?" in str(watched("import os; os.kill(os.getpid(), 9)", tmp_path))


def test_only_json_objects_are_events(tmp_path: Path) -> None:
    code = r"""print('Blender 4.5\n[1]\n{"event": "frame", "frame": 1}\n{half')"""
    assert watched(code, tmp_path)[:-1] == [{"event": "frame", "frame": 1}]


@pytest.mark.skipif(sys.platform != "linux", reason="the kernel's help is asked for on Linux")
def test_no_child_survives_its_parent(tmp_path: Path) -> None:
    child = (
        "import os, time; from render_jobs.processes import die_with_parent; die_with_parent();"
        "print(os.getpid(), flush=True); time.sleep(600)"
    )
    _outlives_no_parent(f"import subprocess, sys; subprocess.run([sys.executable, '-c', {child!r}])")


@pytest.mark.skipif(sys.platform != "linux", reason="the kernel's help is asked for on Linux")
def test_no_child_in_waiting_survives_its_parent(tmp_path: Path) -> None:
    _outlives_no_parent(
        "import time; from pathlib import Path; from render_jobs.standby import Standby\n"
        f"with Standby('raster', Path({str(tmp_path / 'log')!r})) as standby:\n"
        "  print(standby.pid, flush=True); time.sleep(600)"
    )


def _outlives_no_parent(code: str) -> None:
    """Run code that prints the id of a child of its own, kill it, and see the child end."""
    process = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, env=child_environment(), text=True
    )
    assert process.stdout is not None
    with process.stdout as lines:
        pid = int(lines.readline())
    assert psutil.pid_exists(pid)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    for _ in range(100):
        if not psutil.pid_exists(pid) or psutil.Process(pid).status() == psutil.STATUS_ZOMBIE:
            return
        time.sleep(0.1)
    pytest.fail("the child is an orphan")


def test_device_names() -> None:
    assert parse_device("cpu").interfaces == ()
    assert not parse_device("auto").insist
    assert parse_device("gpu").insist
    assert (parse_device("cuda:1").interfaces, parse_device("cuda:1").index) == (("CUDA",), 1)
    assert parse_device("optix").index is None
    for name in ("", "cuda:", "cuda:x", "cpu:0", "tpu"):
        with pytest.raises(RenderJobError, match="is not one of"):
            parse_device(name)
