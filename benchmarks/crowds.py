"""Do people of a take go through each other, or through what stands about? Nothing is rendered.

::

    python -m benchmarks.crowds --takes 200

Takes of one to six people are drawn as ``whacamole render --people 1-6`` draws them, on every built-in stage
and on a furnished hall from a file. At every ``--step``-th frame the posed vertices of every body are held
against those of every other (nearest pair) and against what stands about; in the hall, against its solids as
they were made and not as the survey found them.
People captured together keep their distance as captured, so they are counted apart.
"""

import argparse
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from whacamole.body import BodyModel
from whacamole.motion import embedded_motions, find_motions, read_motion
from whacamole.stage import STAGES, Places, find_places
from whacamole.take import Take, stage_take

Vertices = NDArray[np.float32]

TOUCH = 0.01
"""Vertices of the body are about this far apart [m]: bodies nearer than this count as touching."""

FURNITURE = ((1.6, 0.8, 0.75), (0.4, 0.4, 3.0), (1.2, 0.4, 1.9), (2.0, 0.9, 0.8), (0.4, 0.4, 3.0))
HALL = (18.0, 14.0, 4.0)


@dataclass
class Tally:
    """What was found so far."""

    takes: int = 0
    people: list[int] = field(default_factory=list)
    asked: int = 0
    pairs: int = 0
    nearest: float = np.inf
    touching: list[str] = field(default_factory=list)
    captured: int = 0
    captured_touching: int = 0
    obstacle: float = np.inf
    inside: list[str] = field(default_factory=list)
    lowest: list[float] = field(default_factory=list)


def write_hall(path: Path) -> list[trimesh.Trimesh]:
    """A closed hall with furniture as a glTF file; returns what stands about, z up."""
    rng = np.random.default_rng(0)
    length, width, height = HALL
    solids = []
    for x, y, sx, sy in ((1, 0, 0.2, width), (-1, 0, 0.2, width), (0, 1, length, 0.2), (0, -1, length, 0.2)):
        solids.append(_box((sx, sy, height), (x * length / 2, y * width / 2, height / 2)))
    for size in FURNITURE:
        place = rng.uniform(-0.38, 0.38, 2) * [length, width]
        solids.append(_box(size, (place[0], place[1], size[2] / 2)))
    floor = _box((length, width, 0.1), (0.0, 0.0, -0.05))
    scene = trimesh.Scene({"floor": floor, **{f"solid-{i}": solid for i, solid in enumerate(solids)}})
    scene.apply_transform(trimesh.transformations.rotation_matrix(-np.pi / 2, [1, 0, 0]))
    scene.export(path)
    return solids


def _box(size: tuple[float, float, float], place: tuple[float, float, float]) -> trimesh.Trimesh:
    return trimesh.creation.box(size, trimesh.transformations.translation_matrix(place))


def inspect(take: Take, solids: list[trimesh.Trimesh], step: int, name: str, tally: Tally) -> None:
    """Hold every body of a take against the others and against what stands about."""
    performers = take.performers
    together = len(take.motion.people)
    for frame in range(0, take.num_frames + 2, step):
        bodies = [person.posed.vertices[frame] for person in performers]
        trees = [cKDTree(body) for body in bodies]
        for one in range(len(bodies)):
            for other in range(one):
                gap = float(trees[one].query(bodies[other])[0].min())
                if one < together and other < together:
                    tally.captured += 1
                    tally.captured_touching += gap < TOUCH
                    continue
                tally.pairs += 1
                tally.nearest = min(tally.nearest, gap)
                if gap < TOUCH:
                    tally.touching.append(f"{name} frame {frame}: {one} and {other}")
        points = np.concatenate(bodies).astype(float)
        gap = (
            _gap_to_solids(points, solids)
            if solids
            else float(take.stage.world.obstacle_distance(points).min())
        )
        tally.obstacle = min(tally.obstacle, gap)
        if gap < 0.0:
            tally.inside.append(f"{name} frame {frame}: {gap:.3f} m")
        tally.lowest += [float(body[:, 2].min()) for body in bodies]
    tally.takes += 1
    tally.people.append(len(performers))


def _gap_to_solids(points: NDArray[np.float64], solids: list[trimesh.Trimesh]) -> float:
    """Signed distance [m] of points from axis-aligned boxes, negative inside."""
    nearest = np.inf
    for solid in solids:
        low, high = solid.bounds
        outside = np.maximum(low - points, points - high)
        gap = np.linalg.norm(np.maximum(outside, 0.0), axis=1) + np.minimum(outside.max(axis=1), 0.0)
        nearest = min(nearest, float(gap.min()))
    return nearest


def main() -> int:
    """Draw takes, inspect them, print what was found; exit 1 where somebody goes through something."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--takes", type=int, default=200)
    parser.add_argument("--frames", type=int, default=90)
    parser.add_argument("--step", type=int, default=6)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    body = BodyModel.embedded()
    motions = [read_motion(file) for file in find_motions(embedded_motions())]
    singles = [motion for motion in motions if len(motion.people) == 1]
    rng = np.random.default_rng(options.seed)
    tally = Tally()
    with tempfile.TemporaryDirectory() as scratch:
        solids = write_hall(Path(scratch) / "hall.glb")
        hall = find_places((str(Path(scratch) / "hall.glb"),), None, Path(scratch) / "cache", tuple(STAGES))
        for index in range(options.takes):
            motion = motions[int(rng.integers(len(motions)))]
            wanted = int(rng.integers(1, 7))
            frames = min(options.frames, motion.num_frames - 2)
            fitting = [one for one in singles if one is not motion and one.num_frames >= frames + 2]
            count = min(max(wanted - len(motion.people), 0), len(fitting))
            chosen = rng.choice(len(fitting), count, replace=False) if count else []
            on_file = index % 10 == 9
            names = tuple(STAGES)
            places = hall if on_file else Places(names=(names[index % len(names)],))
            take = stage_take(
                motion, body, frames=frames, seed=options.seed + index, shot_index=0, textures=None,
                places=places, companions=[fitting[int(one)] for one in chosen],
            )  # fmt: skip
            tally.asked += len(motion.people) + count
            inspect(take, solids if on_file else [], options.step, f"take {index} ({take.stage.name})", tally)
            if index % 20 == 19:
                print(f"{index + 1} takes …", flush=True)
    return report(tally)


def report(tally: Tally) -> int:
    """Print the figures."""
    sizes = np.bincount(tally.people, minlength=7)[1:]
    print(f"takes {tally.takes}; of 1 … 6 people: {', '.join(map(str, sizes))}")
    print(f"people placed {sum(tally.people)} of {tally.asked}")
    print(f"pairs of unrelated people looked at {tally.pairs}, nearest {tally.nearest:.3f} m, "
          f"touching {len(tally.touching)}")  # fmt: skip
    print(f"pairs captured together {tally.captured}, touching as captured {tally.captured_touching}")
    print(f"nearest to an obstacle {tally.obstacle:.3f} m, inside one {len(tally.inside)}")
    low = np.quantile(tally.lowest, [0.05, 0.5, 0.95])
    print(f"lowest point of a body: {low[0]:.3f}, {low[1]:.3f}, {low[2]:.3f} m (5 %, median, 95 %)")
    for line in (*tally.touching[:10], *tally.inside[:10]):
        print(line)
    return int(bool(tally.touching or tally.inside))


if __name__ == "__main__":
    raise SystemExit(main())
