"""``python -m whacamole.production.worker ORDER.json``: one sequence in a process of its own.

What happens to the process — a crash in a driver, an out-of-memory kill — happens to one attempt at one
sequence. It tells its parent what it does in JSON lines on standard output.
"""

import argparse
import errno
import json
import sys
from pathlib import Path
from typing import Any, Protocol

from camera_rigs import PlanError
from render_jobs import RenderJobError, WorkerError
from render_jobs.errors import PostponedError
from render_jobs.processes import be_first_to_go, die_with_parent
from whacamole.errors import WhacamoleError
from whacamole.production.pulse import Heart
from whacamole.production.worklist import SequenceOrder

__all__ = ["Maker", "Say", "main"]


class Say(Protocol):
    """Tells the parent, and the dataset's folder, what is going on."""

    def __call__(self, event: str, **facts: Any) -> None: ...


class Maker(Protocol):
    """Makes a sequence: :func:`whacamole.production.sequence.make_sequence`."""

    def __call__(
        self,
        order: SequenceOrder,
        say: Say,
        *,
        threads: int,
        device: str,
        silence_s: float,
        memory_mb: float | None,
    ) -> None: ...


def main(arguments: list[str], make: Maker | None = None) -> int:
    """Make the sequence that the file orders; return the exit code.

    ``failed`` with ``again`` false answers a fault of the input, which a second attempt would meet again.

    Args:
        make: what makes it; None is the real thing.
    """
    options = _parse(arguments)
    die_with_parent(options.parent or None)
    be_first_to_go()
    order = SequenceOrder.from_dict(json.loads(options.order.read_text(encoding="utf-8")))
    heart = Heart(options.order.parent, order.sequence_id, options.run)

    def say(event: str, **facts: Any) -> None:
        sys.stdout.write(json.dumps({"event": event, **facts}) + "\n")
        sys.stdout.flush()
        heart.hear(event, facts)

    if make is None:
        from whacamole.production.sequence import make_sequence  # late: it loads half the package

        make = make_sequence
    try:
        make(
            order, say,
            threads=options.threads, device=options.device,
            silence_s=options.silence, memory_mb=options.memory or None,
        )  # fmt: skip
    except PostponedError as error:
        say("failed", error=str(error), postponed=True)
    except WorkerError as error:
        say("failed", error=str(error), again=True)
    except (WhacamoleError, RenderJobError, PlanError) as error:
        say("failed", error=str(error), again=False)
    except OSError as error:
        if error.errno not in (errno.ENOSPC, errno.EDQUOT):
            raise
        say("failed", error=str(error), disk_full=True)
    else:
        say("done")
        return 0
    return 1


def _parse(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m whacamole.production.worker", description=__doc__)
    parser.add_argument("order", type=Path, help="the order, as JSON")
    parser.add_argument("--threads", type=int, default=0, help="processor threads; 0 takes all cores")
    parser.add_argument("--device", default="auto", help="auto, cpu or gpu")
    parser.add_argument("--silence", type=float, default=1800.0, help="seconds a frame may take")
    parser.add_argument("--memory", type=float, default=0.0, help="MB the renderer may hold; 0: no limit")
    parser.add_argument("--parent", type=int, default=0, help="end when this process does")
    parser.add_argument("--run", default="", help="the run that asks for it")
    return parser.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
