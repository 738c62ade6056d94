"""One job, one process: ``python -m render_jobs.worker JOB_FOLDER``.

Prints one JSON object a line to stdout: ``start``, ``frame``, ``profile``, ``done`` or ``error``. All else
that Blender and Python print goes to ``render.log`` in the job folder. Frames already there are not rendered
again.
The exit status is 0 when every frame is there, ``BAD_JOB`` or ``NO_ENGINE`` where another try cannot
help, else 1.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib
import json
import os
import shutil
import sys
import threading
import time
import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NoReturn, TextIO

from render_jobs.devices import parse_device
from render_jobs.errors import EngineError, RenderJobError
from render_jobs.images import is_complete
from render_jobs.job import RenderJob
from render_jobs.probe import explain_failure
from render_jobs.processes import be_first_to_go, die_with_parent
from render_jobs.profile import IMPORTING, LOADING, STARTING, Profile, since_start
from render_jobs.protocol import BAD_JOB, ENGINES, FAILED, LOG_FILE, NO_ENGINE
from render_jobs.storage import OUTPUT_FOLDER


class Reporter:
    """Speaks to the parent: one JSON object a line, on the stdout that the process was started with."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream
        self._lock = threading.Lock()

    def send(self, event: str, **values: object) -> None:
        """Send one event. A parent that no longer listens is no error here."""
        with self._lock, contextlib.suppress(BrokenPipeError):
            self._stream.write(json.dumps({"event": event, **values}) + "\n")
            self._stream.flush()

    def abort(self, error: BaseException) -> NoReturn:
        """Report the error and end the process at once.

        There is no orderly way out: Blender swallows exceptions raised in its handlers, and taking its module
        down at the interpreter's exit can hang.
        """
        traceback.print_exception(error)
        code = (
            NO_ENGINE
            if isinstance(error, EngineError)
            else BAD_JOB
            if isinstance(error, RenderJobError)
            else FAILED
        )
        message = str(error).strip() or type(error).__name__
        self.send("error", message=" ".join(message.split()))
        leave(code)


def leave(code: int) -> NoReturn:
    """End the process without taking down the interpreter."""
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


def main(arguments: Sequence[str] | None = None, asked: float | None = None) -> NoReturn:
    """Render the frames of a job that are missing.

    Args:
        arguments: of the command line.
        asked: the monotonic time at which a process in waiting was asked for this.
    """
    options = _parse(arguments)
    if options.parent:
        die_with_parent(options.parent)
    be_first_to_go()
    reporter = Reporter(_take_over_output(options.job))
    profile = Profile()
    profile.add(STARTING, since_start() if asked is None else time.monotonic() - asked)
    try:
        _work(options, reporter, profile)
    except BaseException as error:
        reporter.abort(error)
    reporter.send("profile", seconds={name: round(value, 4) for name, value in profile.seconds.items()})
    reporter.send("done")
    leave(0)


def _parse(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="python -m render_jobs.worker", description=(__doc__ or "").split("\n")[0]
    )
    parser.add_argument("job", type=Path, help="the job folder")
    parser.add_argument("--engine", choices=sorted(ENGINES), default="cycles")
    parser.add_argument("--device", default="auto", help="auto, cpu, gpu, or an interface as cuda:0")
    parser.add_argument("--threads", type=int, default=0, help="CPU threads; 0 takes all cores")
    parser.add_argument("--frames", type=_frame_range, help="FIRST:END, half open; default all")
    parser.add_argument("--parent", type=int, default=0, help="end when this process is no longer the parent")
    return parser.parse_args(arguments)


def _frame_range(text: str) -> range:
    first, _, end = text.partition(":")
    return range(int(first), int(end))


def _work(options: argparse.Namespace, reporter: Reporter, profile: Profile) -> None:
    with profile.phase(LOADING):
        job = RenderJob.load(options.job)
    device = parse_device(options.device)
    out = options.job / OUTPUT_FOLDER
    wanted = options.frames or range(job.num_frames)
    missing = [
        frame
        for frame in wanted
        if frame < job.num_frames and not is_complete(out, frame, job.passes, job.image_format)
    ]
    if not missing:
        return
    out.mkdir(exist_ok=True)
    scratch = options.job / f"scratch-{os.getpid()}"
    scratch.mkdir()
    try:
        with profile.phase(IMPORTING):
            engine = load_engine(options.engine)
        engine.render(
            job=job,
            frames=missing,
            out=out,
            scratch=scratch,
            device=device,
            threads=options.threads,
            on_start=lambda devices: reporter.send("start", devices=devices, frames=len(missing)),
            on_frame=lambda frame, seconds, cpu_seconds: reporter.send(
                "frame", frame=frame, seconds=round(seconds, 4), cpu_seconds=round(cpu_seconds, 4)
            ),
            abort=reporter.abort,
            profile=profile,
        )
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
    absent = [frame for frame in missing if not is_complete(out, frame, job.passes, job.image_format)]
    if absent:
        raise RuntimeError(f"the engine ended without frame {absent[0]} ({len(absent)} in all)")


def load_engine(name: str) -> Any:
    """The engine's module.

    Raises:
        EngineError: it does not load; the message holds the remedy.
    """
    try:
        return importlib.import_module(ENGINES[name])
    except Exception as error:  # a missing library can show as any of several
        failure = explain_failure(name, "".join(traceback.format_exception(error)), FAILED)
        raise EngineError(f"the engine {name} does not load ({failure.found}): {failure.remedy}") from error


def _take_over_output(folder: Path) -> TextIO:
    """Send everything printed from now on, C code included, to the log; return what was stdout."""
    stream = os.fdopen(os.dup(1), "w", encoding="utf-8")
    if folder.is_dir():
        log = os.open(folder / LOG_FILE, os.O_WRONLY | os.O_APPEND | os.O_CREAT, 0o666)
        os.dup2(log, 1)
        os.dup2(log, 2)
        os.close(log)
    else:
        os.dup2(2, 1)
    return stream


if __name__ == "__main__":
    main()
