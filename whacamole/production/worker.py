"""``python -m whacamole.production.worker ORDER.json``: one sequence in a process of its own.

What happens to the process — a crash in a driver, an out-of-memory kill — happens to one attempt at one
sequence. It tells its parent what it does in JSON lines on standard output.
"""

import json
import sys
from pathlib import Path
from typing import Any

from camera_rigs import PlanError
from render_jobs import RenderJobError, WorkerError
from render_jobs.processes import die_with_parent
from whacamole.errors import WhacamoleError
from whacamole.production.sequence import make_sequence
from whacamole.production.worklist import SequenceOrder

__all__ = ["main"]


def say(event: str, **facts: Any) -> None:
    """Tell the parent; one line, at once."""
    sys.stdout.write(json.dumps({"event": event, **facts}) + "\n")
    sys.stdout.flush()


def main(arguments: list[str]) -> int:
    """Make the sequence that the file orders; return the exit code.

    ``failed`` with ``again`` false answers a fault of the input, which a second attempt would meet again.
    """
    die_with_parent()
    value = json.loads(Path(arguments[0]).read_text(encoding="utf-8"))
    order = SequenceOrder.from_dict(value)
    try:
        make_sequence(order, say, threads=value["threads"], device=value["device"])
    except WorkerError as error:
        say("failed", error=str(error), again=True)
        return 1
    except (WhacamoleError, RenderJobError, PlanError) as error:
        say("failed", error=str(error), again=False)
        return 1
    say("done")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
