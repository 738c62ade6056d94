"""Odometry from files, from spoiled labels, and from pixels of a room that is drawn here."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter
from scipy.spatial.transform import Rotation

from baseline_scenes import moving_camera
from whacamole.baseline.footage import Footage
from whacamole.baseline.odometry import Odometry, Scene
from whacamole.baseline.odometry.bundle import Bundle, Sightings, adjust, reprojection
from whacamole.baseline.odometry.files import FilesOdometry
from whacamole.baseline.odometry.noisy_labels import PathNoise, drift_rand
from whacamole.baseline.odometry.turning import turn_between
from whacamole.baseline.rigid import FloatArray, inverse, rigid
from whacamole.errors import BaselineError
from whacamole.evaluation.core.alignment import align

WIDTH, HEIGHT, FOCAL = 256, 160, 220.0


def _texture(seed: int) -> FloatArray:
    noise = np.random.default_rng(seed).normal(size=(512, 512))
    soft = sum(gaussian_filter(noise, sigma, mode="wrap") * sigma for sigma in (1.5, 4.0, 10.0))
    assert isinstance(soft, np.ndarray)
    return soft / soft.std()


def drawn_room(poses: FloatArray) -> Iterator[np.ndarray]:
    """Frames of a box of a room with noise on its walls, by casting a ray through every pixel."""
    walls = [_texture(seed) for seed in range(3)]
    u, v = np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5)
    rays = np.stack([(u - WIDTH / 2) / FOCAL, (v - HEIGHT / 2) / FOCAL, np.ones_like(u)], axis=-1)
    low, high = np.array([-5.0, -9.0, -0.5]), np.array([5.0, 4.0, 3.5])
    for pose in poses:
        way = rays @ pose[:3, :3].T
        eye = pose[:3, 3]
        with np.errstate(divide="ignore"):
            reach = np.where(way > 0, (high - eye) / way, (low - eye) / way)
        axis = reach.argmin(axis=-1)
        hit = eye + way * reach.min(axis=-1)[..., None]
        shade = np.zeros(axis.shape)
        for wall in range(3):
            a, b = [k for k in range(3) if k != wall]
            at = (np.stack([hit[..., a], hit[..., b]]) * 60.0).astype(int) % 512
            shade = np.where(axis == wall, walls[wall][at[0], at[1]], shade)
        image = np.clip(128 + 45 * shade, 0, 255).astype(np.uint8)
        yield np.repeat(image[..., None], 3, axis=-1)


def room_scene(poses: FloatArray) -> Scene:
    footage = Footage(
        "room", len(poses), 30.0, WIDTH, HEIGHT, np.arange(len(poses)), lambda: drawn_room(poses)
    )
    K = np.array([[FOCAL, 0.0, WIDTH / 2], [0.0, FOCAL, HEIGHT / 2], [0.0, 0.0, 1.0]])
    return Scene(footage, np.tile(K, (len(poses), 1, 1)))


def test_opencv_finds_the_camera_in_a_room() -> None:
    pytest.importorskip("cv2")
    from whacamole.baseline.odometry.opencv import OpenCVOdometry

    poses = moving_camera(150, 2)[:36]
    found = OpenCVOdometry().track(room_scene(poses))
    assert found.valid.all()
    truth = Odometry.from_poses(poses, np.ones(len(poses), dtype=bool)).T_vo
    path, wanted = found.T_vo[:, :3, 3], truth[:, :3, 3]
    error = np.linalg.norm(align(path, wanted) - wanted, axis=1)
    length = np.linalg.norm(np.diff(wanted, axis=0), axis=1).sum()
    assert error.max() < 0.02 * length
    turn = Rotation.from_matrix(np.swapaxes(found.T_vo[:, :3, :3], -1, -2) @ truth[:, :3, :3])
    assert np.degrees(turn.magnitude()).max() < 1.0
    # The odometry's axes are the first camera's, so a scale alone brings the paths together as well.
    scaled = path * float((path * wanted).sum() / (path * path).sum())
    assert np.linalg.norm(scaled - wanted, axis=1).max() < 0.04 * length


def test_opencv_claims_no_more_than_turns_where_the_camera_only_turns() -> None:
    pytest.importorskip("cv2")
    from whacamole.baseline.odometry.opencv import OpenCVOdometry

    poses = moving_camera(150, 2)[:24]
    poses[:, :3, 3] = poses[0, :3, 3]
    found = OpenCVOdometry().track(room_scene(poses))
    assert not found.T_vo[:, :3, 3].any()
    assert "turns" in found.notes[0]
    truth = inverse(poses[0]) @ poses
    turn = Rotation.from_matrix(np.swapaxes(found.T_vo[:, :3, :3], -1, -2) @ truth[:, :3, :3])
    assert np.degrees(turn.magnitude()).max() < 0.5


def test_opencv_says_when_there_is_nothing_to_follow() -> None:
    pytest.importorskip("cv2")
    from whacamole.baseline.odometry.opencv import OpenCVOdometry

    blank = Footage(
        "fog", 6, 30.0, 64, 48, np.arange(6), lambda: (np.full((48, 64, 3), 90, np.uint8) for _ in range(6))
    )
    with pytest.raises(BaselineError, match="fog: fewer than"):
        OpenCVOdometry().track(Scene(blank, np.tile(np.diag([60.0, 60.0, 1.0]), (6, 1, 1))))


@pytest.mark.parametrize("seed", range(4))
def test_a_camera_over_a_floor_is_not_taken_for_its_twin(seed: int) -> None:
    """Two views of a plane allow two motions; other frames tell which it was."""
    cv2 = pytest.importorskip("cv2")
    from whacamole.baseline.odometry.features import PointTracks
    from whacamole.baseline.odometry.mapping import Mapper

    rng = np.random.default_rng(seed)
    cv2.setRNGSeed(0)
    T, K = 24, np.array([[400.0, 0.0, 320.0], [0.0, 400.0, 180.0], [0.0, 0.0, 1.0]])
    floor = np.concatenate([rng.uniform(-2.0, 2.0, size=(300, 2)), np.zeros((300, 1))], axis=1)
    share = np.linspace(0.0, 1.0, T)
    angle = np.radians(150.0) + 0.15 * share**2
    turn = Rotation.from_rotvec(np.stack([angle, 0.1 * share, 0.0 * share], axis=1)).as_matrix()
    center = np.stack([0.8 * np.sin(share), 1.2 - 0.5 * share, 2.2 + 0.4 * share**2], axis=1)
    poses = rigid(turn, center)
    local = np.einsum("tij,tnj->tni", np.swapaxes(turn, 1, 2), floor[None] - center[:, None])
    pixels = local[..., :2] / local[..., 2:] * 400.0 + K[:2, 2]
    pixels += 0.3 * rng.normal(size=pixels.shape)
    pixels[(local[..., 2] < 0.1) | (pixels < 0.0).any(-1) | (pixels > [640.0, 360.0]).any(-1)] = np.nan
    mapper = Mapper(cv2, PointTracks(pixels.astype(np.float32)), np.tile(K, (T, 1, 1)))
    assert mapper.begin(2, 18)
    mapper.grow()
    found, valid = mapper.poses()
    assert valid.all()
    relative = inverse(found[0]) @ found
    truth = inverse(poses[0]) @ poses
    apart = Rotation.from_matrix(np.swapaxes(relative[:, :3, :3], 1, 2) @ truth[:, :3, :3]).magnitude()
    assert np.degrees(apart).max() < 1.5


def test_bundle_adjustment_finds_cameras_and_points() -> None:
    rng = np.random.default_rng(0)
    points = rng.normal(size=(60, 3)) + np.array([0.0, 0.0, 8.0])
    R = Rotation.from_rotvec(0.1 * rng.normal(size=(6, 3))).as_matrix()
    R[0] = np.eye(3)
    t = np.concatenate([np.zeros((1, 3)), rng.normal(size=(5, 3))])
    truth = Bundle(R, t, points)
    camera, point = (index.ravel() for index in np.indices((6, 60)))
    K = np.tile(np.array([[300.0, 0.0, 160.0], [0.0, 300.0, 120.0], [0.0, 0.0, 1.0]]), (6, 1, 1))
    blank = Sightings(camera, point, np.zeros((360, 2)), K)
    seen = Sightings(camera, point, reprojection(truth, blank)[0], K)
    wrong = Bundle(
        Rotation.from_rotvec(0.01 * rng.normal(size=(6, 3)) * (np.arange(6) > 0)[:, None]).as_matrix() @ R,
        t + 0.05 * rng.normal(size=t.shape) * (np.arange(6) > 0)[:, None],
        points + 0.05 * rng.normal(size=points.shape),
    )
    assert np.abs(reprojection(wrong, seen)[0]).max() > 1.0
    found = adjust(wrong, seen, rounds=30)
    assert np.abs(reprojection(found, seen)[0]).max() < 0.02
    np.testing.assert_array_equal(found.R[0], truth.R[0])


def test_a_turn_is_found_among_points_that_move_otherwise() -> None:
    rng = np.random.default_rng(0)
    first = np.concatenate([rng.normal(scale=0.3, size=(80, 2)), np.ones((80, 1))], axis=1)
    R = Rotation.from_rotvec([0.02, -0.05, 0.01]).as_matrix()
    second = first @ R.T
    second[:15] += 0.05 * rng.normal(size=(15, 3))
    found, miss = turn_between(first, second / second[:, 2:], 500.0)
    np.testing.assert_allclose(found, R, atol=1e-3)
    assert miss < 0.3


def test_drift_adds_up_and_keeps_the_first_pose() -> None:
    poses = moving_camera(100, 0)
    np.testing.assert_allclose(drift_rand(np.random.default_rng(0), poses, PathNoise().times(0.0)), poses)
    spoiled = drift_rand(np.random.default_rng(0), poses, PathNoise())
    np.testing.assert_allclose(spoiled[0], poses[0])
    error = np.linalg.norm(spoiled[:, :3, 3] - poses[:, :3, 3], axis=1)
    assert 0.0 < error[5] < error[-1] < 0.5


def _tum(path: Path, poses: FloatArray, frames: list[int]) -> None:
    quaternions = Rotation.from_matrix(poses[:, :3, :3]).as_quat()
    rows = [[n, *poses[n, :3, 3], *quaternions[n]] for n in frames]
    path.write_text("".join(" ".join(f"{v:.9f}" for v in row) + "\n" for row in rows))


def test_a_trajectory_is_read_and_its_gaps_stay_gaps(tmp_path: Path) -> None:
    poses = moving_camera(20, 1)
    _tum(tmp_path / "room.txt", poses, [*range(3), *range(5, 20)])
    found = FilesOdometry(tmp_path).track(room_scene(poses))
    assert np.flatnonzero(found.valid).tolist() == list(range(5, 20))
    expected = Odometry.from_poses(poses, np.arange(20) >= 5)
    np.testing.assert_allclose(found.T_vo, expected.T_vo, atol=1e-6)


def test_a_trajectory_that_does_not_fit_is_refused(tmp_path: Path) -> None:
    poses = moving_camera(20, 1)
    with pytest.raises(BaselineError, match="no trajectory for room"):
        FilesOdometry(tmp_path).track(room_scene(poses))
    _tum(tmp_path / "room.txt", poses, list(range(20)))
    with pytest.raises(BaselineError, match="frame 19, the video has 10"):
        FilesOdometry(tmp_path).track(room_scene(poses[:10]))
    (tmp_path / "room.txt").write_text("0 1 2 3\n")
    with pytest.raises(BaselineError, match="line 1"):
        FilesOdometry(tmp_path).track(room_scene(poses))


def test_rigid_inverse() -> None:
    poses = moving_camera(5, 0)
    np.testing.assert_allclose(inverse(poses) @ poses, np.tile(np.eye(4), (5, 1, 1)), atol=1e-12)
    assert rigid(np.eye(3), np.zeros(3)).shape == (4, 4)
