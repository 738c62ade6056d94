"""Whole sequences, labelled from pictures that an independent drawing of the same scene gives."""

from dataclasses import replace

import numpy as np
import pytest
import smplx
import torch
from scipy.spatial.transform import Rotation

from whacamole.body import BodyParams
from whacamole.labels import FrameImages, LabelledPerson, RasterMesh, label_sequence, rasterize
from whacamole.labels.people import WorldMesh, to_camera
from whacamole.labels.sequence import posed_frames

FRAMES = 3


def render(people, model, camera, props=()):
    """Mask and depth of every frame, props included, as a renderer would give them."""
    images = []
    for frame, bodies in enumerate(posed_frames(people, model)):
        view = camera.T_camera_world[frame]
        meshes = [RasterMesh(to_camera(body, view), model.faces) for body in bodies]
        meshes += [RasterMesh(to_camera(points, view), faces) for points, faces in props]
        drawn = rasterize(meshes, camera.K[frame], camera.width, camera.height)
        ids = np.array([*(person.track_id for person in people), *(0 for _ in props), 0])
        images.append(FrameImages(ids[drawn.mesh].astype(np.uint8), drawn.depth.astype(np.float32)))
    return images


def wall(x0, x1, y, height):
    corners = np.array([[x0, y, 0], [x1, y, 0], [x1, y, height], [x0, y, height]], dtype=float)
    return corners, np.array([[0, 1, 2], [0, 2, 3]])


@pytest.fixture(scope="module")
def scene(model, standing, level_camera):
    camera = level_camera(FRAMES, drift=0.1)
    people = [
        LabelledPerson(3, "walk", "female", standing(FRAMES, x=-0.5, seed=1)),
        LabelledPerson(1, "walk", "male", standing(FRAMES, x=0.4, y=0.5, seed=2)),
    ]
    images = render(people, model, camera)
    return camera, people, images, label_sequence(people, model, camera, images.__getitem__)


def smplx_joints(model, tmp_path, arrays, number, frame):
    """Joints of the stored parameters by the smplx package."""
    path = model.export_full(tmp_path / "SMPLX_NEUTRAL.npz")
    body = smplx.SMPLX(
        path, ext="npz", use_pca=False, flat_hand_mean=True, num_betas=10, num_expression_coeffs=10
    )

    def tensor(name, *shape):
        return torch.tensor(arrays[name][number, frame].reshape(1, *shape), dtype=torch.float32)

    names = ("global_orient", "transl")
    output = {}
    for view in ("world", "camera"):
        keywords = {name: tensor(f"{name}_{view}", 3) for name in names}
        output[view] = (
            body(
                betas=torch.tensor(arrays["betas"][number][None]),
                expression=tensor("expression", 10),
                body_pose=tensor("body_pose", 63),
                left_hand_pose=tensor("left_hand_pose", 45),
                right_hand_pose=tensor("right_hand_pose", 45),
                jaw_pose=tensor("jaw_pose", 3),
                leye_pose=tensor("leye_pose", 3),
                reye_pose=tensor("reye_pose", 3),
                **keywords,
            )
            .joints[0, :55]
            .detach()
            .numpy()
            .astype(np.float64)
        )
    return output


@pytest.mark.filterwarnings("ignore")
def test_joints_agree_with_the_smplx_package_in_both_frames(scene, model, tmp_path):
    _, _, _, labels = scene
    for number in range(2):
        joints = smplx_joints(model, tmp_path, labels.people, number, FRAMES - 1)
        view = labels.camera["T_camera_world"][-1]
        seen = joints["world"] @ view[:3, :3].T + view[:3, 3]
        np.testing.assert_allclose(joints["camera"], seen, atol=2e-5)
        np.testing.assert_allclose(labels.people["joints_world"][number, -1], joints["world"], atol=2e-5)
        np.testing.assert_allclose(labels.people["joints_camera"][number, -1], joints["camera"], atol=2e-5)
        for points in (seen, joints["camera"]):
            pixel = points @ labels.camera["K"][-1].T
            pixel = pixel[:, :2] / pixel[:, 2:]
            np.testing.assert_allclose(labels.people["joints_image"][number, -1], pixel, atol=0.01)


def test_contract_shapes_and_keys(scene, model):
    _, _, _, labels = scene
    P, T, J, C = 2, FRAMES, 55, 21
    people = {
        "track_id": (P,), "motion_id": (P,), "gender": (P,), "body_model": (), "body_model_sha256": (),
        "betas": (P, 10), "expression": (P, T, 10), "global_orient_world": (P, T, 3),
        "transl_world": (P, T, 3),
        "global_orient_camera": (P, T, 3), "transl_camera": (P, T, 3), "body_pose": (P, T, 21, 3),
        "left_hand_pose": (P, T, 15, 3), "right_hand_pose": (P, T, 15, 3), "jaw_pose": (P, T, 3),
        "leye_pose": (P, T, 3), "reye_pose": (P, T, 3), "joints_world": (P, T, J, 3),
        "joints_camera": (P, T, J, 3), "joints_image": (P, T, J, 2), "joint_visibility": (P, T, J),
        "bbox_xyxy": (P, T, 4), "bbox_visible_xyxy": (P, T, 4), "visible_fraction": (P, T), "valid": (P, T),
    }  # fmt: skip
    contact = {
        "part_names": (C,), "ground_contact": (P, T, C), "ground_distance": (P, T, C),
        "person_contact": (P, P, T, C), "person_distance": (P, P, T, C), "person_contact_part": (P, P, T, C),
        "vertex_contact": (P, T, -(-model.num_vertices // 8)), "ground_threshold": (), "person_threshold": (),
        "velocity_threshold": (),
    }  # fmt: skip
    camera = {"K": (T, 3, 3), "T_world_camera": (T, 4, 4), "T_camera_world": (T, 4, 4), "frame_index": (T,)}
    for arrays, shapes in ((labels.people, people), (labels.contact, contact), (labels.camera, camera)):
        for key, shape in shapes.items():
            assert arrays[key].shape == shape, key
    for arrays in (labels.people, labels.contact, labels.camera):
        for key, value in arrays.items():
            assert value.dtype != object, key
    assert np.isfinite(labels.people["joints_image"]).all()
    np.testing.assert_array_equal(labels.people["track_id"], [3, 1])


def test_boxes_fractions_and_visibility_of_the_scene(scene):
    camera, _, images, labels = scene
    arrays = labels.people
    assert arrays["valid"].all()
    for number, track in enumerate((3, 1)):
        for frame in range(FRAMES):
            rows, columns = np.nonzero(images[frame].mask == track)
            box = [columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]
            np.testing.assert_array_equal(arrays["bbox_visible_xyxy"][number, frame], box)
            whole = arrays["bbox_xyxy"][number, frame]
            # A pixel is seen by its centre, so the whole reaches half a pixel into the seen box's rim.
            assert (whole[:2] <= np.array(box[:2]) + 0.5).all()
            assert (whole[2:] >= np.array(box[2:]) - 0.5).all()
    # Nobody stands before the first one; the second is partly hidden when the arms cross.
    np.testing.assert_array_equal(arrays["visible_fraction"][0], 1.0)
    assert (arrays["joint_visibility"][0] == 2).mean() > 0.6
    np.testing.assert_array_equal(labels.camera["K"], camera.K)


def test_a_wall_hides_the_legs(scene, model, standing, level_camera):
    camera, people, _, free = scene
    behind = render(people, model, camera, [wall(-3, 3, -1.0, 0.8)])
    hidden = label_sequence(people, model, camera, behind.__getitem__).people
    assert (hidden["visible_fraction"] < 0.8).all()
    assert (hidden["visible_fraction"] > 0.2).all()
    legs = [4, 5, 7, 8]
    assert (hidden["joint_visibility"][:, :, legs] == 1).all()
    assert (free.people["joint_visibility"][:, :, legs] == 2).mean() > 0.8
    # What is not behind the wall stays as it was.
    np.testing.assert_array_equal(
        hidden["joint_visibility"][0, :, 15], free.people["joint_visibility"][0, :, 15]
    )
    # And so does all that is not about pixels.
    np.testing.assert_array_equal(hidden["bbox_xyxy"], free.people["bbox_xyxy"])


def test_out_of_view(model, standing, level_camera):
    """Rows of people out of view stay, finite and marked."""
    camera = level_camera(2)
    people = [
        LabelledPerson(1, "a", "neutral", standing(2, y=-9.0)),  # behind the camera
        LabelledPerson(2, "a", "neutral", standing(2, x=9.0)),  # off to the side
        LabelledPerson(3, "a", "neutral", standing(2, x=2.55)),  # cut by the border
    ]
    images = render(people, model, camera)
    arrays = label_sequence(people, model, camera, images.__getitem__).people
    np.testing.assert_array_equal(arrays["valid"], [[False] * 2, [False] * 2, [True] * 2])
    assert (arrays["joint_visibility"][:2] == 0).all()
    np.testing.assert_array_equal(arrays["truncation"][:2], 1.0)
    assert (arrays["truncation"][2] > 0.1).all()
    assert (arrays["truncation"][2] < 0.9).all()
    np.testing.assert_array_equal(arrays["visible_fraction"], [[0, 0], [0, 0], [1, 1]])
    np.testing.assert_array_equal(arrays["bbox_xyxy"][0], 0)
    assert (arrays["bbox_xyxy"][2, :, 2] > camera.width).all()
    for value in arrays.values():
        assert value.dtype.kind != "f" or np.isfinite(value).all()


def test_worn_things_count_into_silhouette_and_box(scene, model, standing, level_camera):
    camera = level_camera(1)
    params = standing(1)
    bare = LabelledPerson(1, "a", "neutral", params)
    # A sandwich board, one square metre, just before the person.
    board = WorldMesh(
        np.array([[-0.5, -0.3, 0.4], [0.5, -0.3, 0.4], [0.5, -0.3, 1.4], [-0.5, -0.3, 1.4]]),
        np.array([[0, 1, 2], [0, 2, 3]]),
    )
    dressed = replace(bare, worn=lambda frame: [board])
    view = camera.T_camera_world[0]
    body = next(posed_frames([bare], model))[0]
    drawn = rasterize(
        [
            RasterMesh(to_camera(body, view), model.faces),
            RasterMesh(to_camera(board.vertices, view), board.faces),
        ],
        camera.K[0], camera.width, camera.height,
    )  # fmt: skip
    image = FrameImages((drawn.mesh >= 0).astype(np.uint8), drawn.depth.astype(np.float32))
    with_board = label_sequence([dressed], model, camera, lambda frame: image).people
    without = label_sequence([bare], model, camera, lambda frame: image).people
    assert with_board["visible_fraction"][0, 0] == 1.0
    assert with_board["bbox_xyxy"][0, 0, 3] == without["bbox_xyxy"][0, 0, 3]
    np.testing.assert_allclose(with_board["bbox_visible_xyxy"][0, 0], with_board["bbox_xyxy"][0, 0], atol=1.5)


def test_same_input_same_bytes_and_no_depth_needed(scene, model):
    camera, people, images, labels = scene
    again = label_sequence(people, model, camera, images.__getitem__)
    for first, second in ((labels.people, again.people), (labels.contact, again.contact)):
        for key, value in first.items():
            assert value.tobytes() == second[key].tobytes(), key
    maskless = label_sequence(people, model, camera, lambda frame: FrameImages(images[frame].mask))
    np.testing.assert_array_equal(maskless.people["joint_visibility"], labels.people["joint_visibility"])


def test_parts_of_a_cut_sequence_equal_the_whole(scene, model):
    """Labels of a frame depend on nothing but the frame and its neighbours."""
    camera, people, images, labels = scene
    first = [replace(person, params=person.params.slice(0, 2)) for person in people]
    half = replace(camera, K=camera.K[:2], T_world_camera=camera.T_world_camera[:2])
    part = label_sequence(first, model, half, images.__getitem__)
    for key in ("joints_image", "joint_visibility", "transl_camera", "visible_fraction"):
        np.testing.assert_array_equal(part.people[key], labels.people[key][:, :2])
    np.testing.assert_array_equal(
        part.contact["person_distance"], labels.contact["person_distance"][:, :, :2]
    )


def test_contact_arrays_of_a_hug(model, standing, level_camera):
    camera = level_camera(2)
    people = [
        LabelledPerson(1, "hug", "neutral", standing(2)),
        LabelledPerson(2, "hug", "neutral", standing(2, y=0.2)),
        LabelledPerson(3, "alone", "neutral", standing(2, x=5.0)),
    ]
    images = render(people, model, camera)
    contact = label_sequence(people, model, camera, images.__getitem__).contact
    names = list(contact["part_names"])
    assert contact["person_contact"][0, 1, 0, names.index("upper_back")]
    assert contact["person_contact"][1, 0, 0, names.index("chest")]
    touched = contact["person_contact_part"][0, 1, 0, names.index("upper_back")]
    assert names[touched] in ("chest", "belly", "upper_back")
    np.testing.assert_array_equal(contact["person_contact"], contact["person_contact_part"] >= 0)
    assert not contact["person_contact"][2].any()
    assert (contact["person_distance"][2, 0] > 3).all()
    assert np.isinf(contact["person_distance"][range(3), range(3)]).all()
    # All three stand still on the ground with both feet.
    feet = [names.index(f"{side}_{part}") for side in ("left", "right") for part in ("heel", "forefoot")]
    assert contact["ground_contact"][:, :, feet].all()
    others = np.setdiff1d(np.arange(len(names)), feet)
    assert not contact["ground_contact"][:, :, others].any()
    # The bits of the one who stands alone are the vertices near the ground.
    bits = np.unpackbits(contact["vertex_contact"], axis=-1, count=model.num_vertices).astype(bool)
    low = model.pose(people[2].params).vertices[:, :, 2] <= contact["ground_threshold"]
    np.testing.assert_array_equal(bits[2], low)
    assert bits[0].sum() > bits[2].sum()


def test_refusals(scene, model, standing, level_camera):
    camera, people, images, _ = scene
    with pytest.raises(ValueError, match="track ids"):
        label_sequence([people[0], people[0]], model, camera, images.__getitem__)
    short = replace(people[0], params=people[0].params.slice(0, 2))
    with pytest.raises(ValueError, match="track 3 has 2 frames, the camera 3"):
        label_sequence([short], model, camera, images.__getitem__)
    with pytest.raises(ValueError, match=r"frame 0: image of \(4, 4\)"):
        label_sequence(people, model, camera, lambda frame: FrameImages(np.zeros((4, 4), np.uint8)))


def test_world_and_camera_parameters_are_one_body(scene, model):
    """The camera-frame parameters pose the body that the world-frame ones do, seen from the camera."""
    _, _, _, labels = scene
    for number in range(2):
        world = model.pose(BodyParams.from_arrays(labels.people, "world", number)).vertices
        camera = model.pose(BodyParams.from_arrays(labels.people, "camera", number)).vertices
        for frame in range(FRAMES):
            seen = to_camera(world[frame].astype(np.float64), labels.camera["T_camera_world"][frame])
            np.testing.assert_allclose(camera[frame], seen, atol=1e-5)
    turn = Rotation.from_rotvec(labels.people["global_orient_world"][0]).as_matrix()
    seen = Rotation.from_rotvec(labels.people["global_orient_camera"][0]).as_matrix()
    np.testing.assert_allclose(seen, labels.camera["T_camera_world"][:, :3, :3] @ turn, atol=1e-12)
