"""HumanData and BEDLAM, read by the rules of the code that reads them and posed by the smplx package."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import smplx
import torch
from numpy.typing import NDArray

from whacamole.dataset import Dataset
from whacamole.export import export_dataset
from whacamole.export.rows import joint_boxes, scaled_boxes, shards

Arrays = dict[str, NDArray[Any]]
# Who is in view when: both of the duet always, the walker in all frames but the last, twice.
ROWS = [("duet-00", p, t) for t in range(4) for p in range(2)]
ROWS += [(f"walk-0{shot}", 0, t) for shot in range(2) for t in range(3)]


def _posed(body_file: Path, params: Arrays) -> NDArray[np.float32]:
    """Joints (N, 55, 3) by the smplx package with flat hands."""
    count = len(params["betas"])
    model = smplx.create(
        str(body_file), model_type="smplx", ext="npz", use_pca=False, flat_hand_mean=True, batch_size=count
    )
    given = {
        key: torch.tensor(value.reshape(count, -1), dtype=torch.float32) for key, value in params.items()
    }
    with torch.no_grad():
        joints: NDArray[np.float32] = model(**given).joints[:, :55].numpy()
    return joints


def _truth(data: Dataset, key: str, rows: list[tuple[str, int, int]] = ROWS) -> NDArray[Any]:
    return np.stack([data[name].people[key][p, t] for name, p, t in rows])


def _load(folder: Path) -> Arrays:
    (file,) = folder.iterdir()
    with np.load(file, allow_pickle=True) as stored:
        return dict(stored)


# --- HumanData -------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def humandata(data: Dataset, tmp_path_factory: pytest.TempPathFactory) -> Arrays:
    out = tmp_path_factory.mktemp("humandata") / "out"
    export_dataset(data, "humandata", out)
    assert [path.name for path in out.iterdir()] == ["humandata_all_000.npz"]
    return _load(out)


def _decompressed(humandata: Arrays, key: str) -> NDArray[Any]:
    """The documented rule: kept keypoints are those of the mask, in their order; the others are zeros."""
    mask = humandata[f"{key}_mask"]
    assert mask.sum() == humandata[key].shape[1]
    full = np.zeros((len(humandata[key]), len(mask), humandata[key].shape[2]))
    full[:, mask == 1] = humandata[key]
    return full


def test_humandata_has_a_row_for_everybody_in_view(humandata: Arrays, data: Dataset) -> None:
    meta = humandata["meta"].item()
    found = list(zip(meta["sequence_name"], meta["track_id"] - 1, meta["frame_id"], strict=True))
    assert found == ROWS
    assert int(humandata["__data_len__"]) == len(ROWS)
    for path, (name, _, t) in zip(humandata["image_path"], ROWS, strict=True):
        assert data.layout.root / path == data[name].layout.folder / "rgb" / f"{t:06d}.png"
        assert (data.layout.root / path).is_file()


def test_humandata_poses_to_the_joints_of_the_camera_frame(
    humandata: Arrays, data: Dataset, body_file: Path
) -> None:
    assert humandata["misc"].item()["flat_hand_mean"] is True
    smplx_params = humandata["smplx"].item()
    assert {key: value.shape[1:] for key, value in smplx_params.items()} == {
        "betas": (10,), "global_orient": (3,), "transl": (3,), "body_pose": (21, 3),
        "left_hand_pose": (15, 3), "right_hand_pose": (15, 3), "jaw_pose": (3,), "leye_pose": (3,),
        "reye_pose": (3,), "expression": (10,),
    }  # fmt: skip
    joints = _posed(body_file, smplx_params)
    np.testing.assert_allclose(joints, _truth(data, "joints_camera"), atol=2e-5)
    keypoints = _decompressed(humandata, "keypoints3d_smplx")
    assert keypoints.shape == (len(ROWS), 190, 4)
    np.testing.assert_allclose(keypoints[:, :55, :3], joints, atol=2e-5)


def test_humandata_cameras_project_and_lead_to_the_world(humandata: Arrays, data: Dataset) -> None:
    meta = humandata["meta"].item()
    joints = _decompressed(humandata, "keypoints3d_smplx")[:, :55, :3]
    focal, centre = np.asarray(meta["focal_length"]), np.asarray(meta["principal_point"])
    pixels = joints[..., :2] / joints[..., 2:] * focal[:, None] + centre[:, None]
    keypoints = _decompressed(humandata, "keypoints2d_smplx")
    np.testing.assert_allclose(pixels, keypoints[:, :55, :2], atol=1e-2)
    width, height = np.asarray(meta["width"])[:, None], np.asarray(meta["height"])[:, None]
    inside = (pixels >= 0).all(-1) & (pixels[..., 0] < width) & (pixels[..., 1] < height)
    np.testing.assert_array_equal(keypoints[:, :55, 2] == 1, inside)
    # World to camera, of a world with y down: height is −y.
    world = np.einsum(
        "nij,nkj->nki", np.linalg.inv(meta["RT"])[:, :3], np.pad(joints, _ONE, constant_values=1)
    )
    x, y, z = np.moveaxis(_truth(data, "joints_world"), -1, 0)
    np.testing.assert_allclose(world, np.stack([x, -z, y], axis=-1), atol=1e-5)


_ONE = ((0, 0), (0, 0), (0, 1))


def test_humandata_boxes_hold_the_person_and_the_hands(humandata: Arrays, data: Dataset) -> None:
    boxes = humandata["bbox_xywh"]
    low, high = boxes[:, :2], boxes[:, :2] + boxes[:, 2:4]
    truth = np.clip(_truth(data, "bbox_xyxy"), 0, [97, 64, 97, 64])
    assert (low <= truth[:, :2] + 1e-4).all()
    assert (high >= truth[:, 2:] - 1e-4).all()
    assert (boxes[:, 4] == 1).all()
    hand = humandata["lhand_bbox_xywh"]
    points = _decompressed(humandata, "keypoints2d_smplx")[:, 25:40, :2]
    seen = _truth(data, "joint_visibility")[:, 25:40] == 2
    with_box = hand[:, 4] == 1
    assert with_box.any()
    middle = np.stack([row[use].mean(axis=0) for row, use in zip(points, seen, strict=True) if use.any()])
    held = hand[seen.any(axis=1)]
    assert ((middle >= held[:, :2]) & (middle <= held[:, :2] + held[:, 2:4])).all()
    assert not humandata["face_bbox_xywh"].any()


def test_humandata_contact_is_that_of_the_feet(humandata: Arrays, data: Dataset) -> None:
    contact = humandata["contact"].item()
    names = humandata["misc"].item()["contact_parts"]
    ground = np.stack([data[name].contact["ground_contact"][p, t] for name, p, t in ROWS])
    np.testing.assert_array_equal(contact["ground"], ground)
    for column, side in enumerate(("left", "right")):
        parts = [names.index(f"{side}_heel"), names.index(f"{side}_forefoot")]
        np.testing.assert_array_equal(contact["part_segmentation"][:, column], ground[:, parts].any(axis=1))
    other = np.stack([data[name].contact["person_contact"][p, :, t].any(axis=0) for name, p, t in ROWS])
    np.testing.assert_array_equal(contact["person"], other)


# --- BEDLAM ----------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def bedlam(data: Dataset, tmp_path_factory: pytest.TempPathFactory) -> Arrays:
    out = tmp_path_factory.mktemp("bedlam") / "out"
    export_dataset(data, "bedlam", out)
    (file,) = out.iterdir()
    with np.load(file, allow_pickle=False) as stored:
        return dict(stored)


def _split_pose(pose: NDArray[Any]) -> Arrays:
    names = (
        "global_orient", "body_pose", "jaw_pose", "leye_pose", "reye_pose", "left_hand_pose",
        "right_hand_pose",
    )  # fmt: skip
    return dict(zip(names, np.split(pose, [3, 66, 69, 72, 75, 120], axis=1), strict=True))


def test_bedlam_stands_where_its_loaders_put_it(bedlam: Arrays, data: Dataset, body_file: Path) -> None:
    """The body at ``trans_cam + cam_ext[:3, 3]``, projected by ``cam_int``, falls on the keypoints."""
    assert len(bedlam["imgname"]) == len(ROWS)
    params = _split_pose(bedlam["pose_cam"])
    transl = bedlam["trans_cam"] + bedlam["cam_ext"][:, :3, 3]
    zeros = np.zeros((len(transl), 10))
    joints = _posed(body_file, {**params, "betas": bedlam["shape"], "transl": transl, "expression": zeros})
    np.testing.assert_allclose(joints, _truth(data, "joints_camera"), atol=2e-5)
    homogeneous = np.einsum("nij,nkj->nki", bedlam["cam_int"], joints)
    pixels = homogeneous[..., :2] / homogeneous[..., 2:]
    assert bedlam["gtkps"].shape[1:] == (127, 3)
    np.testing.assert_allclose(pixels, bedlam["gtkps"][:, :55, :2], atol=1e-2)
    assert not bedlam["gtkps"][:, 55:].any()


def test_bedlam_world_and_camera_agree(bedlam: Arrays, body_file: Path) -> None:
    """``cam_ext`` takes the body of ``pose_world``, ``trans_world`` to the camera; gravity is along +y."""
    params = _split_pose(bedlam["pose_world"])
    zeros = np.zeros((len(params["body_pose"]), 10))
    shape = {"betas": bedlam["shape"], "expression": zeros}
    world = _posed(body_file, {**params, **shape, "transl": bedlam["trans_world"]})
    there = np.einsum("nij,nkj->nki", bedlam["cam_ext"][:, :3, :3], world) + bedlam["cam_ext"][:, None, :3, 3]
    camera = _split_pose(bedlam["pose_cam"])
    transl = bedlam["trans_cam"] + bedlam["cam_ext"][:, :3, 3]
    np.testing.assert_allclose(there, _posed(body_file, {**camera, **shape, "transl": transl}), atol=3e-5)
    assert (world[:, 15, 1] < world[:, 7, 1] - 1.0).all()  # the head a metre above the ankles


def test_bedlam_boxes_are_those_of_its_own_script(bedlam: Arrays, data: Dataset) -> None:
    for row, (name, p, t) in enumerate(ROWS):
        points = data[name].people["joints_image"][p, t, :22]
        points = points[data[name].people["joint_visibility"][p, t, :22] > 0]
        low, high = points.min(axis=0), points.max(axis=0)
        np.testing.assert_allclose(bedlam["center"][row], (low + high) / 2, atol=1e-4)
        np.testing.assert_allclose(bedlam["scale"][row], max(high - low) / 200 * 1.2, atol=1e-6)


# --- What both share -------------------------------------------------------------------------------------


def test_every_second_frame(data: Dataset, tmp_path: Path) -> None:
    export_dataset(data, "humandata", tmp_path / "out", every=2)
    meta = _load(tmp_path / "out")["meta"].item()
    expected = [row for row in ROWS if row[2] % 2 == 0]
    assert list(zip(meta["sequence_name"], meta["track_id"] - 1, meta["frame_id"], strict=True)) == expected


def test_shards_keep_parts_whole_and_lose_nothing() -> None:
    parts = [{"a": np.arange(n) + 10 * n, "b": np.full(n, "x" * n)} for n in (3, 0, 4, 2, 9, 1)]
    pieces = list(shards(parts, 7))
    assert [len(piece["a"]) for piece in pieces] == [7, 2, 9, 1]
    np.testing.assert_array_equal(
        np.concatenate([piece["a"] for piece in pieces]), np.concatenate([part["a"] for part in parts])
    )
    assert pieces[0]["b"].tolist() == ["xxx"] * 3 + ["xxxx"] * 4


def test_boxes_are_scaled_about_their_centre_and_clipped() -> None:
    boxes = scaled_boxes(np.array([[10, 10, 20, 30], [90, 0, 110, 10], [120, 0, 130, 5.0]]), 1.2, (100, 50))
    np.testing.assert_allclose(boxes, [[9, 8, 12, 24, 1], [88, 0, 12, 11, 1], [0, 0, 0, 0, 0]], atol=1e-5)
    points = np.array([[[1, 2], [5, 1], [9, 9]], [[1, 2], [5, 1], [9, 9.0]]])
    usable = np.array([[True, True, False], [False, False, False]])
    np.testing.assert_array_equal(joint_boxes(points, usable), [[1, 1, 5, 2], [0, 0, 0, 0]])
