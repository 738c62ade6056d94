"""A dataset without pixels: embedded motions, filmed by planned cameras, with true people and cameras only.

    python -m benchmarks.baseline_scenes OUT [plain | treadmill | skateboard] [SHOTS]
    python -m benchmarks.baseline_scenes OUT motions    the two as files, to `whacamole render --motions`

Oracle estimators and oracle odometry need no more, so ablations run on many sequences in little time.
``treadmill`` takes the way out of walks and runs: legs that walk, a root that stays. ``skateboard`` gives way
to people who stand.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from camera_rigs import CameraPath, Lens, SubjectTrack, World, direct
from whacamole.body import JOINT_INDEX, NUM_BETAS, BodyModel, BodyParams, facing
from whacamole.dataset import DatasetLayout, write_index, write_summary
from whacamole.dataset.files import write_arrays
from whacamole.labels import LabelledPerson
from whacamole.labels.camera import camera_arrays
from whacamole.labels.people import PeopleLabels, stored_params
from whacamole.motion import Motion, MotionPerson, embedded_motions, find_motions, read_motion
from whacamole.seeds import generator

SIZE = (640, 360)
FRAMES = 240
SEED = 0
MOVES = {"treadmill": ("walk", "walk_turn", "stroll", "run"), "skateboard": ("punch", "kick", "dance_b")}
SPEED = 2.5  # m/s of the skateboard


def on_treadmill(person: MotionPerson) -> MotionPerson:
    """The person without the way: the root's place on the ground stays that of frame 0."""
    pelvis = person.pelvis.copy()
    pelvis[:, :2] = pelvis[0, :2]
    return replace(person, pelvis=pelvis)


def on_skateboard(person: MotionPerson) -> MotionPerson:
    """The person of frame 0, rolling straight on, swaying a little."""
    T = 150
    held = {
        name: np.repeat(getattr(person, name)[:1], T, axis=0)
        for name in (
            "global_orient", "pelvis", "body_pose", "left_hand_pose", "right_hand_pose", "jaw_pose",
            "leye_pose", "reye_pose", "expression",
        )
    }  # fmt: skip
    ahead = Rotation.from_rotvec(person.global_orient[0]).apply([0.0, 0.0, 1.0])
    ahead[2] = 0.0
    time = np.arange(T)[:, None] / 30.0
    held["pelvis"] = held["pelvis"] + SPEED * time * ahead / np.linalg.norm(ahead)
    sway = 0.15 * np.sin(2.0 * np.pi * 0.4 * time)
    spine = held["body_pose"][:, JOINT_INDEX["spine2"] - 1]
    spine[:] = spine + sway * np.array([0.3, 1.0, 0.5])
    return replace(person, **held)


def write_motions(out: Path) -> int:
    """Treadmill and skateboard takes of one person as AMASS files, a folder each; returns how many.

    They keep the ids of the motions, so that the baseline takes the weights that never saw their captures.
    """
    count = 0
    for kind, change in (("treadmill", on_treadmill), ("skateboard", on_skateboard)):
        (out / kind).mkdir(parents=True, exist_ok=True)
        for file in find_motions(embedded_motions()):
            motion = read_motion(file)
            if file.id not in MOVES[kind] or motion.interactive:
                continue
            person = change(motion.people[0])
            T = person.num_frames
            parts = (
                person.global_orient, person.body_pose, person.jaw_pose, person.leye_pose, person.reye_pose,
                person.left_hand_pose, person.right_hand_pose,
            )  # fmt: skip
            np.savez(
                out / kind / f"{file.id}.npz",
                poses=np.concatenate([part.reshape(T, -1) for part in parts], axis=1),
                trans=person.pelvis - BodyModel.embedded().rest_joints(np.zeros(NUM_BETAS))[0],
                betas=np.zeros(NUM_BETAS),
                gender="neutral",
                surface_model_type="smplx",
                mocap_frame_rate=30.0,
            )
            count += 1
    return count


def staged(motion: Motion, body: BodyModel, rng: np.random.Generator) -> list[BodyParams]:
    """The people on bodies of drawn shapes, feet on the ground, near the origin, facing anywhere."""
    people = []
    for person in motion.people:
        betas = (0.8 * rng.normal(size=NUM_BETAS)).clip(-2.0, 2.0)
        scale = 1.0 if motion.interactive else body.pelvis_height(betas) / body.pelvis_height(np.zeros(10))
        j0 = body.rest_joints(betas, person.expression)[..., 0, :]
        parts = {
            name: getattr(person, name)
            for name in (
                "expression", "global_orient", "body_pose", "left_hand_pose", "right_hand_pose", "jaw_pose",
                "leye_pose", "reye_pose",
            )
        }  # fmt: skip
        people.append((BodyParams(betas=betas, transl=person.pelvis * scale - j0, **parts), j0))
    middle = np.mean([params.transl.mean(axis=0) for params, _ in people], axis=0) * [1.0, 1.0, 0.0]
    turn = np.eye(4)
    turn[:3, :3] = Rotation.from_euler("z", rng.uniform(0.0, 2.0 * np.pi)).as_matrix()
    turn[:3, 3] = -turn[:3, :3] @ middle
    return [stored_params(params.transformed(turn, j0).slice(0, FRAMES)) for params, j0 in people]


def filmed(people: list[BodyParams], body: BodyModel, rng: np.random.Generator) -> CameraPath:
    """A camera as `whacamole render` would plan it, on an empty plain."""
    joints = np.stack([body.pose_joints(params) for params in people])
    subject = SubjectTrack.from_people(
        pelvis=joints[:, :, 0],
        neck=joints[:, :, JOINT_INDEX["neck"]],
        facing=np.stack([facing(one) for one in joints]),
        box_min=joints.min(axis=2) - 0.1,
        box_max=joints.max(axis=2) + 0.1,
        fps=30.0,
    )
    lens = Lens.from_millimetres(float(np.exp(rng.uniform(np.log(24.0), np.log(50.0)))), *SIZE)
    return direct(subject, lens, World(), "auto", rng).path


def write(root: Path, kind: str = "plain", shots: int = 2) -> int:
    """Write the dataset; every sequence is in the test split. Returns how many there are."""
    layout, body = DatasetLayout(root), BodyModel.embedded()
    count = 0
    for file in find_motions(embedded_motions()):
        if file.id not in MOVES.get(kind, (file.id,)):
            continue
        motion = read_motion(file)
        if kind == "treadmill":
            motion = replace(motion, people=tuple(on_treadmill(p) for p in motion.people))
        if kind == "skateboard":
            motion = replace(motion, people=tuple(on_skateboard(p) for p in motion.people))
        for shot in range(shots):
            _write_one(layout, motion, shot, body)
            count += 1
    write_index(layout, {"kind": kind, "seed": SEED}, 1.0)
    return count


def _write_one(layout: DatasetLayout, motion: Motion, shot: int, body: BodyModel) -> None:
    people = staged(motion, body, generator(SEED, motion.id, shot, "stage"))
    path = filmed(people, body, generator(SEED, motion.id, shot, "camera"))
    labelled = [
        LabelledPerson(i + 1, motion.id, person.gender, params)
        for i, (person, params) in enumerate(zip(motion.people, people, strict=True))
    ]
    arrays = PeopleLabels(labelled, body, path).arrays()
    pixels, depth = path.project(np.moveaxis(arrays["joints_world"][:, :, :22], 0, 1))
    inside = (depth > 0) & (pixels >= 0).all(axis=-1) & (pixels < np.array(SIZE)).all(axis=-1)
    share = np.moveaxis(inside.mean(axis=-1), 0, 1)
    arrays["visible_fraction"], arrays["valid"] = share.astype(np.float32), share > 0.0
    sequence = layout.sequence(f"{motion.id}-{shot:02d}")
    sequence.folder.mkdir(parents=True, exist_ok=True)
    write_arrays(sequence.camera, camera_arrays(path))
    write_arrays(sequence.people, arrays)
    facts = {"id": sequence.folder.name, "motion_id": motion.id, "frames": path.num_frames, "passes": []}
    write_summary(sequence, {**facts, "width": path.width, "height": path.height, "fps": path.fps})


if __name__ == "__main__":
    kind_asked = sys.argv[2] if len(sys.argv) > 2 else "plain"
    if kind_asked == "motions":
        print(f"{write_motions(Path(sys.argv[1]))} motions in {sys.argv[1]}")
    else:
        made = write(Path(sys.argv[1]), kind_asked, int(sys.argv[3]) if len(sys.argv) > 3 else 2)
        print(f"{made} sequences in {sys.argv[1]}")
