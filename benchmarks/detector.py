"""Does a detector trained on photographs take our people for people? ``python benchmarks/detector.py``.

Renders a few frames on every stage as ``whacamole render`` does, and shows them, one by one, to MediaPipe's
pose detector (BlazePose full, the largest model in the PyPI wheel; ``pip install whacamole[video]``). Of
the people of whom more than 0.8 can be seen it counts how many are found, and how many of their shoulders,
hips, knees and ankles lie within 0.2 torso lengths of our labels; by stage, skin, motion. Failures are kept
as pictures in ``OUT/failures``. Finished sequences are not rendered again.
"""

from __future__ import annotations

import argparse
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from whacamole.baseline.estimators.blazepose import BlazePose, Reading
from whacamole.body import JOINT_INDEX
from whacamole.dataset import open_dataset
from whacamole.motion import embedded_motions
from whacamole.production.means import Limits, Means
from whacamole.production.run import produce
from whacamole.production.sequence import take_of
from whacamole.production.worklist import SequenceOrder
from whacamole.recipe import Recipe
from whacamole.stage import STAGES

MOTIONS: Final = ("walk", "walk_turn", "run", "dance_a", "punch", "jump")
"""People on their feet; how upright they must be to be found is a matter of the detector, not of looks."""

SEEN: Final = 0.8
NEAR: Final = 0.2
SAME_PERSON: Final = 0.3
"""Intersection over union of the boxes round the eight points, label against detector."""

LANDMARKS: Final = {
    "left_shoulder": 11, "right_shoulder": 12, "left_hip": 23, "right_hip": 24,
    "left_knee": 25, "right_knee": 26, "left_ankle": 27, "right_ankle": 28,
}  # fmt: skip
SKINS: Final = ((0.33, "light"), (0.66, "medium"), (1.01, "dark"))

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Shown:
    """One person in one frame: which group, whether found, which of the eight points are near."""

    stage: str
    skin: str
    motion: str
    found: bool
    error: tuple[float, ...]


def orders(options: argparse.Namespace) -> Iterator[tuple[str, SequenceOrder]]:
    """Renders what is missing and yields every sequence with its stage."""
    for motion in options.motions:
        for number, stage in enumerate(STAGES):
            if stage not in options.stages:
                continue
            recipe = Recipe(
                motions=embedded_motions() / f"{motion}.npz", stages=(stage,), frames=options.frames,
                shots_per_motion=options.shots_per_motion, seed=number, size=options.size,
                quality=options.quality, allow_breaches=True,
            )  # fmt: skip
            root = options.out / stage / motion
            made = produce(recipe, root, Means(limits=Limits(device=options.device)), quiet=True)
            done = made.worklist
            yield from ((stage, order) for order in done.orders if order.sequence_id in done.finished)


def show(order: SequenceOrder, stage: str, pose: BlazePose, failures: Path) -> Iterator[Shown]:
    """The people of a sequence that can be seen well enough, as the detector finds them."""
    take = take_of(order, textures=None)
    sequence = open_dataset(order.root)[order.sequence_id]
    people, camera = sequence.people, sequence.camera
    joints = [JOINT_INDEX[name] for name in LANDMARKS]
    for frame in range(len(camera["K"])):
        image = sequence.rgb(frame)
        readings = [r for region in pose.find(image) if (r := pose.read(image, region)) is not None]
        for number, performer in enumerate(take.performers):
            if people["visible_fraction"][number, frame] <= SEEN:
                continue
            labels = people["joints_image"][number, frame, joints].astype(np.float64)
            torso = torso_pixels(people["joints_camera"][number, frame], camera["K"][frame])
            reading = same_person(labels, readings)
            error: tuple[float, ...] = ()
            if reading is not None:
                points = reading.pixels[list(LANDMARKS.values())]
                inside = people["joint_visibility"][number, frame, joints] > 0
                error = tuple(np.linalg.norm(points - labels, axis=1)[inside] / torso)
            tone = performer.role.member.tone
            skin = next(name for limit, name in SKINS if tone < limit)
            if reading is None or any(e > NEAR for e in error):
                name = f"{stage}-{order.sequence_id}-{frame}-{'off' if reading else 'missed'}.png"
                picture(image, labels, reading, failures / name)
            yield Shown(stage, skin, take.motion.id, reading is not None, error)


def torso_pixels(joints: Floats, K: Floats) -> float:
    """Middle of the shoulders to middle of the hips [px], were they seen face on."""
    shoulders, hips = (
        joints[[JOINT_INDEX[f"{side}_{part}"] for side in ("left", "right")]].mean(axis=0)
        for part in ("shoulder", "hip")
    )
    return float(np.linalg.norm(shoulders - hips) * K[0, 0] / ((shoulders + hips)[2] / 2))


def same_person(labels: Floats, readings: list[Reading]) -> Reading | None:
    """The reading whose box of points overlaps that of the labels most, if it does so enough."""

    def overlap(reading: Reading) -> float:
        points = reading.pixels[list(LANDMARKS.values())]
        low = np.maximum(points.min(axis=0), labels.min(axis=0))
        high = np.minimum(points.max(axis=0), labels.max(axis=0))
        common = float(np.prod(np.clip(high - low, 0, None)))
        return common / (float(np.prod(np.ptp(points, axis=0)) + np.prod(np.ptp(labels, axis=0))) - common)

    best = max(readings, key=overlap, default=None)
    return best if best is not None and overlap(best) >= SAME_PERSON else None


def picture(image: NDArray[np.uint8], labels: Floats, reading: Reading | None, path: Path) -> None:
    """The frame with the labels in green and what was found in red."""
    drawn = Image.fromarray(image)
    pen = ImageDraw.Draw(drawn)
    found = [] if reading is None else list(reading.pixels[list(LANDMARKS.values())])
    for points, colour in ((labels, (0, 255, 0)), (found, (255, 0, 0))):
        for x, y in points:
            pen.ellipse((x - 2, y - 2, x + 2, y + 2), fill=colour)
    path.parent.mkdir(parents=True, exist_ok=True)
    drawn.save(path)


def table(shown: list[Shown]) -> None:
    """Prints shares by group."""
    print("| group | people | found % | points near % | median error, torsos |\n|---|---|---|---|---|")
    groups: dict[str, list[Shown]] = defaultdict(list)
    for one in shown:
        for name in ("all", f"stage {one.stage}", f"skin {one.skin}", f"motion {one.motion}"):
            groups[name].append(one)
    for name, members in sorted(groups.items()):
        errors = np.array([e for one in members for e in one.error])
        found = 100 * np.mean([one.found for one in members])
        near, middle = (100 * np.mean(errors <= NEAR), np.median(errors)) if len(errors) else (np.nan, np.nan)
        print(f"| {name} | {len(members)} | {found:.1f} | {near:.1f} | {middle:.3f} |")


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=Path, default=Path("build/benchmarks/detector"))
    parser.add_argument("--stages", nargs="+", choices=STAGES, default=list(STAGES))
    parser.add_argument("--motions", nargs="+", default=list(MOTIONS))
    parser.add_argument("--shots-per-motion", type=int, default=1)
    parser.add_argument("--frames", type=int, default=2, help="frames a sequence")
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--quality", default="standard")
    parser.add_argument("--device", default="auto")
    options = parser.parse_args()
    shown: list[Shown] = []
    with BlazePose() as pose:
        for stage, order in orders(options):
            shown += show(order, stage, pose, options.out / "failures")
            print(
                f"{stage} {order.sequence_id}: {sum(one.found for one in shown)} of {len(shown)}", flush=True
            )
    table(shown)


if __name__ == "__main__":
    main()
