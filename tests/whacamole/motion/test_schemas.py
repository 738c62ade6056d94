"""Each format gives back the one movement that all their files were made from."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from whacamole.motion import Motion, find_motions, read_motion
from whacamole.motion.skeleton import forward

PAIRS = {"dd100", "inter-x", "interhuman"}
FINGERS = {"amass-smplh", "amass-smplx", "dd100", "bedlam", "inter-x", "motion-x"}
FACE = {"amass-smplx", "dd100", "bedlam", "motion-x"}
SHAPES = {"aist++": "smpl", "amass-smplh": "smplh", "interhuman": "smplh"}


def joints_of(motion: Motion) -> np.ndarray:
    """World joints (P,T,22,3) of the nominal skeleton."""
    return np.stack([forward(p.global_orient, p.body_pose, p.pelvis)[0] for p in motion.people])


def test_all_formats_give_the_same_world_joints(schema, write_schema, truth):
    motion = read_motion(write_schema(schema))
    assert motion.source == schema
    assert motion.fps == 30.0
    assert motion.interactive == (schema in PAIRS)
    assert len(motion.people) == (2 if schema in PAIRS else 1)
    expected = []
    for person in range(len(motion.people)):
        samples = truth(30.0, person)
        expected.append(forward(samples.pose[:, 0], samples.pose[:, 1:22], samples.pelvis)[0])
    offset = joints_of(motion) - np.stack(expected)
    # One vertical shift for the whole scene, nothing else.
    np.testing.assert_allclose(offset[..., :2], 0.0, atol=1e-9)
    np.testing.assert_allclose(offset[..., 2], offset[0, 0, 0, 2], atol=1e-9)


def test_people_stand_on_the_ground_at_their_relative_height(schema, write_schema, truth):
    motion = read_motion(write_schema(schema))
    lowest = [joints_of(motion)[p, :, [10, 11], 2].min() for p in range(len(motion.people))]
    # The ball of the foot is 2.7 cm above its sole; person 1 of the truth stands 20 cm higher than person 0.
    assert lowest[0] == pytest.approx(0.027, abs=1e-6)
    if len(lowest) == 2:
        assert lowest[1] - lowest[0] == pytest.approx(0.2, abs=1e-9)


def test_fingers_face_and_shape_space(schema, write_schema, truth):
    person = read_motion(write_schema(schema)).people[0]
    samples = truth(30.0)
    assert person.shape_space == SHAPES.get(schema, "smplx")
    assert person.has_hands == (schema in FINGERS)
    fingers = samples.pose if schema in FINGERS else np.zeros_like(samples.pose)
    np.testing.assert_allclose(person.left_hand_pose, fingers[:, 25:40], atol=1e-9)
    np.testing.assert_allclose(person.right_hand_pose, fingers[:, 40:55], atol=1e-9)
    face = samples.pose if schema in FACE else np.zeros_like(samples.pose)
    np.testing.assert_allclose(person.jaw_pose, face[:, 22], atol=1e-9)
    eyes = np.zeros_like(samples.pose) if schema == "motion-x" else face
    np.testing.assert_allclose(person.leye_pose, eyes[:, 23], atol=1e-9)
    np.testing.assert_allclose(person.reye_pose, eyes[:, 24], atol=1e-9)
    expression = samples.expression[:, :10] if schema == "motion-x" else np.zeros((len(face), 10))
    np.testing.assert_allclose(person.expression, expression, atol=1e-9)


def test_header_tells_the_length(schema, write_schema, tmp_path):
    write_schema(schema)
    [found] = find_motions(tmp_path)
    motion = read_motion(found)
    assert found.problem is None
    assert found.source == motion.source
    assert found.num_frames == motion.num_frames == 46
    assert found.num_people == len(motion.people)
    assert found.id == motion.id


@pytest.mark.parametrize(
    ("schema_name", "gender", "betas"),
    [
        ("amass-smplh", "female", np.linspace(-1, 1, 16)),
        ("amass-smplx", "male", np.linspace(-1, 1, 16)),
        ("dd100", "female", np.linspace(-1, 1, 10)),
        ("bedlam", "male", np.linspace(-1, 1, 11, dtype=np.float32)),
        ("inter-x", "female", np.zeros(10)),
        ("interhuman", "male", np.zeros(10)),
        ("motion-x", "neutral", np.zeros(10)),
        ("aist++", "neutral", np.zeros(0)),
    ],
)
def test_gender_and_shape(write_schema, schema_name, gender, betas):
    person = read_motion(write_schema(schema_name)).people[0]
    assert person.gender == gender
    np.testing.assert_allclose(person.betas, betas, atol=1e-12)


def test_dd100_poses_grouped_by_joint_are_the_same(write_schema, tmp_path):
    flat = read_motion(write_schema("dd100"))
    grouped = read_motion(write_schema("dd100", grouped=True))
    for one, other in zip(flat.people, grouped.people, strict=True):
        np.testing.assert_array_equal(one.body_pose, other.body_pose)


def test_formats_are_told_apart_by_content_not_by_name(schema, write_schema, tmp_path):
    path = write_schema(schema)
    renamed = tmp_path / "elsewhere" / ("clip" + path.suffix)
    renamed.parent.mkdir()
    path.rename(renamed)
    assert read_motion(renamed).source == schema


def test_constant_fingers_do_not_count_as_hands(write_schema: Callable[..., Path], truth):
    relaxed = np.concatenate([truth(120.0).pose[:, :22], np.full((181, 30, 3), 0.1)], axis=1).reshape(-1, 156)
    person = read_motion(write_schema("amass-smplh", poses=relaxed)).people[0]
    assert not person.has_hands
    np.testing.assert_array_equal(person.left_hand_pose, 0.1)


@pytest.mark.parametrize(("stored", "frames"), [(30.0, 181), (59.94, 91), (100.0, 55)])
def test_rate_is_taken_from_the_file(write_schema, stored, frames):
    assert read_motion(write_schema("amass-smplh", mocap_framerate=np.array(stored))).num_frames == frames


def test_known_rest_pelvis_replaces_the_nominal_one(write_schema):
    path = write_schema("amass-smplx")
    seen = []

    def rest_pelvis(model: str, gender: str, betas: np.ndarray) -> np.ndarray:
        seen.append((model, gender, len(betas)))
        return np.array([0.0031 + 0.05, -0.3514, 0.0120])

    moved = read_motion(path, rest_pelvis=rest_pelvis).people[0].pelvis - read_motion(path).people[0].pelvis
    assert seen == [("smplx", "male", 16)]
    np.testing.assert_allclose(moved, np.tile([0.05, 0.0, 0.0], (len(moved), 1)), atol=1e-12)
