"""A contact sheet of stages, and how good they are to film on.

::

    python -m tools.stage_sheet --out docs/images/stages.jpg --measure

Every picture is a take drawn from a seed as ``whacamole render`` draws it, with one person, seen by the first
of two cameras that stand six degrees apart on an arc. ``--measure`` holds the two pictures of each stage
together (needs OpenCV): ORB features outside the person, those matched that fit one essential matrix, the
error of its turn and direction of travel against the true ones; and the mean linear luminance of the face
(white is 1).
"""

import argparse
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw

from camera_rigs import CameraPath, look_at
from render_jobs import RenderJob, quality_preset, run_job
from render_jobs.colour import linear_image
from whacamole.body import JOINT_INDEX, BodyModel, facing
from whacamole.motion import Motion, embedded_motions, find_motions, read_motion
from whacamole.stage import STAGES, Places
from whacamole.take import Take, stage_take

MOTIONS = ("walk", "dance_a", "walk_turn", "dance_b")
ARC_DEG = 6.0
DISTANCE_M = 4.2
HEIGHT_M = 1.5
FACE_M = 0.075
"""Half the edge of the square around the face."""

Floats = NDArray[np.float64]
Pixels = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class View:
    """Two pictures of a stage.

    Attributes:
        name: of the stage.
        camera: the two cameras.
        rgb: two pictures (H, W, 3).
        person: two masks (H, W).
        face: (2, 2) middle of the face in the pictures [px], and its half edge [px].
    """

    name: str
    camera: CameraPath
    rgb: list[Pixels]
    person: list[NDArray[np.bool_]]
    face: Floats
    face_half: float

    def face_luminance(self) -> float:
        """Mean linear luminance of the person's pixels around the face in the first picture, white is 1."""
        height, width = self.person[0].shape
        y, x = np.mgrid[0:height, 0:width] + 0.5
        near = (np.abs(x - self.face[0, 0]) < self.face_half) & (np.abs(y - self.face[0, 1]) < self.face_half)
        pixels = self.rgb[0][near & self.person[0]]
        return (
            float((linear_image(pixels) @ [0.2126, 0.7152, 0.0722]).mean()) if len(pixels) else float("nan")
        )


def arc(take: Take, size: tuple[int, int], rng: np.random.Generator) -> CameraPath:
    """Two cameras before the person's face, where nothing is in the way."""
    joints = take.performers[0].posed.joints[1]
    middle = joints[JOINT_INDEX["pelvis"]] + [0.0, 0.0, 0.15]
    ahead = facing(take.performers[0].posed.joints)[1]
    front = float(np.arctan2(ahead[1], ahead[0]))
    tries = front + np.radians([0, 20, -20, 40, -40, 60, -60, 90, -90]) + rng.uniform(-0.2, 0.2)
    for azimuth in tries:
        angles = azimuth + np.radians([-ARC_DEG / 2, ARC_DEG / 2])
        eye = middle + DISTANCE_M * np.stack([np.cos(angles), np.sin(angles), np.zeros(2)], axis=1)
        eye[:, 2] = HEIGHT_M
        world = take.stage.world
        clear = min(float(world.obstacle_distance(eye).min()), float(world.wall_distance(eye).min()))
        if clear > 0.4 and not world.hides(eye, np.broadcast_to(middle, eye.shape)).any():
            break
    width, height = size
    K = np.array([[0.78 * width, 0, width / 2], [0, 0.78 * width, height / 2], [0, 0, 1.0]])
    return CameraPath(np.stack([K, K]), look_at(eye, np.stack([middle, middle])), 30.0, width, height)


def render_view(name: str, seed: int, motion: Motion, options: argparse.Namespace, scratch: Path) -> View:
    """Draw a take on the stage and render both pictures, the person as in the first frame."""
    take = stage_take(
        motion, BodyModel.embedded(), frames=2, seed=seed, shot_index=0,
        textures=scratch / "textures", places=Places(names=(name,)),
    )  # fmt: skip
    width, height = (int(side) for side in options.size.split("x"))
    camera = arc(take, (width, height), np.random.default_rng(seed))
    job = RenderJob(
        camera=camera,
        meshes=take.stage.meshes + take.performers[0].meshes,
        lights=take.stage.lights,
        environment=take.stage.environment,
        exposure=take.stage.exposure,
        quality=quality_preset(options.quality),
        passes=("rgb", "mask"),
        image_format="png",
        seed=seed,
    )
    job.save(scratch / "job")
    run_job(scratch / "job", engine=options.engine, device=options.device)
    out = scratch / "job" / "out"
    rgb = [np.asarray(Image.open(out / "rgb" / f"{frame:06d}.png").convert("RGB")) for frame in range(2)]
    mask = [np.asarray(Image.open(out / "mask" / f"{frame:06d}.png")) > 0 for frame in range(2)]
    parts = ("left_eye", "right_eye", "jaw")
    joints = take.performers[0].posed.joints[1:3]
    face = joints[:, [JOINT_INDEX[part] for part in parts]].mean(axis=1)
    seen = np.einsum("tij,tj->ti", np.linalg.inv(camera.T_world_camera)[:, :3, :3],
                     face - camera.T_world_camera[:, :3, 3])  # fmt: skip
    pixel = np.einsum("tij,tj->ti", camera.K, seen)
    half = FACE_M * camera.K[0, 0, 0] / seen[0, 2]
    return View(name, camera, rgb, mask, pixel[:, :2] / pixel[:, 2:], float(half))


@dataclass(frozen=True)
class Odometry:
    """What two pictures give: features in the first, matches that fit, errors of turn and travel [°]."""

    features: int
    inliers: int
    turn_error: float
    travel_error: float


def odometry(view: View) -> Odometry:
    """Recover the motion between the two cameras from the surroundings alone."""
    import cv2

    detector: Any = cv2.ORB_create(nfeatures=2000, fastThreshold=10)  # type: ignore[attr-defined]
    found = []
    for rgb, person in zip(view.rgb, view.person, strict=True):
        grey = cv2.cvtColor(rgb, cv2.COLOR_RGB2GRAY)
        found.append(detector.detectAndCompute(grey, (~person).astype(np.uint8) * 255))
    (first, left), (second, right) = found
    features = len(first)
    if left is None or right is None:
        return Odometry(features, 0, 180.0, 180.0)
    matches = cv2.BFMatcher(cv2.NORM_HAMMING, crossCheck=True).match(left, right)
    if len(matches) < 8:
        return Odometry(features, 0, 180.0, 180.0)
    a = np.array([first[match.queryIdx].pt for match in matches])
    b = np.array([second[match.trainIdx].pt for match in matches])
    K = view.camera.K[0]
    cv2.setRNGSeed(0)
    essential, kept = cv2.findEssentialMat(a, b, K, cv2.RANSAC, 0.999, 1.0)
    if essential is None or essential.shape != (3, 3):
        return Odometry(features, 0, 180.0, 180.0)
    count, R, t, _ = cv2.recoverPose(essential, a, b, K, mask=kept)
    truth = np.linalg.inv(view.camera.T_world_camera[1]) @ view.camera.T_world_camera[0]
    turn = np.degrees(np.arccos(np.clip((np.trace(R.T @ truth[:3, :3]) - 1) / 2, -1, 1)))
    travel = truth[:3, 3] / np.linalg.norm(truth[:3, 3])
    angle = np.degrees(np.arccos(np.clip(float(t[:, 0] @ travel), -1, 1)))
    return Odometry(features, int(count), float(turn), float(angle))


def sheet(views: list[View], columns: int) -> Image.Image:
    """All first pictures side by side, with the stages' names."""
    height, width = views[0].rgb[0].shape[:2]
    rows = -(-len(views) // columns)
    picture = Image.new("RGB", (columns * (width + 3) - 3, rows * (height + 3) - 3), "white")
    for index, view in enumerate(views):
        cell = Image.fromarray(view.rgb[0])
        ImageDraw.Draw(cell).text((5, 3), view.name, fill="white", stroke_width=1, stroke_fill="black")
        picture.paste(cell, (index % columns * (width + 3), index // columns * (height + 3)))
    return picture


def main() -> None:
    """Render, measure, and put the sheet together."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--count", type=int, default=24)
    parser.add_argument("--columns", type=int, default=4)
    parser.add_argument("--seed", type=int, default=0, help="the first stage's; the others follow")
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--quality", default="draft")
    parser.add_argument("--engine", choices=("cycles", "raster"), default="cycles")
    parser.add_argument("--device", default="auto")
    parser.add_argument("--measure", action="store_true")
    options = parser.parse_args()
    motions = {file.id: file for file in find_motions(embedded_motions())}
    names, views = tuple(STAGES), []
    if options.measure:
        print("| stage | seed | features | inliers | turn error | travel error | face |")
        print("|---|---|---|---|---|---|---|")
    for index in range(options.count):
        name, seed = names[index % len(names)], options.seed + index
        motion = read_motion(motions[MOTIONS[index % len(MOTIONS)]])
        with tempfile.TemporaryDirectory() as folder:
            views.append(render_view(name, seed, motion, options, Path(folder)))
        if options.measure:
            found = odometry(views[-1])
            print(
                f"| {name} | {seed} | {found.features} | {found.inliers} | {found.turn_error:.2f}° | "
                f"{found.travel_error:.1f}° | {views[-1].face_luminance():.3f} |", flush=True
            )  # fmt: skip
        options.out.parent.mkdir(parents=True, exist_ok=True)
        sheet(views, options.columns).save(options.out, quality=86)
    print(options.out)


if __name__ == "__main__":
    main()
