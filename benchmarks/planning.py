"""Time the planner: frames per second for one, two and six people, and its growth with the length.

    python benchmarks/planning.py [--repeats N] [--json FILE]

A plan is made with `direct`, judged and mended included. Every figure is the best of N runs, in processor
time, so that a busy machine does not slow it. The growth is the slope of log time over log frames from 100 to
10 000 frames: 1 is linear.
"""

import argparse
import json
import time
from pathlib import Path

import numpy as np

from camera_rigs import Lens, Obstacle, SubjectTrack, World, direct

FPS = 30.0
LENGTHS = (100, 300, 1000, 3000, 10000)
LENS = Lens.from_millimetres(35.0, 1280, 720)
OPEN = World()
ROOM = World(
    obstacles=tuple(
        Obstacle((4.0 * np.cos(a), 4.0 * np.sin(a), 0.9), (0.4, 0.4, 1.8), name="column")
        for a in np.arange(0.0, 2.0 * np.pi, np.pi / 10.0)
    ),
    bounds=((-9.0, -9.0, 0.0), (9.0, 9.0, 4.0)),
)


def dancers(people: int, frames: int) -> SubjectTrack:
    """People who sway and turn around a spot each, 1.2 m apart."""
    clock = np.arange(frames) / FPS
    arrays = []
    for index in range(people):
        angle = 2.0 * np.pi * index / people
        radius = 0.6 / np.sin(np.pi / people) if people > 1 else 0.0
        sway = 0.25 * np.stack([np.sin(2.5 * clock + index), np.sin(1.9 * clock)], axis=1)
        spot = radius * np.array([np.cos(angle), np.sin(angle)]) + sway
        pelvis = np.column_stack([spot, 0.95 + 0.04 * np.sin(6.0 * clock)])
        facing = angle + 0.7 * np.sin(0.6 * clock)
        arrays.append(
            (
                pelvis,
                pelvis + np.array([0.0, 0.0, 0.5]),
                np.column_stack([np.cos(facing), np.sin(facing), np.zeros(frames)]),
                pelvis - np.array([0.35, 0.35, 0.95]),
                pelvis + np.array([0.35, 0.35, 0.8]),
            )
        )
    return SubjectTrack.from_people(*(np.stack(array) for array in zip(*arrays, strict=True)), FPS)


def seconds(people: int, frames: int, world: World, repeats: int) -> float:
    """The best time of `repeats` plans, each of a fresh subject: nothing is cached from the one before."""
    best = np.inf
    for seed in range(repeats):
        subject, rng = dancers(people, frames), np.random.default_rng(seed)
        start = time.process_time()
        plan = direct(subject, LENS, world, "auto", rng)
        best = min(best, time.process_time() - start)
        if not plan.ok:
            raise SystemExit(f"plan {seed} of {people} people, {frames} frames: {plan.findings[0].message}")
    return best


def main() -> None:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--json", type=Path)
    options = parser.parse_args()
    rows = []
    print(
        f"{'people':>6} {'world':>11} "
        + " ".join(f"{n:>9}" for n in LENGTHS)
        + "   growth   (frames per second)"
    )
    for people in (1, 2, 6):
        for name, world in (("open", OPEN), ("20 columns", ROOM)):
            times = [seconds(people, frames, world, options.repeats) for frames in LENGTHS]
            growth = float(np.polyfit(np.log(LENGTHS), np.log(times), 1)[0])
            rate = [frames / t for frames, t in zip(LENGTHS, times, strict=True)]
            print(f"{people:>6} {name:>11} " + " ".join(f"{r:>9.0f}" for r in rate) + f"   {growth:>6.2f}")
            rows.append(
                {"people": people, "world": name, "frames": LENGTHS, "seconds": times, "growth": growth}
            )
    if options.json:
        options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
