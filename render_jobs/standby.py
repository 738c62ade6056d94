"""A render child that starts and loads its engine while its job is still being made.

``python -m render_jobs.standby ENGINE PARENT`` loads the engine, reads one JSON line with the time and the
arguments of :mod:`render_jobs.worker`, and goes on as that.
"""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import NoReturn, Self

from render_jobs.errors import EngineError
from render_jobs.processes import be_first_to_go, die_with_parent
from render_jobs.watch import start_child


class Standby:
    """A child in waiting, for one use by :func:`render_jobs.run_job`; as a context, which ends it.

    It only saves time: where it has died meanwhile, the job gets a child of its own.

    Args:
        engine: the engine that the job will want.
        log: what the child prints before it knows its job is appended here.
    """

    def __init__(self, engine: str, log: Path) -> None:
        self.engine = engine
        command = [sys.executable, "-X", "faulthandler", "-m", __name__, engine, str(os.getpid())]
        self._child = start_child(command, log, asked=True)
        self._used = False

    @property
    def pid(self) -> int:
        """The child's process id."""
        return self._child.pid

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._child.kill()
        self._child.wait()
        for pipe in (self._child.stdin, self._child.stdout):
            if pipe is not None:
                with contextlib.suppress(BrokenPipeError):
                    pipe.close()

    def put_to_work(self, arguments: Sequence[str]) -> subprocess.Popen[bytes] | None:
        """Tell the child what to render; return it, or None where it is used up or gone.

        Args:
            arguments: those of :mod:`render_jobs.worker`.
        """
        pipe = self._child.stdin
        if self._used or pipe is None or self._child.poll() is not None:
            return None
        self._used = True
        line = json.dumps({"asked": time.monotonic(), "arguments": list(arguments)}) + "\n"
        try:
            pipe.write(line.encode())
            pipe.close()
        except BrokenPipeError:
            return None
        return self._child


def main(engine: str, parent: str) -> NoReturn:
    """Load the engine, wait for a job, render it."""
    die_with_parent(int(parent))
    be_first_to_go()
    from render_jobs.worker import leave, load_engine, main

    with contextlib.suppress(EngineError):  # met again, and told, when there is a job
        load_engine(engine)
    line = sys.stdin.readline()
    if not line:  # there is no job after all
        leave(0)
    order = json.loads(line)
    main(order["arguments"], asked=order["asked"])


if __name__ == "__main__":
    main(*sys.argv[1:])
