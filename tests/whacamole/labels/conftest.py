"""Toy bodies and scenes for the tests of labels."""

import numpy as np
import pytest
import trimesh

from camera_rigs import CameraPath
from whacamole.body import BodyModel, BodyParams


@pytest.fixture(scope="session")
def model() -> BodyModel:
    return BodyModel.embedded()


@pytest.fixture(scope="session")
def ball() -> tuple[np.ndarray, np.ndarray]:
    """A unit sphere of 2562 vertices."""
    mesh = trimesh.creation.icosphere(subdivisions=4)
    return np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces)


@pytest.fixture(scope="session")
def box() -> tuple[np.ndarray, np.ndarray]:
    """A closed box of 1 m, its sides cut fine, around the origin."""
    mesh = trimesh.creation.box(extents=(1, 1, 1))
    for _ in range(4):
        mesh = mesh.subdivide()
    mesh.merge_vertices()
    return np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces)


@pytest.fixture(scope="session")
def standing():
    """Makes people who stand upright in a world with z up."""

    def make(num_frames: int, x: float = 0.0, y: float = 0.0, seed: int | None = None) -> BodyParams:
        """A person standing upright in a world with z up, posed at random if a seed is given."""
        params = BodyParams.zeros(num_frames)
        fields = {name: np.array(getattr(params, name)) for name in BodyParams.__dataclass_fields__}
        fields["global_orient"][:] = [np.pi / 2, 0, 0]
        fields["transl"][:] = [x, y + 0.351, 0.9625]  # the rest pelvis is at (0, -0.351, 0.012)
        if seed is not None:
            rng = np.random.default_rng(seed)
            fields["betas"] = rng.normal(size=10)
            fields["body_pose"] = rng.normal(scale=0.35, size=(num_frames, 21, 3))
            fields["left_hand_pose"] = rng.normal(scale=0.3, size=(num_frames, 15, 3))
            fields["expression"] = rng.normal(size=(num_frames, 10))
            fields["global_orient"] += rng.normal(scale=0.2, size=(num_frames, 3))
        return BodyParams(**fields)

    return make


@pytest.fixture(scope="session")
def level_camera():
    """Makes cameras that look level along world +y at the origin."""

    def make(num_frames: int, drift: float = 0.0) -> CameraPath:
        """Looks along world +y from 4 m before the origin, moving ``drift`` metres to the right a frame."""
        pose = np.tile(np.eye(4), (num_frames, 1, 1))
        pose[:, :3, :3] = [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
        pose[:, :3, 3] = [0, -4.0, 1.0]
        pose[:, 0, 3] += drift * np.arange(num_frames)
        K = np.tile([[150.0, 0, 96], [0, 150, 72], [0, 0, 1]], (num_frames, 1, 1))
        return CameraPath(K, pose, 30.0, 192, 144)

    return make
