"""One attempt at one sequence, seen from the parent: start the worker, listen, tell how it ended."""

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

from whacamole.dataset import DatasetLayout
from whacamole.dataset.files import write_json
from whacamole.production.worklist import SequenceOrder

__all__ = ["AttemptError", "Listener", "attempt"]

Listener = Callable[[str, dict[str, Any]], None]
"""Called with the sequence id and what its worker says."""


class AttemptError(Exception):
    """An attempt at a sequence failed; the message is one line.

    Attributes:
        again: whether another attempt may fare better.
    """

    def __init__(self, message: str, *, again: bool = True) -> None:
        super().__init__(message)
        self.again = again


def attempt(
    order: SequenceOrder,
    listen: Listener,
    *,
    threads: int,
    device: str,
    running: Callable[[subprocess.Popen[str]], None],
) -> None:
    """Run the worker for ``order`` to its end.

    Args:
        listen: gets every event of the worker.
        threads: processor threads it may use; 0 means all.
        device: "auto", "cpu" or "gpu".
        running: gets the process, so that the caller can stop it.

    Raises:
        AttemptError: the sequence is not there.
    """
    folder = DatasetLayout(order.root).work_of(order.sequence_id)
    folder.mkdir(parents=True, exist_ok=True)
    write_json(folder / "order.json", {**order.as_dict(), "threads": threads, "device": device})
    log = folder / "worker.log"
    with log.open("ab") as errors:
        process = subprocess.Popen(
            [sys.executable, "-m", "whacamole.production.worker", str(folder / "order.json")],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=errors,
            text=True,
            encoding="utf-8",
        )
        running(process)
        failure: dict[str, Any] | None = None
        assert process.stdout is not None
        for line in process.stdout:
            event = _event(line)
            if event.get("event") == "failed":
                failure = event
            elif event:
                listen(order.sequence_id, event)
        code = process.wait()
    if code == 0:
        return
    if failure is not None:
        raise AttemptError(str(failure["error"]), again=bool(failure["again"]))
    raise AttemptError(
        f"{order.sequence_id}: its process ended with {_ending(code)}; see {log}{_last_line(log)}"
    )


def _event(line: str) -> dict[str, Any]:
    """Return the event a line holds; a library's stray print is no event."""
    try:
        value = json.loads(line)
    except json.JSONDecodeError:
        return {}
    return value if isinstance(value, dict) else {}


def _ending(code: int) -> str:
    return f"signal {-code}" if code < 0 else f"exit code {code}"


def _last_line(log: Path) -> str:
    lines = log.read_text(encoding="utf-8", errors="replace").strip().splitlines()
    return f" ({lines[-1].strip()})" if lines else ""
