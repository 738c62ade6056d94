"""Engines that cannot start are told with their remedy, and two engines can share a job."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from render_jobs import PASSES, EngineError, Mesh, Quality, RenderJob, run_job
from render_jobs.probe import choose_engine, probe
from render_jobs.processes import child_environment
from render_truth import BOX, BOX_FACES, SQUARE, SQUARE_FACES, camera, moving

FRAMES = 3


def small_job() -> RenderJob:
    """A box that slides over a floor."""
    eye = [[0.1 * frame, -4.0, 1.5] for frame in range(FRAMES)]
    path = camera(eye, [0, 0, 0.5], [60.0] * FRAMES, [[32.0, 18.0]] * FRAMES, (64, 36))
    box = Mesh("box", moving(BOX, [0.1, 0, 0], FRAMES), BOX_FACES, track_id=1)
    return RenderJob(
        path, (box, Mesh("floor", SQUARE * 6, SQUARE_FACES)), quality=Quality(name="q", samples=2)
    )


def pretend_bpy(folder: Path, code: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Make children import a module of this code as Blender's."""
    (folder / "bpy").mkdir()
    (folder / "bpy" / "__init__.py").write_text(code, encoding="utf-8")
    monkeypatch.setenv("PYTHONPATH", str(folder))


@pytest.mark.gl
def test_a_missing_library_is_named_with_its_package_and_the_raster_engine_steps_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fault = "libX11.so.6: cannot open shared object file: No such file or directory"
    pretend_bpy(tmp_path, f"raise ImportError({fault!r})", monkeypatch)
    small_job().save(tmp_path / "job")
    with pytest.raises(EngineError, match=r"libX11.so.6.*: .*libx11-6") as caught:
        run_job(tmp_path / "job", engine="cycles", timeout=300)
    assert "\n" not in str(caught.value)
    name, note = choose_engine()
    assert name == "raster"
    assert "as cycles cannot run" in note
    assert "libx11-6" in note
    assert run_job(tmp_path / "job", engine=name, timeout=300).frames == FRAMES


def test_an_engine_that_aborts_for_want_of_a_library_is_told_with_its_package(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fault = "Couldn't open libEGL.so.1: libEGL.so.1: cannot open shared object file"
    code = f"import os, sys; print({fault!r}, file=sys.stderr, flush=True); os.abort()"
    pretend_bpy(tmp_path, code, monkeypatch)
    small_job().save(tmp_path / "job")
    with pytest.raises(EngineError, match=r"libEGL.so.1.*: .*libegl1"):
        run_job(tmp_path / "job", engine="eevee", timeout=300)
    found = probe("eevee")
    assert not found.works
    assert "libegl1" in found.remedy


@pytest.mark.blender
@pytest.mark.gl
def test_labels_are_those_of_cycles_whichever_engine_makes_the_picture(tmp_path: Path) -> None:
    """With Workbench in the place of EEVEE, whose shaders take a minute where there is no GPU."""
    job = replace(small_job(), passes=tuple(PASSES), image_format="png")
    job.save(tmp_path / "cycles")
    run_job(tmp_path / "cycles", device="cpu", threads=2, timeout=300)
    job.save(tmp_path / "shared")
    code = f"""
import os, sys
from pathlib import Path
from render_jobs import RenderJob
from render_jobs.blender.engine import render
from render_jobs.devices import parse_device
from render_jobs.profile import Profile
folder = Path({str(tmp_path / "shared")!r})
(folder / "out").mkdir(); (folder / "scratch").mkdir()
def abort(error):
    print(error, file=sys.stderr, flush=True); os._exit(1)
render(RenderJob.load(folder), range({FRAMES}), folder / "out", folder / "scratch", parse_device("cpu"), 2,
       print, lambda *_: None, abort, Profile(), "BLENDER_WORKBENCH")
sys.stdout.flush(); os._exit(0)
"""
    done = subprocess.run(
        [sys.executable, "-c", code], env=child_environment(), capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    mine, theirs = (
        {
            path.relative_to(tmp_path / name): path
            for path in sorted((tmp_path / name / "out").rglob("??????.*"))
        }
        for name in ("shared", "cycles")
    )
    for (name, path), other in zip(mine.items(), theirs.values(), strict=True):
        same = path.read_bytes() == other.read_bytes()
        assert same == ("rgb" not in name.parts), name
