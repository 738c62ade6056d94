"""Do labels land on the pixels? Asked of the ``smplx`` package, which poses, and of NumPy, which projects.

Nothing here calls the code that wrote the labels.
"""

from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR
import pytest
from numpy.typing import NDArray
from PIL import Image
from scipy import ndimage

from tests_support import run_cli

pytestmark = [pytest.mark.blender, pytest.mark.slow]

SEEN = 0.02
"""A vertex no farther than this from the depth map's surface is what the map shows [m]."""

SEEN_NEAR = 0.05
"""A hand's vertex farther than this from the depth map is behind something [m]."""

POSES = (
    "body_pose", "left_hand_pose", "right_hand_pose", "jaw_pose", "leye_pose", "reye_pose", "expression",
)  # fmt: skip

Arrays = dict[str, NDArray[Any]]


def _load(path: Path) -> Arrays:
    with np.load(path, allow_pickle=False) as stored:
        return dict(stored)


def _exr(path: Path) -> dict[str, NDArray[np.float32]]:
    with OpenEXR.File(str(path), separate_channels=True) as file:
        return {name: np.array(channel.pixels) for name, channel in file.channels().items()}


def _posed_by_smplx(
    body: Path, people: Arrays, person: int, frame: str
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return vertices (T, V, 3) and joints (T, 55, 3) in the frame "world" or "camera"."""
    smplx = pytest.importorskip("smplx")
    torch = pytest.importorskip("torch")
    T = people["body_pose"].shape[1]

    def tensor(name: str) -> Any:
        return torch.tensor(people[name][person].reshape(T, -1), dtype=torch.float64)

    model = smplx.create(
        str(body), model_type="smplx", ext="npz", use_pca=False, flat_hand_mean=True, batch_size=T,
        num_betas=10, num_expression_coeffs=10, dtype=torch.float64,
    )  # fmt: skip
    betas = np.broadcast_to(people["betas"][person], (T, 10)).astype(np.float64)
    with torch.no_grad():
        result = model(
            betas=torch.tensor(betas),
            global_orient=tensor(f"global_orient_{frame}"),
            transl=tensor(f"transl_{frame}"),
            **{name: tensor(name) for name in POSES},
        )  # fmt: skip
    return result.vertices.numpy(), result.joints.numpy()[:, :55]


def _to_camera(points: NDArray[np.float64], camera: Arrays) -> NDArray[np.float64]:
    R, t = camera["T_camera_world"][:, :3, :3], camera["T_camera_world"][:, :3, 3]
    return np.einsum("tij,tnj->tni", R, points) + t[:, None]


def _project(points: NDArray[np.float64], camera: Arrays) -> NDArray[np.float64]:
    image = np.einsum("tij,tnj->tni", camera["K"], points)
    return image[..., :2] / image[..., 2:]


def _sequences(dataset: Path) -> list[Path]:
    return sorted((dataset / "sequences").iterdir())


Posed = list[tuple[Path, int, Arrays, Arrays, NDArray[np.float64]]]


@pytest.fixture(scope="module")
def posed(dataset: Path, exported_body: Path) -> Posed:
    return _everybody(dataset, exported_body)


@pytest.fixture(scope="module")
def posed_large(motions: Path, exported_body: Path, tmp_path_factory: pytest.TempPathFactory) -> Posed:
    """The same two scenes in pictures that show hands; both engines draw the same depth (test_truth)."""
    out = tmp_path_factory.mktemp("large") / "data"
    result = run_cli(
        "render", "--motions", motions, "--shots", "arc,tracking", "--frames", 3, "--size", "1280x720",
        "--engine", "raster", "--seed", 5, "--out", out,
    )  # fmt: skip
    assert result.returncode == 0, result.stdout + result.stderr
    return _everybody(out, exported_body)


def _everybody(dataset: Path, exported_body: Path) -> Posed:
    """Return (sequence, person, people, camera, vertices in the camera frame) of everybody."""
    found = []
    for sequence in _sequences(dataset):
        people, camera = _load(sequence / "people.npz"), _load(sequence / "camera.npz")
        for person in range(len(people["track_id"])):
            vertices, _ = _posed_by_smplx(exported_body, people, person, "world")
            found.append((sequence, person, people, camera, _to_camera(vertices, camera)))
    assert len(found) == 3  # a walker and a pair
    return found


def _turned_to_the_camera(points: NDArray[np.float64], faces: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Return which vertices (V, 3) in the camera frame lie on the near side of the body."""
    corners = points[faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    total = np.zeros_like(points)
    for corner in range(3):
        np.add.at(total, faces[:, corner], normal)
    cosine = -(total * points).sum(axis=1) / np.maximum(
        np.linalg.norm(total, axis=1) * np.linalg.norm(points, axis=1), 1e-12
    )
    return cosine > 0.2


def test_visible_vertices_fall_on_the_mask(posed: Posed, exported_body: Path) -> None:
    faces = _load(exported_body)["f"].astype(np.int64)
    for sequence, person, people, camera, vertices in posed:
        on_mask = []
        for frame, points in enumerate(vertices):
            gap, column, row, _ = _gaps(sequence, camera, points, frame, faces)
            mask = np.asarray(Image.open(sequence / "mask" / f"{frame:06d}.png"))
            on_mask.append(mask[row, column][np.abs(gap) < SEEN] == people["track_id"][person])
        seen = np.concatenate(on_mask)
        assert len(seen) > 500 * len(vertices), "too few vertices are seen: the test means nothing"
        assert seen.mean() >= 0.99


def test_depth_is_that_of_the_bare_hands(posed_large: Posed, exported_body: Path) -> None:
    """Hands wear nothing, so there the depth map must show the body itself."""
    model = _load(exported_body)
    faces, hand = model["f"].astype(np.int64), model["weights"][:, 25:].sum(axis=1) > 0.9
    gaps = []
    for sequence, _, _, camera, vertices in posed_large:
        for frame, points in enumerate(vertices):
            gap, column, row, chosen = _gaps(sequence, camera, points, frame, faces)
            nearest = _first_at_each_pixel(column, row, points[chosen, 2])
            near_surface = (np.abs(gap) < SEEN_NEAR) & _off_edges(sequence, frame)[row, column]
            gaps.append(gap[hand[chosen] & nearest & near_surface])
    found = np.abs(np.concatenate(gaps))
    assert len(found) > 500, "too little of the hands is seen: the test means nothing"
    # The rest are fingers just behind others.
    assert np.median(found) < 0.001
    assert np.quantile(found, 0.75) < 0.006  # a pixel is 4 to 8 mm wide there


def _off_edges(sequence: Path, frame: int) -> NDArray[np.bool_]:
    """Return the pixels (H, W) whose neighbours are all at nearly their depth: no outline passes there."""
    depth = _exr(sequence / "depth" / f"{frame:06d}.exr")["Z"]
    finite = np.where(np.isfinite(depth), depth, 1e3)
    return (ndimage.maximum_filter(finite, 3) - ndimage.minimum_filter(finite, 3)) < SEEN_NEAR


def _first_at_each_pixel(
    column: NDArray[np.int64], row: NDArray[np.int64], z: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Return which vertices are the nearest of all that fall on their pixel."""
    order = np.argsort(z, kind="stable")
    _, first = np.unique(np.stack([column, row])[:, order], axis=1, return_index=True)
    nearest = np.zeros(len(z), bool)
    nearest[order[first]] = True
    return nearest


def _gaps(
    sequence: Path, camera: Arrays, points: NDArray[np.float64], frame: int, faces: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return vertex depth − depth map [m], column, row and number of the near-side vertices in view."""
    depth = _exr(sequence / "depth" / f"{frame:06d}.exr")["Z"]
    image = points @ camera["K"][frame].T
    column, row = np.floor(image[:, :2] / image[:, 2:]).astype(int).T
    inside = (column >= 0) & (row >= 0) & (column < depth.shape[1]) & (row < depth.shape[0])
    chosen = np.flatnonzero(inside & _turned_to_the_camera(points, faces))
    column, row = column[chosen], row[chosen]
    return points[chosen, 2] - depth[row, column], column, row, chosen


def test_joints_image_is_the_projection(dataset: Path, exported_body: Path) -> None:
    for sequence in _sequences(dataset):
        people, camera = _load(sequence / "people.npz"), _load(sequence / "camera.npz")
        for person in range(len(people["track_id"])):
            _, world = _posed_by_smplx(exported_body, people, person, "world")
            _, local = _posed_by_smplx(exported_body, people, person, "camera")
            for joints in (_to_camera(world, camera), local):
                error = np.abs(_project(joints, camera) - people["joints_image"][person]).max()
                assert error < 0.01, f"{sequence.name} person {person}: {error:.4f} px"
            np.testing.assert_allclose(people["joints_world"][person], world, atol=1e-5)
            np.testing.assert_allclose(people["joints_camera"][person], local, atol=1e-5)


def test_flow_is_the_motion_of_the_projection(posed: Posed) -> None:
    for sequence, _, _, camera, vertices in posed:
        pixels = _project(vertices, camera)
        errors, travel = [], []
        for frame in range(len(vertices) - 1):
            depth = _exr(sequence / "depth" / f"{frame:06d}.exr")["Z"]
            flow = _exr(sequence / "flow" / f"{frame:06d}.exr")
            column, row = np.floor(pixels[frame]).astype(int).T
            inside = (column >= 0) & (row >= 0) & (column < depth.shape[1]) & (row < depth.shape[0])
            at = (row[inside], column[inside])
            seen = np.abs(depth[at] - vertices[frame, inside, 2]) < 0.02
            moved = (pixels[frame + 1] - pixels[frame])[inside][seen]
            drawn = np.stack([flow["X"][at], flow["Y"][at]], axis=1)[seen]
            errors.append(np.abs(drawn - moved))
            travel.append(np.abs(moved))
        assert (np.median(np.concatenate(errors), axis=0) < 0.5).all()
        assert np.median(np.concatenate(travel), axis=0).max() > 0.2, "nothing moves: the test means nothing"


def test_boxes_hold_what_they_say(dataset: Path) -> None:
    for sequence in _sequences(dataset):
        people = _load(sequence / "people.npz")
        for person, track in enumerate(people["track_id"]):
            for frame, box in enumerate(people["bbox_visible_xyxy"][person]):
                mask = np.asarray(Image.open(sequence / "mask" / f"{frame:06d}.png")) == track
                rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
                expected = [columns[0], rows[0], columns[-1] + 1, rows[-1] + 1]
                np.testing.assert_allclose(box, expected)
                whole = people["bbox_xyxy"][person, frame]
                assert (whole[:2] <= box[:2] + 1.0).all()
                assert (whole[2:] >= box[2:] - 1.0).all()
            assert (people["visible_fraction"][person] > 0.3).all()


def test_depth_and_normals_agree(dataset: Path) -> None:
    """A plane's depth tells its normal: on the ground both must say the same."""
    sequence = _sequences(dataset)[0]
    camera = _load(sequence / "camera.npz")
    depth = _exr(sequence / "depth" / "000000.exr")["Z"]
    normal = _exr(sequence / "normal" / "000000.exr")
    up = camera["T_camera_world"][0, :3, 2]  # the world's z axis seen by the camera
    height, width = depth.shape
    rows, columns = np.mgrid[0:height, 0:width] + 0.5
    rays = np.stack([columns, rows, np.ones_like(rows)], axis=-1) @ np.linalg.inv(camera["K"][0]).T
    points = rays * np.where(np.isfinite(depth), depth, 0.0)[..., None]
    z = points @ up + camera["T_world_camera"][0, 2, 3]
    ground = np.isfinite(depth) & (np.abs(z) < 1e-3)
    assert ground.mean() > 0.05
    stored = np.stack([normal["X"], normal["Y"], normal["Z"]], axis=-1)[ground]
    assert np.median(stored @ up) > 0.999
