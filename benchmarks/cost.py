"""What a dataset costs in core-hours and on disk: ``python benchmarks/cost.py``.

Makes the same sequence with few frames and with more, at two sizes. The difference is the CPU time of a
frame with all that belongs to it (render, labels, encoding), the rest that of a sequence. A frame's time is
taken for linear in pixels. From that comes the estimate for as many instances and sequences as the WHAC
paper's. CPU time of all processes, so that other work on the machine disturbs little.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from render_jobs.budget import frame_bytes
from render_jobs.passes import DEFAULT_PASSES
from render_jobs.processes import child_environment
from whacamole.production.space import LABEL_BYTES, SEQUENCE_BYTES, readable_bytes
from whacamole.recipe import Recipe

INSTANCES, SEQUENCES, SIZE = 1_460_000, 2_434, (1920, 1080)
"""Of the WHAC-A-Mole dataset (Table 1 of the paper)."""

PEOPLE = (1, 2)
"""In a frame: the paper's motions are single people and pairs."""


@dataclass(frozen=True)
class Cost:
    """CPU seconds of a frame and of a sequence without its frames."""

    frame: float
    sequence: float


def main() -> None:
    """Measure, extrapolate, print."""
    options = _parse()
    few, many = (int(word) for word in options.frames.split(","))
    sizes = [tuple(int(side) for side in size.split("x")) for size in options.sizes.split(",")]
    found = {}
    for width, height in sizes:
        short, long = (_cpu_seconds(width, height, frames, options) for frames in (few, many))
        frame = (long - short) / (many - few)
        found[width * height] = Cost(frame, short - few * frame)
        print(
            f"{width}x{height}: {frame:.2f} CPU s a frame, {short - few * frame:.1f} a sequence", flush=True
        )
    slope, fixed = np.polyfit(list(found), [cost.frame for cost in found.values()], 1)
    frame = fixed + slope * SIZE[0] * SIZE[1]
    start = float(np.mean([cost.sequence for cost in found.values()]))
    print(f"a frame: {fixed:.2f} s + {slope * 1e6:.2f} s a megapixel; at {SIZE[0]}x{SIZE[1]}: {frame:.1f} s")
    for people in PEOPLE:
        frames = INSTANCES / people
        hours = (frames * frame + SEQUENCES * start) / 3600
        size = SEQUENCES * _sequence_bytes(frames / SEQUENCES, people)
        print(f"{people} in a frame: {frames:,.0f} frames, {hours:,.0f} core-hours, {readable_bytes(size)}")


def _parse() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--sizes", default="320x180,640x360")
    parser.add_argument("--frames", default="2,5", help="of the shorter and of the longer sequence")
    parser.add_argument("--engine", default="cycles")
    parser.add_argument("--quality", default="standard")
    parser.add_argument("--stages", default="courtyard")
    return parser.parse_args()


def _cpu_seconds(width: int, height: int, frames: int, options: argparse.Namespace) -> float:
    """CPU time of making one sequence, the run's own left out."""
    with tempfile.TemporaryDirectory() as folder:
        code = (
            "import resource, sys; from pathlib import Path\n"
            "from whacamole.production.run import produce; from whacamole.recipe import Recipe\n"
            "result = produce(Recipe.model_validate_json(sys.argv[1]), Path(sys.argv[2]), quiet=True)\n"
            "assert result.complete, result.failures\n"
            "spent = resource.getrusage(resource.RUSAGE_CHILDREN)\n"
            "print(spent.ru_utime + spent.ru_stime)"
        )
        recipe = Recipe(
            size=(width, height), frames=frames, limit=1, engine=options.engine, quality=options.quality,
            stages=tuple(options.stages.split(",")), seed=3,
        )  # fmt: skip
        done = subprocess.run(
            [sys.executable, "-c", code, recipe.model_dump_json(), str(Path(folder, "data"))],
            check=True, stdout=subprocess.PIPE, text=True, env=child_environment(),
        )  # fmt: skip
    return float(done.stdout)


def _sequence_bytes(frames: float, people: int) -> float:
    """What a sequence of the default passes takes on disk at the paper's size."""
    return SEQUENCE_BYTES + frames * (frame_bytes(DEFAULT_PASSES, "jpg", *SIZE) + people * LABEL_BYTES)


if __name__ == "__main__":
    main()
