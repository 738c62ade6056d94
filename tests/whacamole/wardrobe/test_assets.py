"""The shipped assets: small, accounted for, and numbered as SMPL-X tools expect."""

import hashlib
import re
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest

from whacamole.body import JOINT_INDEX, BodyParams, mesh_volume
from whacamole.wardrobe.catalogue import catalogue

ASSETS = Path(str(files("whacamole"))) / "assets"

NUMBERS = {
    "nose": 9120, "right_eye": 9929, "left_eye": 9448, "right_ear": 616, "left_ear": 6,
    "left_big_toe": 5770, "left_small_toe": 5780, "left_heel": 8846,
    "right_big_toe": 8463, "right_small_toe": 8474, "right_heel": 8635,
    "left_thumb": 5361, "left_index": 4933, "left_middle": 5058, "left_ring": 5169, "left_pinky": 5286,
    "right_thumb": 8079, "right_index": 7669, "right_middle": 7794, "right_ring": 7905, "right_pinky": 8022,
}  # fmt: skip
"""Where the ``smplx`` package reads these points."""


def test_all_assets_together_are_small():
    assert sum(path.stat().st_size for path in ASSETS.rglob("*") if path.is_file()) < 15e6


@pytest.mark.parametrize("folder", ["body", "wardrobe"])
def test_every_file_is_accounted_for_by_checksum(folder):
    text = (ASSETS / folder / "PROVENANCE.md").read_text(encoding="utf-8")
    listed = dict(re.findall(r"^\| `([^`]+)` \| \d+ \| `([0-9a-f]{16,64})` \|$", text, flags=re.MULTILINE))
    present = {
        p.relative_to(ASSETS / folder).as_posix(): p for p in (ASSETS / folder).rglob("*") if p.is_file()
    }
    present = {name: p for name, p in present.items() if p.suffix not in (".md", ".txt")}
    assert set(listed) == set(present)
    for name, path in present.items():
        assert hashlib.sha256(path.read_bytes()).hexdigest().startswith(listed[name]), name


def test_every_texture_of_the_catalogue_is_there_and_no_other():
    wardrobe = catalogue()
    named = {skin.diffuse for skin in wardrobe.skins}
    for item in wardrobe.items.values():
        named |= {item.diffuse, item.normal} - {None}
    assert named == {path.name for path in (ASSETS / "wardrobe" / "textures").iterdir()}


def test_named_points_are_where_their_names_say(body):
    at = {name: body.v_template[number] for name, number in NUMBERS.items()}
    joints = body.rest_joints(np.zeros(10))
    skin = body.v_template[body.extras["vertex_part"] == 0]
    face = skin[skin[:, 1] > joints[JOINT_INDEX["jaw"], 1] - 0.03]
    assert at["nose"][2] == pytest.approx(face[:, 2].max(), abs=1e-4)
    for side, sign in (("left", 1), ("right", -1)):
        eye = joints[JOINT_INDEX[f"{side}_eye"]]
        assert at[f"{side}_eye"][2] - eye[2] > 0.008
        assert np.linalg.norm(at[f"{side}_eye"][:2] - eye[:2]) < 0.006
        assert sign * at[f"{side}_ear"][0] > 0.06
        for finger in ("thumb", "index", "middle", "ring", "pinky"):
            middle, last = (joints[JOINT_INDEX[f"{side}_{finger}{k}"]] for k in (2, 3))
            tip = at[f"{side}_{finger}"] - last
            assert 0.01 < np.linalg.norm(tip) < 0.04
            assert tip @ (last - middle) / np.linalg.norm(tip) / np.linalg.norm(last - middle) > 0.8
        heel, toe, small = (at[f"{side}_{name}"] for name in ("heel", "big_toe", "small_toe"))
        assert heel[2] < joints[JOINT_INDEX[f"{side}_ankle"], 2] < toe[2]
        assert sign * (small[0] - toe[0]) > 0.03
        assert max(heel[1], toe[1], small[1]) < joints[JOINT_INDEX[f"{side}_ankle"], 1]


def test_points_mirror_each_other(body):
    for name, number in NUMBERS.items():
        if name.startswith("left"):
            other = body.v_template[NUMBERS[name.replace("left", "right")]]
            np.testing.assert_allclose(body.v_template[number] * [-1, 1, 1], other, atol=3e-3)


def landmarks(body):
    index, weights = body.extras["lmk_faces_idx"], body.extras["lmk_bary_coords"]
    return np.einsum("nk,nkc->nc", weights, body.v_template[body.faces[index]])


def test_face_landmarks_have_the_order_of_a_face(body):
    points = landmarks(body)
    assert len(points) == 51
    mirrored = [*range(9, -1, -1), 10, 11, 12, 13, *range(18, 13, -1)]
    np.testing.assert_allclose(points[:19] * [-1, 1, 1], points[mirrored], atol=3e-3)
    brows, bridge, eyes, lips = points[:10], points[10:14], points[19:31], points[31:]
    assert (np.diff(brows[:, 0]) > 0).all()  # from the person's right to the left
    assert (np.diff(bridge[:, 1]) < 0).all()
    assert (np.diff(bridge[:, 2]) > 0).all()
    assert brows[:, 1].min() > eyes[:, 1].max() - 0.002
    assert lips[:, 1].max() < points[14:19, 1].min()
    for first in (0, 6):  # upper lid above the lower one
        assert eyes[first + 1 : first + 3, 1].min() > eyes[first + 4 : first + 6, 1].max()
    assert (
        lips[3, 1] > lips[14, 1] >= lips[18, 1] > lips[9, 1]
    )  # outer top, inner top, inner bottom, outer bottom
    assert lips[0, 0] < lips[12, 0] < 0 < lips[16, 0] < lips[6, 0]


def test_the_outline_runs_from_ear_to_chin_to_ear_and_follows_the_head(body):
    index, weights = body.extras["dynamic_lmk_faces_idx"], body.extras["dynamic_lmk_bary_coords"]
    assert index.shape == (79, 17)
    rows = np.einsum("rnk,rnkc->rnc", weights, body.v_template[body.faces[index]])
    front = rows[0]
    assert front[:, 1].argmin() in (7, 8, 9)
    np.testing.assert_allclose(front * [-1, 1, 1], front[::-1], atol=3e-3)
    assert (np.diff(front[:, 0]) > 0).all()
    # Turned left by k degrees is row 39 + k: the left cheek's outline moves to the front, the right stays.
    turned = rows[39 + 35]
    np.testing.assert_array_equal(turned[:8], front[:8])
    assert turned[10:, 2].mean() > front[10:, 2].mean() + 0.01


def test_lids_follow_the_eyes_and_only_those_of_the_same_side(body):
    rest, joints = body.v_template, body.rest_joints(np.zeros(10))
    eye = joints[JOINT_INDEX["left_eye"]]
    skin = body.extras["vertex_part"] == 0
    lid = skin & (np.linalg.norm(rest - eye, axis=1) < 0.02) & (rest[:, 1] > eye[1])

    def moved(angle):
        arrays = BodyParams.zeros(1, np.zeros(10)).to_arrays()
        arrays["leye_pose"][0] = [angle, 0, 0]
        return body.pose(BodyParams.from_arrays(arrays)).vertices[0] - rest

    down, up = moved(0.4), moved(-0.4)
    assert down[lid, 1].min() < -0.002 < 0.001 < up[lid, 1].max()
    assert np.abs(down[skin & (rest[:, 0] < -0.02)]).max() < 1e-6


def test_bent_joints_keep_their_flesh(body):
    """Volume of the skin against that at rest; plain skinning leaves 0.95, 0.91 and 0.93 of it."""
    skin = body.faces[body.extras["vertex_part"][body.faces[:, 0]] == 0]
    rest = mesh_volume(body.v_template, skin)
    poses = {
        "sit": (0.98, {"hip": (-1.5, 0, 0.1), "knee": (1.5, 0, 0)}),
        "squat": (0.96, {"hip": (-2.0, 0.1, 0.3), "knee": (2.3, 0, 0)}),
        "bend": (0.96, {"hip": (-1.3, 0, 0)}),
    }
    for name, (least, turns) in poses.items():
        arrays = BodyParams.zeros(1, np.zeros(10)).to_arrays()
        for joint, turn in turns.items():
            arrays["body_pose"][0, JOINT_INDEX[f"left_{joint}"] - 1] = turn
            arrays["body_pose"][0, JOINT_INDEX[f"right_{joint}"] - 1] = np.array(turn) * [1, -1, -1]
        posed = body.pose(BodyParams.from_arrays(arrays)).vertices[0]
        assert least < mesh_volume(posed, skin) / rest < 1.02, name


def test_the_smplx_package_puts_its_extra_joints_on_the_points(body, tmp_path):
    """Joints 55 … of the package, for the file as it is written for other tools."""
    smplx = pytest.importorskip("smplx")
    torch = pytest.importorskip("torch")
    folder = tmp_path / "smplx"
    folder.mkdir()
    body.export_full(folder / "SMPLX_NEUTRAL.npz")
    model = smplx.create(
        str(tmp_path),
        model_type="smplx",
        ext="npz",
        use_pca=False,
        flat_hand_mean=True,
        use_face_contour=True,
    )
    with torch.no_grad():
        joints = model().joints[0].numpy()
    names = list(NUMBERS)
    expected = body.v_template[[NUMBERS[name] for name in names]]
    from smplx.joint_names import JOINT_NAMES

    places = [JOINT_NAMES.index(name) for name in names]
    np.testing.assert_allclose(joints[places], expected, atol=1e-5)
    np.testing.assert_allclose(joints[76:127], landmarks(body), atol=1e-5)
    assert joints.shape == (144, 3)
