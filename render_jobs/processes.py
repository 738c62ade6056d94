"""Child processes that leave nothing behind."""

from __future__ import annotations

import contextlib
import ctypes
import os
import signal
import sys
import threading
import time
from pathlib import Path

PR_SET_PDEATHSIG = 1
PARENT_POLL_S = 1.0
ORPHANED = 1
"""Exit status of a process whose parent has died."""


def die_with_parent(parent: int | None = None) -> None:
    """Make this process end when its parent does, so that no orphan keeps a machine busy.

    On Linux the kernel sees to it at once, even while native code holds the interpreter (and does so when the
    *thread* that started this process ends); elsewhere a thread looks once a second.

    Args:
        parent: the process id of the parent, so that its death before this call is noticed, too.
    """
    expected = os.getppid() if parent is None else parent
    if sys.platform == "linux":
        ctypes.CDLL(None, use_errno=True).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)

    def watch() -> None:
        while os.getppid() == expected:
            time.sleep(PARENT_POLL_S)
        os._exit(ORPHANED)

    threading.Thread(target=watch, daemon=True, name="parent-watch").start()


def be_first_to_go() -> None:
    """Let the kernel kill this process, not its parent, where memory runs out (Linux)."""
    with contextlib.suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text("500", encoding="ascii")


def child_environment() -> dict[str, str]:
    """The environment for a child that shall import the very packages that run here."""
    root = str(Path(__file__).resolve().parents[1])
    known = os.environ.get("PYTHONPATH")
    return os.environ | {"PYTHONPATH": root if not known else root + os.pathsep + known}
