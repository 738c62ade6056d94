"""One attempt at one sequence, seen from the parent: start the worker, listen, tell how it ended."""

import json
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from whacamole.dataset import DatasetLayout
from whacamole.dataset.files import write_json
from whacamole.production.worklist import SequenceOrder

__all__ = ["Listener", "Outcome", "attempt"]

Listener = Callable[[str, dict[str, Any]], None]
"""Called with the sequence id and what its worker says."""


@dataclass(frozen=True)
class Outcome:
    """How an attempt ended; ``error`` is one line, ``again`` says that another attempt may fare better."""

    done: bool
    error: str = ""
    again: bool = True


def attempt(
    order: SequenceOrder,
    listen: Listener,
    *,
    threads: int,
    device: str,
    running: Callable[[subprocess.Popen[str]], None],
) -> Outcome:
    """Run the worker for ``order`` to its end.

    Args:
        listen: gets every event of the worker.
        threads: processor threads it may use; 0 means all.
        device: "auto", "cpu" or "gpu".
        running: gets the process, so that the caller can stop it.
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
        return Outcome(done=True)
    if failure is not None:
        return Outcome(False, str(failure["error"]), bool(failure["again"]))
    return Outcome(
        False, f"{order.sequence_id}: its process ended with {_ending(code)}; see {log}{_last_line(log)}"
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
