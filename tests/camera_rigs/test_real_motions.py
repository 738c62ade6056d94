"""The director on real motion capture: every clip, ten seeds each, no breach."""

from collections import Counter

import numpy as np
import pytest

from camera_rigs import Lens, Obstacle, SubjectTrack, World, direct
from tests_support import shared_folder

SEEDS = 10


def load_subjects():
    """`SubjectTrack` of every motion, skinned on the embedded body."""
    from whacamole.body import JOINT_INDEX, BodyModel, BodyParams, facing
    from whacamole.motion import find_motions, read_motion

    body, betas = BodyModel.embedded(), np.zeros(10)
    rest = body.rest_joints(betas)[0]
    subjects = {}
    for folder in ("amass", "dd100"):
        for file in find_motions(shared_folder("motions") / folder):
            people = []
            for person in read_motion(file).people:
                poses = {
                    name: getattr(person, name)
                    for name in (
                        "expression", "global_orient", "body_pose", "left_hand_pose", "right_hand_pose",
                        "jaw_pose", "leye_pose", "reye_pose",
                    )
                }  # fmt: skip
                posed = body.pose(BodyParams(betas=betas, transl=person.pelvis - rest, **poses))
                joints, skin = posed.joints, posed.vertices.astype(float)
                people.append(
                    (
                        joints[:, 0],
                        joints[:, JOINT_INDEX["neck"]],
                        facing(joints),
                        skin.min(axis=1),
                        skin.max(axis=1),
                    )
                )
            arrays = [np.stack(array) for array in zip(*people, strict=True)]
            floor = np.array([0.0, 0.0, arrays[3][..., 2].min()])
            for index in (0, 1, 3, 4):
                arrays[index] = arrays[index] - floor
            subjects[file.id] = SubjectTrack.from_people(*arrays, 30.0)
    return subjects


@pytest.fixture(scope="module")
def subjects():
    return load_subjects()


def plans(subjects, shots, world_for=lambda subject, rng: World()):
    for motion, subject in subjects.items():
        for seed in range(SEEDS):
            rng = np.random.default_rng([seed, *motion.encode()])
            size = (640, 360) if seed % 3 else (360, 640)
            lens = Lens.from_millimetres(float(rng.uniform(24.0, 50.0)), *size)
            yield direct(subject, lens, world_for(subject, rng), shots, rng)


def cluttered(subject, rng):
    """Six columns around the people, none of them in their way."""
    middle = subject.pelvis[:, :2].mean(axis=0)
    places = middle + rng.uniform(-5.0, 5.0, (6, 2))
    joints = np.concatenate([subject.people_pelvis, subject.people_neck]).reshape(-1, 3)
    columns = [Obstacle((float(x), float(y), 0.9), (0.5, 0.5, 1.8)) for x, y in places]
    return World(obstacles=tuple(c for c in columns if c.distance(joints).min() > 0.7))


@pytest.mark.slow
def test_every_motion_with_ten_seeds_without_a_breach(subjects):
    assert len(subjects) >= 16
    shown = Counter()
    for shots in ("auto", "all"):
        for plan in plans(subjects, shots):
            assert plan.findings == ()
            shown.update(shot.kind for shot in plan.shots)
    assert len(shown) == 14, "every kind of shot is shown by some plan"


@pytest.mark.slow
def test_among_columns_too(subjects):
    mended = 0
    for plan in plans(subjects, "auto", cluttered):
        assert plan.findings == ()
        mended += any(mend.reason.startswith(("obstacle", "occlusion")) for mend in plan.mends)
    assert mended > 5
