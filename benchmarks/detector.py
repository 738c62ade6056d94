"""Does a detector trained on photographs take our people for people? ``python benchmarks/detector.py``.

Renders a few frames on every stage as ``whacamole render`` does, and shows them, one by one, to MediaPipe's
pose detector (BlazePose full, the largest model in the PyPI wheel; ``pip install whacamole[video]``). Of
the people of whom more than 0.8 can be seen it counts how many are found, and how many of their shoulders,
hips, knees and ankles lie within 0.2 torso lengths of our labels; by stage, skin, motion, framing, view,
height of the camera, trunk. PDJ is the same count by the torso of DeepPose, left shoulder to right hip. As
MediaPipe does from frame to frame, a person is read again in the region that was read, until it settles.
Failures are kept as pictures in ``OUT/failures``. Finished sequences are not rendered again.
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

from whacamole.baseline.estimators.blazepose import BlazePose, Reading, Region
from whacamole.body import JOINT_INDEX, facing
from whacamole.dataset import open_dataset
from whacamole.motion import embedded_motions
from whacamole.production.means import Limits, Means
from whacamole.production.run import produce
from whacamole.production.sequence import take_of
from whacamole.production.worklist import SequenceOrder
from whacamole.recipe import Recipe
from whacamole.stage import STAGES

MOTIONS: Final = (
    "walk", "walk_turn", "run", "jump", "punch", "kick", "dance_a", "dance_b", "spin", "spinkick",
)  # fmt: skip
"""All embedded motions of one person on their feet: who crawls or tumbles is not asked for, and where two
stand close the detector, made for one person, reads one of them twice."""

SEEN: Final = 0.8
NEAR: Final = 0.2
LANDMARKS: Final = {
    "left_shoulder": 11, "right_shoulder": 12, "left_hip": 23, "right_hip": 24,
    "left_knee": 25, "right_knee": 26, "left_ankle": 27, "right_ankle": 28,
}  # fmt: skip
SKINS: Final = ((0.33, "light"), (0.66, "medium"), (1.01, "dark"))

SETTLED: Final = 0.02
"""A region that moves and grows by less, in its sides, has settled."""

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Shown:
    """One person in one frame.

    Attributes:
        groups: those this counts in, by kind.
        found: a detection is centred on the person.
        error: distances of the points in the image [torsos], infinite where none were read.
        longer: the torso from the left shoulder to the right hip [torsos].
        points: what each of them is, and whether it can be seen.
    """

    groups: dict[str, str]
    found: bool
    error: tuple[float, ...]
    longer: float
    points: tuple[tuple[str, str], ...]


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


def show(order: SequenceOrder, stage: str, pose: BlazePose, rereads: int, failures: Path) -> Iterator[Shown]:
    """The people of a sequence that can be seen well enough, as the detector finds them."""
    take = take_of(order, textures=None)
    sequence = open_dataset(order.root)[order.sequence_id]
    people, camera = sequence.people, sequence.camera
    joints = [JOINT_INDEX[name] for name in LANDMARKS]
    for frame in range(len(camera["K"])):
        image = sequence.rgb(frame)
        regions = pose.find(image)
        readings = [
            reading for region in regions if (reading := read(pose, image, region, rereads)) is not None
        ]
        for number, performer in enumerate(take.performers):
            visibility = people["joint_visibility"][number, frame, joints]
            inside = visibility > 0
            if people["visible_fraction"][number, frame] <= SEEN or not inside.any():
                continue
            labels = people["joints_image"][number, frame, joints].astype(np.float64)
            torso, longer = torso_pixels(people["joints_camera"][number, frame], camera["K"][frame])
            left, top, right, bottom = people["bbox_visible_xyxy"][number, frame]
            error = best_reading(labels, inside, readings) / torso
            found = bool(error.max() < np.inf) or any(
                left <= region.x <= right and top <= region.y <= bottom for region in regions
            )
            if (error > NEAR).any():
                name = f"{stage}-{order.sequence_id}-{frame}-{'off' if found else 'missed'}.png"
                picture(image, labels, readings, failures / name)
            tone = performer.role.member.tone
            groups = {
                "stage": stage,
                "skin": next(name for limit, name in SKINS if tone < limit),
                "motion": take.motion.id,
                "framing": framing(inside),
                **geometry(people["joints_world"][number, frame], camera["T_world_camera"][frame, :3, 3]),
            }
            points = tuple(
                (name.split("_")[1], "visible" if seen == 2 else "hidden")
                for name, seen in zip(LANDMARKS, visibility, strict=True)
                if seen > 0
            )
            yield Shown(groups, found, tuple(error) if found else (), longer / torso, points if found else ())


def read(pose: BlazePose, image: NDArray[np.uint8], region: Region, rereads: int) -> Reading | None:
    """The person in a region, read again at most ``rereads`` times until the region settles."""
    reading = pose.read(image, region)
    for _ in range(rereads if reading is not None else 0):
        assert reading is not None
        after = reading.next
        if after.apart(region) < SETTLED and abs(after.side / region.side - 1.0) < SETTLED:
            break
        again = pose.read(image, after)
        if again is None:
            break
        region, reading = after, again
    return reading


def framing(inside: NDArray[np.bool_]) -> str:
    """How much of a person is in the image: of shoulders, hips, knees and ankles."""
    if inside.all():
        return "whole in the image"
    return "hips and more" if inside[2:4].all() else "above the hips"


def geometry(joints: Floats, eye: Floats) -> dict[str, str]:
    """From where a person (55, 3) is seen by a camera at ``eye`` (3,), and how they hold themselves."""
    neck, pelvis = (joints[JOINT_INDEX[name]].astype(np.float64) for name in ("neck", "pelvis"))
    ahead, towards = facing(joints[None])[0], eye - neck
    aside = np.degrees(np.arccos(np.clip(ahead[:2] @ towards[:2] / np.linalg.norm(towards[:2]), -1.0, 1.0)))
    above = np.degrees(np.arcsin(towards[2] / np.linalg.norm(towards)))
    bent = np.degrees(np.arccos((neck - pelvis)[2] / np.linalg.norm(neck - pelvis)))
    return {
        "view": "front" if aside < 60.0 else "side" if aside < 120.0 else "back",
        "camera": "high" if above > 20.0 else "low" if above < -10.0 else "eye level",
        "trunk": "upright" if bent < 25.0 else "bent",
    }


def best_reading(labels: Floats, inside: NDArray[np.bool_], readings: list[Reading]) -> Floats:
    """Distances [px] of the points in the image to the reading that fits best; infinite without any."""
    points = [reading.pixels[list(LANDMARKS.values())] for reading in readings]
    errors = [np.linalg.norm(found - labels, axis=1)[inside] for found in points]
    nothing = np.full(int(inside.sum()), np.inf)
    return min(errors, key=lambda error: float(np.median(error)), default=nothing)


def torso_pixels(joints: Floats, K: Floats) -> tuple[float, float]:
    """Mid-shoulders to mid-hips, and left shoulder to right hip [px], were they face on."""
    at = {name: joints[JOINT_INDEX[name]].astype(np.float64) for name in list(LANDMARKS)[:4]}
    shoulders = (at["left_shoulder"] + at["right_shoulder"]) / 2.0
    hips = (at["left_hip"] + at["right_hip"]) / 2.0
    ends = ((shoulders, hips), (at["left_shoulder"], at["right_hip"]))
    length, diagonal = (float(np.linalg.norm(a - b) * K[0, 0] / ((a + b)[2] / 2.0)) for a, b in ends)
    return length, diagonal


def picture(image: NDArray[np.uint8], labels: Floats, readings: list[Reading], path: Path) -> None:
    """The frame with the labels in green and what was read in red."""
    drawn = Image.fromarray(image)
    pen = ImageDraw.Draw(drawn)
    read = [point for reading in readings for point in reading.pixels[list(LANDMARKS.values())]]
    for points, colour in ((labels, (0, 255, 0)), (read, (255, 0, 0))):
        for x, y in points:
            pen.ellipse((x - 2, y - 2, x + 2, y + 2), fill=colour)
    path.parent.mkdir(parents=True, exist_ok=True)
    drawn.save(path)


def table(shown: list[Shown]) -> None:
    """Prints shares by group."""
    print(
        "| group | people | found % | points | near % | PDJ % | median error, torsos |\n"
        "|---|---|---|---|---|---|---|"
    )
    groups: dict[str, list[Shown]] = defaultdict(list)
    for one in shown:
        for name in ("all", *(f"{kind} {value}" for kind, value in one.groups.items())):
            groups[name].append(one)
    for name, members in sorted(groups.items()):
        found = 100 * np.mean([one.found for one in members])
        errors = np.array([e for one in members for e in one.error])
        longer = np.array([one.longer for one in members for _ in one.error])
        near, pdj = (
            100 * np.mean(errors <= limit) if len(errors) else np.nan for limit in (NEAR, NEAR * longer)
        )
        middle = np.median(errors) if len(errors) else np.nan
        row = (name, str(len(members)), f"{found:.1f}", str(len(errors)), f"{near:.1f}", f"{pdj:.1f}")
        print("|", " | ".join((*row, f"{middle:.3f}")), "|")
    print("\n| points | number | near % |\n|---|---|---|")
    points: dict[str, list[bool]] = defaultdict(list)
    for one in shown:
        for error, kinds in zip(one.error, one.points, strict=True):
            for kind in kinds:
                points[kind].append(error <= NEAR)
    for kind, hits in sorted(points.items()):
        print(f"| {kind} | {len(hits)} | {100 * np.mean(hits):.1f} |")


def main() -> None:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=Path, default=Path("build/benchmarks/detector"))
    parser.add_argument("--stages", nargs="+", choices=STAGES, default=list(STAGES))
    parser.add_argument("--motions", nargs="+", default=list(MOTIONS))
    parser.add_argument("--shots-per-motion", type=int, default=1)
    parser.add_argument("--frames", type=int, default=1, help="frames a sequence")
    parser.add_argument("--rereads", type=int, default=4, help="times a person is read again at most")
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--quality", default="standard")
    parser.add_argument("--device", default="auto")
    options = parser.parse_args()
    shown: list[Shown] = []
    with BlazePose() as pose:
        for stage, order in orders(options):
            shown += show(order, stage, pose, options.rereads, options.out / "failures")
            print(
                f"{stage} {order.sequence_id}: {sum(one.found for one in shown)} of {len(shown)}", flush=True
            )
    table(shown)


if __name__ == "__main__":
    main()
