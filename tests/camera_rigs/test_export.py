"""TUM and nerfstudio: read back by the rules of their formats."""

import json

import numpy as np
from scipy.spatial.transform import Rotation

from camera_rigs import World, direct, to_nerfstudio, to_tum


def path(rig):
    return direct(rig.stander(40), rig.lens(), World(), "dolly-zoom", np.random.default_rng(0)).path


def test_a_tum_trajectory(rig):
    made = path(rig)
    rows = np.array([line.split() for line in to_tum(made).splitlines()], float)
    assert rows.shape == (40, 8)
    np.testing.assert_allclose(rows[:, 0], np.arange(40) / 30.0, atol=1e-9)
    np.testing.assert_allclose(rows[:, 1:4], made.location, atol=1e-9)
    np.testing.assert_allclose(
        Rotation.from_quat(rows[:, 4:]).as_matrix(), made.T_world_camera[:, :3, :3], atol=1e-8
    )


def test_nerfstudio_transforms(rig):
    made = path(rig)
    document = json.loads(json.dumps(to_nerfstudio(made, "rgb/{:04d}.png")))
    assert document["camera_model"] == "OPENCV"
    assert document["frames"][7]["file_path"] == "rgb/0007.png"
    pose = np.array([frame["transform_matrix"] for frame in document["frames"]])
    np.testing.assert_allclose(-pose[:, :3, 2], made.forward, err_msg="an OpenGL camera looks along -z")
    np.testing.assert_allclose(pose[:, :3, 1], -made.T_world_camera[:, :3, 1])
    np.testing.assert_allclose([frame["fl_x"] for frame in document["frames"]], made.focal)
    assert (document["frames"][0]["w"], document["frames"][0]["cy"]) == (640, 180.0)
