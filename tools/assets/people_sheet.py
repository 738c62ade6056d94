"""A contact sheet of the cast: ``python tools/assets/people_sheet.py --out docs/images/people.jpg``.

Every person comes from one seed and is caught in a moment of the motions that the package carries. With
``--faces`` the heads are seen closely; with ``--hard`` people take the poses of ``hard_poses.py``, a column
each.
"""

from __future__ import annotations

import argparse
import itertools
import shutil
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).parents[2]))
sys.path.insert(0, str(Path(__file__).parent))

from hard_poses import HARD_POSES, hard_pose, hard_root

from camera_rigs.path import CameraPath
from render_jobs import Environment, Mesh, Quality, RenderJob, Sun, run_job
from whacamole.body import JOINT_INDEX, BodyModel, BodyParams, facing
from whacamole.motion import Motion, embedded_motions, find_motions, read_motion
from whacamole.wardrobe import CastMember, cast, dress

CELL_M: Final = {"body": (1.15, 2.0), "hard": (1.15, 2.4), "face": (0.42, 0.46)}
"""Width and height of a person's place; in hard poses arms are raised."""

DISTANCE_M: Final = 40.0
"""The camera stands far off, so that all are seen from the same side."""

STANDING_SHARE: Final = 0.4
UPRIGHT: Final = np.array([np.pi / 2, 0.0, 0.0])
TURN_DEG: Final = 35.0
"""People look up to this far past the camera …"""

HARD_TURNS_DEG: Final = (35.0, 150.0, -60.0)
"""… and those in hard poses, row by row, by this much."""


def moments(rng: np.random.Generator, standing_share: float) -> Iterator[dict[str, NDArray[np.float64]]]:
    """Body poses ``(21, 3)`` and root orientations ``(3,)``: standing at ease, or one frame of a motion."""
    motions: list[Motion] = [read_motion(file) for file in find_motions(embedded_motions())]
    while True:
        pose = np.zeros((21, 3))
        orient = UPRIGHT
        if rng.random() < standing_share:
            for side, sign in (("left", -1.0), ("right", 1.0)):
                pose[JOINT_INDEX[f"{side}_shoulder"] - 1] = [0, 0.1 * sign, sign * rng.uniform(1.05, 1.2)]
                pose[JOINT_INDEX[f"{side}_elbow"] - 1] = [0, sign * rng.uniform(0.1, 0.4), 0]
        else:
            motion = motions[int(rng.integers(len(motions)))]
            person = motion.people[int(rng.integers(len(motion.people)))]
            frame = int(rng.integers(len(person.pelvis)))
            pose, orient = person.body_pose[frame], person.global_orient[frame]
        yield {"body_pose": pose, "global_orient_world": orient}


def hard_moments() -> Iterator[dict[str, NDArray[np.float64]]]:
    """One hard pose after another."""
    for name in itertools.cycle(HARD_POSES):
        yield {"body_pose": hard_pose(name), "global_orient_world": hard_root(name)}


def placed(
    body: BodyModel, member: CastMember, moment: dict[str, NDArray[np.float64]], turn: float
) -> BodyParams:
    """The member in a moment, facing −y up to ``turn`` radians, pelvis at the origin."""
    arrays = BodyParams.zeros(1, member.betas).to_arrays()
    arrays |= {key: value[None] for key, value in moment.items()}
    arrays |= {"left_hand_pose": member.left_hand[None], "right_hand_pose": member.right_hand[None]}
    params = BodyParams.from_arrays(arrays)
    ahead = facing(body.pose_joints(params))[0]
    angle = turn - np.pi / 2 - np.arctan2(ahead[1], ahead[0])
    rotation = np.eye(4)
    rotation[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    pelvis = body.rest_joints(member.betas)[0]
    params = params.transformed(rotation, pelvis)
    return replace(params, transl=params.transl - body.pose_joints(params)[:, 0])


def person_meshes(
    body: BodyModel,
    member: CastMember,
    params: BodyParams,
    cell: NDArray[np.float64],
    look: str,
    name: str,
    textures: Path,
) -> list[Mesh]:
    """One person in the middle of a cell, standing still."""
    posed = body.pose(params)
    if look == "face":
        middle = posed.joints[0, JOINT_INDEX["head"]] + [0, 0, 0.05]
    else:
        middle = (posed.vertices[0].min(axis=0) + posed.vertices[0].max(axis=0)) / 2
    params = replace(params, transl=params.transl + cell - middle)
    meshes = dress(member, body, params, textures=textures, name=name, subdivision=1)
    still = [replace(mesh, vertices=mesh.vertices[0]) for mesh in meshes]
    return [part for mesh in still if (part := _within(mesh, cell, look))] if look == "face" else still


def _within(mesh: Mesh, cell: NDArray[np.float64], look: str) -> Mesh | None:
    """What of a mesh lies in its cell: in the sheet of faces bodies would cover their neighbours."""
    width, height = CELL_M[look]
    inside = (np.abs(mesh.vertices - cell)[:, [0, 2]] < np.array([width, height]) / 2).all(axis=1)
    corners = np.where(mesh.faces < 0, mesh.faces[:, :1], mesh.faces)
    chosen = inside[corners].all(axis=1)
    if not chosen.any():
        return None
    uv = None if mesh.uv is None else mesh.uv[chosen]
    return replace(mesh, faces=mesh.faces[chosen], uv=uv)


def sheet_job(arguments: argparse.Namespace, textures: Path) -> RenderJob:
    """All people in one scene, side by side and one above the other, seen by one far camera."""
    body = BodyModel.embedded()
    rng = np.random.default_rng(arguments.seed)
    poses = hard_moments() if arguments.hard else moments(rng, 1.0 if arguments.faces else STANDING_SHARE)
    rows = -(-arguments.count // arguments.columns)
    look = "face" if arguments.faces else "hard" if arguments.hard else "body"
    width, height = CELL_M[look]
    meshes: list[Mesh] = []
    for k in range(arguments.count):
        row, column = divmod(k, arguments.columns)
        cell = np.array(
            [(column - (arguments.columns - 1) / 2) * width, 0.0, ((rows - 1) / 2 - row) * height]
        )
        member, moment = cast(arguments.seed + k), next(poses)
        turn = np.deg2rad(
            HARD_TURNS_DEG[row % len(HARD_TURNS_DEG)]
            if arguments.hard
            else float(rng.uniform(-TURN_DEG, TURN_DEG))
        )
        params = placed(body, member, moment, turn)
        meshes += person_meshes(body, member, params, cell, look, f"p{k:02d}", textures)
    scale = arguments.cell / width
    pixels = (round(arguments.columns * arguments.cell), round(rows * height * scale))
    return RenderJob(
        camera=_camera(*pixels, scale * DISTANCE_M),
        meshes=tuple(meshes),
        lights=(Sun(direction=(0.4, 1.0, -0.9), strength=1.4, angle=12.0),),
        environment=Environment(kind="hdri", hdri="studio", strength=0.75, backdrop=(0.62, 0.66, 0.70)),
        quality=Quality(name="sheet", samples=arguments.samples),
        passes=("rgb",),
        image_format="png",
    )


def _camera(width: int, height: int, focal: float) -> CameraPath:
    K = np.array([[focal, 0, width / 2], [0, focal, height / 2], [0, 0, 1]])
    T_world_camera = np.eye(4)
    T_world_camera[:3, :3] = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])
    T_world_camera[:3, 3] = [0, -DISTANCE_M, 0]
    return CameraPath(K[None], T_world_camera[None], 30.0, width, height)


def main() -> int:
    """Command line."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--count", type=int, default=40)
    parser.add_argument("--columns", type=int, help="default: 10, in hard poses as many as there are")
    parser.add_argument("--seed", type=int, default=0, help="the first person's; the others follow")
    parser.add_argument("--cell", type=int, default=160, help="pixels across a person's place")
    parser.add_argument("--faces", action="store_true")
    parser.add_argument("--hard", action="store_true", help="in hard poses")
    parser.add_argument("--engine", choices=("cycles", "raster"), default="cycles")
    parser.add_argument("--samples", type=int, default=24)
    arguments = parser.parse_args()
    arguments.columns = arguments.columns or (len(HARD_POSES) if arguments.hard else 10)
    from PIL import Image

    with tempfile.TemporaryDirectory() as folder:
        job = Path(folder) / "job"
        sheet_job(arguments, Path(folder) / "textures").save(job)
        run_job(job, engine=arguments.engine, device="cpu")
        picture = next((job / "out" / "rgb").iterdir())
        arguments.out.parent.mkdir(parents=True, exist_ok=True)
        if arguments.out.suffix == ".png":
            shutil.copyfile(picture, arguments.out)
        else:
            with Image.open(picture) as image:
                image.convert("RGB").save(arguments.out, quality=88)
    print(arguments.out)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
