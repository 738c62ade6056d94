"""Planted faults, each found without checksums: by what the labels say about each other and the pixels.

A fault is planted as a bug in a generator would make it: consistently, with everything derived anew where a
bug would derive it, so that only the comparison named can tell.
"""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from scipy.spatial.transform import Rotation

from planted_faults import audit, change, labels, load
from whacamole.body import BodyModel, BodyParams
from whacamole.check import check_dataset
from whacamole.dataset import SequenceLayout
from whacamole.dataset.files import write_arrays


def swap(a: Path, b: Path) -> None:
    first, second = a.read_bytes(), b.read_bytes()
    a.write_bytes(second)
    b.write_bytes(first)


def in_camera(points: np.ndarray, view: np.ndarray) -> np.ndarray:
    return np.einsum("tij,ptnj->ptni", view[:, :3, :3], points) + view[None, :, None, :3, 3]


def derive_joints(sequence: SequenceLayout) -> None:
    """Joints anew from world-frame parameters and camera, as a generator with a bug before that would."""
    people, camera, model = load(sequence.people), load(sequence.camera), BodyModel.embedded()
    world = np.stack([model.pose_joints(BodyParams.from_arrays(people, "world", p)) for p in range(2)])
    seen = in_camera(world, camera["T_camera_world"])
    image = np.einsum("tij,ptnj->ptni", camera["K"][:, :2], seen / seen[..., 2:])
    change(sequence.people, joints_world=world, joints_camera=seen, joints_image=image)


def derive_camera_params(sequence: SequenceLayout) -> None:
    people, camera, model = load(sequence.people), load(sequence.camera), BodyModel.embedded()
    orient, transl = [], []
    for number in range(2):
        params = BodyParams.from_arrays(people, "world", number)
        pelvis = model.rest_joints(params.betas, params.expression)[:, 0]
        turned = params.transformed(camera["T_camera_world"], pelvis)
        orient.append(turned.global_orient)
        transl.append(turned.transl)
    change(sequence.people, global_orient_camera=np.stack(orient), transl_camera=np.stack(transl))


def test_the_sound_dataset_is_clean(sound):
    findings = check_dataset(sound)
    assert findings.lines() == ["2 sequences, 16 frames: nothing wrong"]
    assert findings.ok


@pytest.mark.parametrize(
    ("name", "suffix", "expected"),
    [("rgb", "png", "rgb"), ("mask", "png", "mask"), ("depth", "exr", "depth")],
)
def test_a_swapped_frame(dataset, sequence, name, suffix, expected):
    swap(sequence.folder / name / f"000003.{suffix}", sequence.folder / name / f"000004.{suffix}")
    found = audit(dataset)
    assert expected in labels(found)
    assert {f.frame for f in found if f.label == expected} & {3, 4}


def test_swapped_labels(dataset, sequence):
    """Rows 3 and 4 of everything stored about people: consistent in itself, at odds with the pixels."""
    for path in (sequence.people, sequence.contact):
        arrays = load(path)
        order = [0, 1, 2, 4, 3, 5, 6, 7]
        moved = {
            key: np.take(value, order, axis=list(value.shape).index(8))
            for key, value in arrays.items()
            if 8 in value.shape
        }
        change(path, **moved)
    assert "mask" in labels(audit(dataset))


def test_labels_a_frame_late(dataset, sequence):
    for path in (sequence.people, sequence.contact, sequence.camera):
        arrays = load(path)
        moved = {
            key: np.roll(value, 1, axis=list(value.shape).index(8))
            for key, value in arrays.items()
            if 8 in value.shape and key != "frame_index"
        }
        change(path, **moved)
    found = audit(dataset)
    late = [f for f in found if "fits better" in f.message]
    assert {f.label for f in late} >= {"mask"}
    assert "the picture of frame 0 fits better" in " ".join(f.message for f in late) or "mask" in labels(
        found
    )


def test_colours_a_frame_late(dataset, sequence):
    files = sorted((sequence.folder / "rgb").glob("*.png"))
    contents = [file.read_bytes() for file in files]
    for file, content in zip(files, [contents[0], *contents[:-1]], strict=True):
        file.write_bytes(content)
    found = audit(dataset)
    assert labels(found) == {"rgb"}


def test_mirrored_people(dataset, sequence):
    """x of the world to -x, by the parameters, all joints derived."""
    people = load(sequence.people)
    mirrored = people["transl_world"] * [-1, 1, 1]
    change(sequence.people, transl_world=mirrored)
    derive_joints(sequence)
    derive_camera_params(sequence)
    assert "mask" in labels(audit(dataset))


def test_mirrored_images(dataset, sequence):
    for file in (sequence.folder / "mask").glob("*.png"):
        Image.fromarray(np.asarray(Image.open(file))[:, ::-1].copy()).save(file)
    assert "mask" in labels(audit(dataset))


def test_mirrored_camera_axis(dataset, sequence):
    camera = load(sequence.camera)
    pose = camera["T_world_camera"].copy()
    pose[:, :3, 0] *= -1
    change(sequence.camera, T_world_camera=pose, T_camera_world=np.linalg.inv(pose))
    found = audit(dataset)
    assert any("mirrored" in f.message for f in found)


def test_a_wrong_hand_mean(dataset, sequence):
    """The fingers of another resting pose added, joints derived: only the pixels of the hands can tell."""
    people = load(sequence.people)
    bent = np.zeros((15, 3))
    bent[:12, 2] = 0.6
    change(
        sequence.people,
        left_hand_pose=(people["left_hand_pose"] - bent).astype(np.float32),
        right_hand_pose=(people["right_hand_pose"] + bent).astype(np.float32),
    )
    derive_joints(sequence)
    found = audit(dataset)
    assert any("hand" in f.label for f in found)


def test_a_wrong_hand_mean_without_new_joints(dataset, sequence):
    people = load(sequence.people)
    change(sequence.people, left_hand_pose=(people["left_hand_pose"] + 0.1).astype(np.float32))
    found = audit(dataset)
    assert any(f.label == "people.joints_world" and "left_hand" in f.message for f in found)


@pytest.mark.parametrize("derived", [False, True])
def test_a_transposed_rotation(dataset, sequence, derived):
    camera = load(sequence.camera)
    pose = camera["T_world_camera"].copy()
    pose[:, :3, :3] = pose[:, :3, :3].transpose(0, 2, 1)
    change(sequence.camera, T_world_camera=pose, T_camera_world=np.linalg.inv(pose))
    if derived:
        derive_joints(sequence)
        derive_camera_params(sequence)
    found = labels(audit(dataset))
    assert found & ({"mask", "people.joint_visibility"} if derived else {"people.joints_camera"})


@pytest.mark.parametrize("shift", [2.0, 6.0])
def test_a_shifted_principal_point(dataset, sequence, shift):
    K = load(sequence.camera)["K"].copy()
    K[:, 0, 2] += shift
    change(sequence.camera, K=K)
    found = audit(dataset)
    assert {"people.joints_image", "mask"} <= labels(found)
    derive_joints(sequence)
    assert "mask" in labels(audit(dataset))


@pytest.mark.parametrize("camera_too", [False, True])
def test_y_up_parameters(dataset, sequence, camera_too):
    """The parameters' world has y up; with ``camera_too`` the camera's too, so that all fits the pixels."""
    tilt = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
    world = np.eye(4)
    world[:3, :3] = tilt
    people, model = load(sequence.people), BodyModel.embedded()
    orient, transl = [], []
    for number in range(2):
        params = BodyParams.from_arrays(people, "world", number)
        pelvis = model.rest_joints(params.betas, params.expression)[:, 0]
        turned = params.transformed(world, pelvis)
        orient.append(turned.global_orient)
        transl.append(turned.transl)
    change(sequence.people, global_orient_world=np.stack(orient), transl_world=np.stack(transl))
    if camera_too:
        pose = world @ load(sequence.camera)["T_world_camera"]
        change(sequence.camera, T_world_camera=pose, T_camera_world=np.linalg.inv(pose))
        derive_joints(sequence)
    found = labels(audit(dataset))
    assert "contact.ground_distance" in found
    assert ("people.joints_world" in found) != camera_too


def test_track_ids_exchanged(dataset, sequence):
    change(sequence.people, track_id=np.array([2, 1]))
    assert "mask" in labels(audit(dataset))


def test_a_track_id_the_labels_do_not_have(dataset, sequence):
    for file in (sequence.folder / "mask").glob("*.png"):
        mask = np.asarray(Image.open(file)).copy()
        mask[mask == 2] = 7
        Image.fromarray(mask).save(file)
    found = audit(dataset)
    assert any("no track" in f.message for f in found)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize(
    "name", ["people.npz", "camera.npz", "rgb/000002.png", "mask/000002.png", "depth/000002.exr"]
)
def test_a_truncated_file(dataset, sequence, name):
    path = sequence.folder / name
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    found = audit(dataset)
    stem = name.partition("/")[0].partition(".")[0]
    assert any(f.label.startswith(stem) and f.message == "not readable" for f in found)


def test_a_missing_file(dataset, sequence):
    (sequence.folder / "depth" / "000005.exr").unlink()
    found = audit(dataset)
    assert any(f.label == "depth" and f.frame == 5 and "missing" in f.message for f in found)


def test_a_leaked_split(sound, tmp_path):
    import shutil

    root = tmp_path / "data"
    shutil.copytree(sound, root)
    (root / "splits" / "train.txt").write_text("stroll-00\n")
    (root / "splits" / "test.txt").write_text("stroll-01\n")
    found = audit(root)
    assert [f.label for f in found] == ["splits/train.txt"]
    assert "stroll leaks" in next(iter(found)).message
    (root / "splits" / "train.txt").write_text("stroll-00\nstroll-01\n")
    assert any("also in" in str(f.value) for f in audit(root))
    (root / "splits" / "test.txt").write_text("")
    (root / "splits" / "train.txt").write_text("stroll-00\ngone-00\n")
    messages = [f.message for f in audit(root)]
    assert messages == ["lists gone-00, which is not there", "stroll-01 is in no split"]


def test_wrong_flow(dataset, sequence):
    import OpenEXR

    from render_jobs.images import read_exr, write_exr
    from render_jobs.passes import PASSES

    assert OpenEXR is not None
    for file in (sequence.folder / "flow").glob("*.exr"):
        channels = read_exr(file)
        write_exr(file, PASSES["flow"], np.stack([channels["X"], -channels["Y"] + 1.0], axis=-1))
    found = audit(dataset)
    assert labels(found) == {"flow"}
    assert all("in y" in f.message for f in found)


def test_spoiled_boxes_and_visibility(dataset, sequence):
    people = load(sequence.people)
    change(
        sequence.people,
        bbox_visible_xyxy=people["bbox_visible_xyxy"] + np.float32(3),
        bbox_xyxy=people["bbox_xyxy"] * np.float32(0.9),
        visible_fraction=np.ones_like(people["visible_fraction"]),
        joint_visibility=np.where(people["joint_visibility"] == 1, 2, people["joint_visibility"]).astype(
            np.uint8
        ),
        valid=np.zeros_like(people["valid"]),
    )
    assert labels(audit(dataset)) == {
        "people.bbox_visible_xyxy", "people.bbox_xyxy", "people.visible_fraction", "people.joint_visibility",
        "people.valid",
    }  # fmt: skip


def test_not_a_number_and_missing_arrays(dataset, sequence):
    people = load(sequence.people)
    broken = people["body_pose"].copy()
    broken[1, 4, 2, 0] = np.nan
    change(sequence.people, body_pose=broken)
    (finding,) = audit(dataset)
    assert (finding.label, finding.frame, finding.value) == ("people.body_pose", 4, "nan")
    people.pop("betas")
    write_arrays(sequence.people, people | {"valid": people["valid"][:, :-1]})
    assert [(f.label, f.message) for f in audit(dataset)] == [
        ("people.betas", "the array is missing"),
        ("people.valid", "wrong shape"),
    ]


def test_a_jumping_camera(dataset, sequence):
    pose = load(sequence.camera)["T_world_camera"].copy()
    pose[4, :3, 3] += [0.2, 0, 0]
    pose[5, :3, :3] = pose[5, :3, :3] @ Rotation.from_rotvec([0, 0.2, 0]).as_matrix()
    change(sequence.camera, T_world_camera=pose, T_camera_world=np.linalg.inv(pose))
    messages = " ".join(f.message for f in audit(dataset))
    assert "jumps" in messages
    assert "twitches" in messages


def test_checksums_tell_of_any_change(dataset, sequence):
    image = Image.open(sequence.folder / "rgb" / "000001.png")
    pixels = np.asarray(image).copy()
    pixels[0, 0] += 1
    Image.fromarray(pixels).save(sequence.folder / "rgb" / "000001.png")
    assert audit(dataset).ok
    (finding,) = check_dataset(dataset)
    assert finding.label == "rgb/000001.png"
    assert finding.frame == 1
