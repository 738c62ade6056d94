"""Draw the pictures of docs/cameras.md: each shot from above, from the side, and what its camera sees.

    python tools/camera_figures.py [OUT]

OUT is docs/images/cameras by default. Needs matplotlib; people and motions are those embedded in the package.
"""

import io
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from numpy.typing import NDArray
from PIL import Image

from camera_rigs import (
    SCALES,
    CameraPath,
    Lens,
    Obstacle,
    Plan,
    Shake,
    SubjectTrack,
    World,
    direct,
)
from camera_rigs.joins import spans_between
from camera_rigs.path import aimed_path
from camera_rigs.scene import Scene, Span, View
from camera_rigs.shake import shake_rand
from camera_rigs.shot import Draft
from camera_rigs.shots.arc import plan_arc
from camera_rigs.shots.boom import plan_boom
from camera_rigs.shots.dolly import plan_dolly
from camera_rigs.shots.dolly_zoom import plan_dolly_zoom
from camera_rigs.shots.follow import plan_follow
from camera_rigs.shots.orbit import plan_orbit
from camera_rigs.shots.over_shoulder import Shoulder, plan_over_shoulder, shoulder_place
from camera_rigs.shots.pan import plan_pan
from camera_rigs.shots.push_pull import plan_pull, plan_push, plan_push_pull
from camera_rigs.shots.static import plan_static
from camera_rigs.shots.tracking import plan_tracking
from whacamole.body import JOINT_INDEX, BodyModel, BodyParams, facing
from whacamole.motion import embedded_motions, find_motions, read_motion

Array = NDArray[np.float64]

ROOT = Path(__file__).resolve().parents[1]
LENS = Lens.from_millimetres(35.0, 640, 360)
FRAMES = 90
PALETTE = 128
COLOURS = {"people": "#8a8f98", "camera": "#1f5fb4", "keyframe": "#d1495b", "body": "#d9a27e"}


FACING = {"arrowstyle": "->", "color": "#50555c", "lw": 1.0, "shrinkA": 0, "shrinkB": 0}
"""The arrow of where a person faces at the first frame."""


@dataclass(frozen=True)
class Cast:
    """People of an embedded motion: what the camera films, and their meshes."""

    subject: SubjectTrack
    vertices: tuple[Array, ...]


@cache
def body() -> BodyModel:
    """The embedded body."""
    return BodyModel.embedded()


@cache
def cast(name: str, frames: int = FRAMES, first: int = 0) -> Cast:
    """The people of an embedded motion, the lowest vertex on the ground."""
    file = next(file for file in find_motions(embedded_motions()) if file.id == name)
    joints, vertices = [], []
    for person in read_motion(file).people:
        betas = np.zeros(10)
        posed = body().pose(
            BodyParams(
                betas=betas,
                expression=person.expression,
                global_orient=person.global_orient,
                transl=person.pelvis - body().rest_joints(betas)[0],
                body_pose=person.body_pose,
                left_hand_pose=person.left_hand_pose,
                right_hand_pose=person.right_hand_pose,
                jaw_pose=person.jaw_pose,
                leye_pose=person.leye_pose,
                reye_pose=person.reye_pose,
            )
        )
        joints.append(posed.joints[first : first + frames])
        vertices.append(posed.vertices[first : first + frames].astype(np.float64))
    floor = min(float(v[..., 2].min()) for v in vertices)
    for moved in (*joints, *vertices):
        moved[..., 2] -= floor
    subject = SubjectTrack.from_people(
        np.stack([j[:, JOINT_INDEX["pelvis"]] for j in joints]),
        np.stack([j[:, JOINT_INDEX["neck"]] for j in joints]),
        np.stack([facing(j) for j in joints]),
        np.stack([v.min(axis=1) for v in vertices]),
        np.stack([v.max(axis=1) for v in vertices]),
        30.0,
    )
    return Cast(subject, tuple(vertices))


def view(scene: Scene, scale: str, frac: float, theta: float, phi: float) -> View:
    """A view at angles in degrees that fills a fraction of the view at the first frame."""
    polar = float(np.radians(theta))
    r, _ = scene.framing(0, frac, polar, SCALES[scale], scene.lens.focal)
    return View(SCALES[scale], r, polar, float(np.radians(phi)), scene.lens.focal)


def over_shoulder(scene: Scene, span: Span) -> Draft:
    """Past the left shoulder of the first person."""
    shoulder = Shoulder(person=0, side=-1, behind=1.1, beside=0.6)
    place = shoulder_place(scene, shoulder, 0, 0)[0]
    start = View.from_location(scene, 0, place, SCALES["medium"], scene.lens.focal)
    return plan_over_shoulder(scene, span, start, shoulder=shoulder)


Planner = Callable[[Scene, Span], Draft]

SHOTS: dict[str, tuple[str, Planner]] = {
    "arc-horizontal": (
        "dance_b",
        lambda s, n: plan_arc(s, n, view(s, "full", 0.65, 82, -35), delta_phi=np.radians(70.0)),
    ),
    "arc-vertical": (
        "dance_b",
        lambda s, n: plan_arc(
            s, n, view(s, "full", 0.65, 97, 20), delta_theta=np.radians(-45.0), kind="arc-vertical"
        ),
    ),
    "push": ("dance_b", lambda s, n: plan_push(s, n, view(s, "full", 0.4, 86, 25), frac=0.8)),
    "pull": ("dance_b", lambda s, n: plan_pull(s, n, view(s, "full", 0.8, 86, 25), frac=0.4)),
    "push-pull": (
        "dance_b",
        lambda s, n: plan_push_pull(s, n, view(s, "full", 0.5, 86, 25), fracs=[0.8, 0.45]),
    ),
    "tracking": ("walk", lambda s, n: plan_tracking(s, n, view(s, "full", 0.6, 84, 70))),
    "pan": ("walk_turn", lambda s, n: plan_pan(s, n, view(s, "full", 0.5, 88, 60))),
    "static": ("walk_turn", lambda s, n: plan_static(s, n, view(s, "long", 0.3, 80, 60))),
    "orbit": (
        "dance_b",
        lambda s, n: plan_orbit(s, n, view(s, "full", 0.65, 78, 0), angle=np.radians(180.0)),
    ),
    "boom": ("dance_b", lambda s, n: plan_boom(s, n, view(s, "full", 0.6, 95, 20), height=1.8)),
    "dolly": (
        "walk",
        lambda s, n: plan_dolly(s, n, view(s, "full", 0.5, 86, 60), azimuth=np.pi / 2.0, distance=2.9),
    ),
    "dolly-zoom": ("dance_b", lambda s, n: plan_dolly_zoom(s, n, view(s, "full", 0.7, 86, 15), radius=6.0)),
    "follow": ("walk_turn", lambda s, n: plan_follow(s, n, view(s, "full", 0.6, 78, 150))),
    "over-shoulder": ("duet", over_shoulder),
}
"""Every shot, with the motion it is drawn on and a planner with plain arguments."""


def shot_path(name: str) -> tuple[Cast, Draft, CameraPath]:
    """A shot of `SHOTS` over the whole clip."""
    motion, planner = SHOTS[name]
    people = cast(motion)
    scene = Scene(people.subject, LENS)
    draft = planner(scene, spans_between([0, people.subject.num_frames - 1], 30.0)[0])
    move = draft.move
    path = aimed_path(move.eye, move.target, move.focal, move.roll, LENS, 30.0)
    return people, draft, path


def draw_map(ax: Axes, subject: SubjectTrack, path: CameraPath, marks: Array, axes: tuple[int, int]) -> None:
    """Paths of people and camera on two world axes, a view cone at every marked frame."""
    for person in subject.people_pelvis:
        ax.plot(*person[:, axes].T, color=COLOURS["people"], lw=2.5, solid_capstyle="round")
        ax.plot(*person[0, axes], "o", color=COLOURS["people"], ms=5)
    if axes[1] != 2:
        for here, way in zip(subject.people_pelvis[:, 0], subject.people_facing[:, 0], strict=True):
            ax.annotate("", here[:2] + 0.8 * way[:2], here[:2], arrowprops=FACING)
    ax.plot(*path.location[:, axes].T, color=COLOURS["camera"], lw=1.6)
    for frame in marks:
        cone(ax, path, int(frame), axes)
    if axes[1] == 2:
        ax.axhline(0.0, color="#444444", lw=0.8)
    ax.set_aspect("equal", adjustable="datalim")
    ax.tick_params(labelsize=6, length=2, pad=1)
    ax.set_xlabel("xyz"[axes[0]] + " [m]", fontsize=6, labelpad=1)
    ax.set_ylabel("xyz"[axes[1]] + " [m]", fontsize=6, labelpad=1)
    ax.margins(0.12)


def cone(ax: Axes, path: CameraPath, frame: int, axes: tuple[int, int], colour: str | None = None) -> None:
    """The view cone of a camera, 0.7 m long, on two world axes."""
    eye, R = path.location[frame], path.T_world_camera[frame, :3, :3]
    half = np.array([path.width, path.height]) / (2.0 * path.focal[frame])
    edge = 0 if axes[1] != 2 else 1
    side = R[:, edge] * half[edge]
    tips = np.stack([eye + 0.7 * (R[:, 2] + side), eye, eye + 0.7 * (R[:, 2] - side)])
    ax.plot(*tips[:, axes].T, color=colour or COLOURS["keyframe"], lw=1.0)


def draw_view(ax: Axes, people: Cast, path: CameraPath, frame: int) -> None:
    """What the camera sees: the people's meshes, shaded, on a ground grid."""
    draw_ground(ax, path, frame)
    one = CameraPath(path.K[[frame]], path.T_world_camera[[frame]], path.fps, path.width, path.height)
    faces = body().faces
    polygons, shades, depths = [], [], []
    for vertices in people.vertices:
        points = vertices[frame]
        pixels, depth = one.project(points[None])
        corners = points[faces]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normal /= np.linalg.norm(normal, axis=1, keepdims=True) + 1e-12
        towards = one.location[0] - corners.mean(axis=1)
        seen = (np.einsum("fi,fi->f", normal, towards) > 0.0) & (depth[0][faces] > 0.1).all(axis=1)
        polygons.append(pixels[0][faces][seen])
        light = towards[seen] / np.linalg.norm(towards[seen], axis=1, keepdims=True) + [0.0, 0.0, 0.8]
        shades.append(0.3 + 0.7 * np.clip(np.einsum("fi,fi->f", normal[seen], light) / 1.6, 0.0, 1.0))
        depths.append(depth[0][faces].mean(axis=1)[seen])
    order = np.argsort(-np.concatenate(depths))
    colour = np.array(mpl.colors.to_rgb(COLOURS["body"]))
    tint = np.concatenate(shades)[order, None] * colour
    ax.add_collection(
        PolyCollection(list(np.concatenate(polygons)[order]), facecolors=tint, edgecolors=tint, lw=0.3)
    )
    ax.set(xlim=(0, path.width), ylim=(path.height, 0), xticks=[], yticks=[], aspect="equal")
    ax.set_facecolor("#eef1f4")
    ax.set_title(f"frame {frame}", fontsize=6, pad=2)


def draw_ground(ax: Axes, path: CameraPath, frame: int) -> None:
    """Grid lines of the ground, a metre apart, as the camera sees them."""
    near = np.round(path.location[frame, :2])
    steps = np.arange(-12.0, 13.0)
    fine = np.linspace(-12.0, 12.0, 120)
    for step in steps:
        for line in ((near[0] + step, near[1] + fine), (near[0] + fine, near[1] + step)):
            x, y = np.broadcast_arrays(*line)
            points = np.stack([x, y, np.zeros_like(x)], axis=-1)
            one = CameraPath(path.K[[frame]], path.T_world_camera[[frame]], path.fps, path.width, path.height)
            pixels, depth = one.project(points[None])
            pixels[0][depth[0] < 0.3] = np.nan
            ax.plot(*pixels[0].T, color="#c3cad1", lw=0.5, zorder=0)


def shot_figure(name: str) -> plt.Figure:
    """Maps and three views of one shot."""
    people, draft, path = shot_path(name)
    marks = np.unique([round(k.frame) for k in draft.shot.keyframes])
    figure, axes = plt.subplots(1, 5, figsize=(9.6, 1.6), width_ratios=(1.2, 1.2, 1.5, 1.5, 1.5), dpi=100)
    draw_map(axes[0], people.subject, path, marks, (0, 1))
    spread = np.ptp(path.location, axis=0) + np.abs(path.location.mean(0) - people.subject.pelvis.mean(0))
    draw_map(axes[1], people.subject, path, marks, (int(np.argmax(spread[:2])), 2))
    for ax, frame in zip(axes[2:], (0, path.num_frames // 2, path.num_frames - 1), strict=True):
        draw_view(ax, people, path, frame)
    figure.subplots_adjust(0.035, 0.17, 0.995, 0.9, wspace=0.16)
    return figure


def shake_figure() -> plt.Figure:
    """Displacement and rotation of a hand-held camera over time, and their spectrum."""
    shake, fps = Shake(), 30.0
    moved, turned = shake_rand(np.random.default_rng(0), shake, 1800, fps)
    figure, axes = plt.subplots(1, 3, figsize=(9.6, 1.75), dpi=100)
    time = np.arange(150) / fps
    axes[0].plot(time, moved[:150] * 1000.0, lw=1.0)
    axes[0].set_ylabel("displacement [mm]", fontsize=6)
    axes[1].plot(time, np.degrees(turned[:150]), lw=1.0)
    axes[1].set_ylabel("rotation [°]", fontsize=6)
    power = np.abs(np.fft.rfft(moved * np.hanning(len(moved))[:, None], axis=0)) ** 2
    axes[2].semilogy(np.fft.rfftfreq(len(moved), 1.0 / fps), power / power.max(), lw=0.8)
    axes[2].axvspan(shake.low, shake.high, color="#dde6f0", zorder=0)
    axes[2].set(xlim=(0, 6), ylim=(1e-8, 2))
    axes[2].set_ylabel("power", fontsize=6)
    for ax, unit in zip(axes, ("s", "s", "Hz"), strict=True):
        ax.set_xlabel(unit, fontsize=6, labelpad=1)
        ax.tick_params(labelsize=6, length=2, pad=1)
    figure.subplots_adjust(0.05, 0.17, 0.995, 0.95, wspace=0.2)
    return figure


ROOM = World(
    obstacles=(
        Obstacle((2.0, 1.6, 0.9), (0.5, 0.5, 1.8), name="column"),
        Obstacle((-1.8, 1.2, 0.5), (1.6, 0.8, 1.0), 0.4, name="sofa"),
    ),
    bounds=((-4.0, -4.0, 0.0), (4.0, 4.0, 3.0)),
)

CLIPS: tuple[tuple[str, str, World, int], ...] = (
    ("dance_b", "a dance: arcs, push and pull", World(), 3),
    ("dance_b", "the same in a room", ROOM, 3),
    ("walk_turn", "a walk with a turn: tracking, pan", World(), 1),
)


def director_figure() -> plt.Figure:
    """Three directed clips from above, shots coloured, and the elevation of the camera over time."""
    figure, axes = plt.subplots(2, 3, figsize=(9.6, 4.2), height_ratios=(3.0, 1.0), dpi=100)
    for column, (name, title, world, seed) in enumerate(CLIPS):
        people = cast(name, 240)
        plan = direct(people.subject, LENS, world, "auto", np.random.default_rng(seed))
        draw_plan(axes[0, column], plan, world)
        draw_elevation(axes[1, column], plan)
        axes[0, column].set_title(title, fontsize=7, pad=3)
    figure.subplots_adjust(0.04, 0.08, 0.995, 0.95, wspace=0.14, hspace=0.24)
    return figure


def draw_plan(ax: Axes, plan: Plan, world: World) -> None:
    """A plan from above: room, obstacles, people, and the camera coloured by shot."""
    for obstacle in world.obstacles:
        corners = 0.5 * np.array(obstacle.size[:2]) * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
        cos, sin = np.cos(obstacle.yaw), np.sin(obstacle.yaw)
        turned = corners @ np.array([[cos, sin], [-sin, cos]]) + np.array(obstacle.center[:2])
        ax.fill(*turned.T, color="#b9a894")
    if world.bounds is not None:
        (x0, y0, _), (x1, y1, _) = world.bounds
        ax.plot([x0, x1, x1, x0, x0], [y0, y0, y1, y1, y0], color="#6b5b4b", lw=1.2)
    ax.plot(*plan.subject.pelvis[:, :2].T, color=COLOURS["people"], lw=2.5)
    for index, shot in enumerate(plan.shots):
        colour = f"C{index}"
        part = plan.path.location[shot.start : shot.end + 1]
        ax.plot(*part[:, :2].T, color=colour, lw=1.8, label=shot.kind)
        for k in shot.keyframes:
            cone(ax, plan.path, round(k.frame), (0, 1), colour)
    ax.legend(fontsize=5.5, frameon=False, handlelength=1.2, borderpad=0.1, loc="best")
    ax.set_aspect("equal", adjustable="datalim")
    ax.tick_params(labelsize=6, length=2, pad=1)
    ax.margins(0.12)


def draw_elevation(ax: Axes, plan: Plan) -> None:
    """How far the camera looks down over time, shot by shot."""
    down = np.degrees(-np.arcsin(plan.path.forward[:, 2]))
    for index, shot in enumerate(plan.shots):
        part = slice(shot.start, shot.end + 1)
        ax.plot(np.arange(shot.start, shot.end + 1) / plan.path.fps, down[part], color=f"C{index}", lw=1.5)
    ax.axhline(0.0, color="#b0b0b0", lw=0.6)
    ax.set_ylabel("looks down [°]", fontsize=6, labelpad=1)
    ax.set_xlabel("s", fontsize=6, labelpad=1)
    ax.tick_params(labelsize=6, length=2, pad=1)


def save(figure: plt.Figure, file: Path) -> None:
    """Write a figure as a PNG of `PALETTE` colours: small, and the same for equal input."""
    stream = io.BytesIO()
    figure.savefig(stream, format="png")
    plt.close(figure)
    picture = Image.open(stream).convert("RGB").quantize(PALETTE, dither=Image.Dither.NONE)
    picture.save(file, optimize=True)


def main() -> None:
    """Draw all pictures."""
    out = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "images" / "cameras"
    out.mkdir(parents=True, exist_ok=True)
    mpl.use("Agg")
    for name in SHOTS:
        save(shot_figure(name), out / f"{name}.png")
    save(shake_figure(), out / "handheld.png")
    save(director_figure(), out / "director.png")
    for file in sorted(out.glob("*.png")):
        print(f"{file.name}: {file.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
