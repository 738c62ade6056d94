"""A small dataset on disk, drawn by the rasteriser: sound to the last pixel, and made in seconds."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from camera_rigs import CameraPath
from render_jobs.images import write_exr, write_mask
from render_jobs.passes import PASSES
from whacamole.body import BodyModel, BodyParams, vertex_normals
from whacamole.dataset import DatasetLayout, SequenceLayout, write_index, write_summary
from whacamole.dataset.files import write_arrays, write_json
from whacamole.dataset.splitting import refresh_splits
from whacamole.labels import FrameImages, LabelledPerson, RasterMesh, label_sequence, rasterize
from whacamole.labels.clipping import project_points
from whacamole.labels.people import to_camera
from whacamole.labels.sequence import posed_frames

FRAMES, WIDTH, HEIGHT = 8, 240, 180
PASS_NAMES = ["rgb", "mask", "depth", "normal", "flow"]


def walker(x: float, y: float, speed: float, phase: float, shape: float) -> BodyParams:
    """Strides along x, arms swinging, fingers a little bent."""
    time = np.arange(FRAMES + 1) / 30.0
    rest = BodyParams.zeros(FRAMES + 1)
    fields = {name: np.array(getattr(rest, name)) for name in BodyParams.__dataclass_fields__}
    fields["betas"][0] = shape
    fields["global_orient"][:] = [np.pi / 2, 0, 0]
    fields["transl"][:] = np.stack([x + speed * time, y + 0 * time, 0.975 + 0.04 * shape + 0 * time], axis=1)
    swing = np.sin(2 * np.pi * (1.5 * time + phase))
    for joint, sign in ((0, 1), (1, -1)):
        fields["body_pose"][:, joint, 0] = 0.5 * sign * swing
        fields["body_pose"][:, 15 + joint, 2] = -1.0 * sign
        fields["body_pose"][:, 15 + joint, 1] = 0.6 * swing
        fields["body_pose"][:, 17 + joint, 1] = -0.7 * sign
    fields["left_hand_pose"][:, :, 2] = -0.15
    fields["right_hand_pose"][:, :, 2] = 0.15
    return BodyParams(**fields)


def arc() -> CameraPath:
    """A camera that goes round the people, a little above their eyes, looking at them."""
    angle = 0.15 + 0.02 * np.arange(FRAMES + 1)
    eye = np.stack([3.4 * np.sin(angle), -3.4 * np.cos(angle), np.full(FRAMES + 1, 1.7)], axis=1)
    forward = np.array([0.0, 0.0, 0.95]) - eye
    forward /= np.linalg.norm(forward, axis=1, keepdims=True)
    right = np.stack([forward[:, 1], -forward[:, 0], np.zeros(FRAMES + 1)], axis=1)
    right /= np.linalg.norm(right, axis=1, keepdims=True)
    pose = np.tile(np.eye(4), (FRAMES + 1, 1, 1))
    pose[:, :3, :3] = np.stack([right, np.cross(forward, right), forward], axis=-1)
    pose[:, :3, 3] = eye
    K = np.tile([[230.0, 0, WIDTH / 2], [0, 230, HEIGHT / 2], [0, 0, 1]], (FRAMES + 1, 1, 1))
    return CameraPath(K, pose, 30.0, WIDTH, HEIGHT)


def stage() -> list[tuple[np.ndarray, np.ndarray]]:
    """Ground, a back wall and a post that hides something."""
    quad = np.array([[0, 1, 2], [0, 2, 3]])
    ground = np.array([[-9, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]], dtype=float)
    wall = np.array([[-9, 3, 0], [9, 3, 0], [9, 3, 5], [-9, 3, 5]], dtype=float)
    post = np.array([[0.75, -1, 0], [0.85, -1, 0], [0.85, -1, 2.4], [0.75, -1, 2.4]], dtype=float)
    return [(points, quad) for points in (ground, wall, post)]


def colours(points: np.ndarray, mesh: np.ndarray) -> np.ndarray:
    """A picture ``(H, W, 3)``: checks on the stage by world position, plain people."""
    checks = (np.floor(points[..., 0] * 2) + np.floor(points[..., 1] * 2) + np.floor(points[..., 2] * 2)) % 2
    stage = 90 + 60 * checks[..., None] * np.array([1.0, 0.9, 0.8])
    people = np.array([[205, 160, 140], [70, 60, 120]])[np.clip(mesh, 0, 1)]
    return np.where((mesh < 2)[..., None] & (mesh >= 0)[..., None], people, stage).astype(np.uint8)


def draw(people, model, camera):
    """Rasters and world points of all frames, and the people's vertices."""
    drawn = []
    for frame, bodies in enumerate(posed_frames(people, model)):
        view = camera.T_camera_world[frame]
        meshes = [(body, model.faces) for body in bodies] + stage()
        raster = rasterize(
            [RasterMesh(to_camera(points, view), faces) for points, faces in meshes],
            camera.K[frame], WIDTH, HEIGHT,
        )  # fmt: skip
        x, y = np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5)
        rays = np.stack([x, y, np.ones_like(x)], axis=-1) @ np.linalg.inv(camera.K[frame]).T
        depth = np.where(np.isfinite(raster.depth), raster.depth, 50.0)
        points = (rays * depth[..., None]) @ camera.T_world_camera[frame, :3, :3].T
        drawn.append((raster, points + camera.T_world_camera[frame, :3, 3], bodies))
    return drawn


def on_body(values, corners, weight):
    """Values ``(V, 3)`` of the vertices, at points inside triangles."""
    a, b, c = (values[corners[:, k]].astype(float) for k in range(3))
    return a + weight[:, :1] * (b - a) + weight[:, 1:2] * (c - a)


def seen_triangles(drawn, number, model):
    """Pixels of a body, corners of the triangles there, and the weights of the second and third corner."""
    raster, points, bodies = drawn
    seen = raster.mesh == number
    corners = model.faces[raster.triangle[seen]]
    a, b, c = (bodies[number][corners[:, k]].astype(float) for k in range(3))
    frames = np.stack([b - a, c - a, np.cross(b - a, c - a)], axis=-1)
    return seen, corners, np.linalg.solve(frames, (points[seen] - a)[..., None])[..., 0]


def normals_of(drawn, model, view):
    """Smooth normals of the bodies, flat ones of the stage, in the camera frame and towards it."""
    raster, points, bodies = drawn
    world = np.zeros(points.shape)
    for number, body in enumerate(bodies):
        seen, corners, weight = seen_triangles(drawn, number, model)
        world[seen] = on_body(vertex_normals(body.astype(float), model.faces), corners, weight)
    for number, (corners, _) in enumerate(stage(), len(bodies)):
        world[raster.mesh == number] = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    normal = world @ view[:3, :3].T
    away = (normal * to_camera(points.reshape(-1, 3), view).reshape(points.shape)).sum(axis=-1) > 0
    normal[away] *= -1
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    return np.divide(normal, length, out=np.zeros_like(normal), where=length > 0).astype(np.float32)


def flow_of(frame, drawn, model, camera):
    """Motion of the point at each pixel to the next frame: with its triangle, or with the stage."""
    _, points, bodies = drawn[frame]
    after = points.copy()
    for number in range(len(bodies)):
        seen, corners, weight = seen_triangles(drawn[frame], number, model)
        after[seen] = on_body(drawn[frame + 1][2][number], corners, weight)
    here = project_points(to_camera(points, camera.T_camera_world[frame]), camera.K[frame])
    there = project_points(to_camera(after, camera.T_camera_world[frame + 1]), camera.K[frame + 1])
    return (there - here).astype(np.float32)


def write_sequence(sequence: SequenceLayout, model: BodyModel) -> None:
    """All files of one sequence but its summary."""
    camera = arc()
    longer = [
        LabelledPerson(1, "stroll", "neutral", walker(-0.9, 0.1, 1.4, 0.0, 0.4)),
        LabelledPerson(2, "stroll", "neutral", walker(0.3, -0.2, 1.1, 0.3, -0.5)),
    ]
    drawn = draw(longer, model, camera)
    for name in PASS_NAMES:
        (sequence.folder / name).mkdir(parents=True)
    images = []
    for frame in range(FRAMES):
        raster, points, _ = drawn[frame]
        mask = np.array([1, 2, 0, 0, 0, 0])[raster.mesh]
        depth = raster.depth.astype(np.float32)
        images.append(FrameImages(mask, depth))

        def place(name, frame=frame):
            return sequence.folder / PASSES[name].file(frame, "png")

        Image.fromarray(colours(points, raster.mesh)).save(place("rgb"))
        write_mask(place("mask"), mask, 2)
        write_exr(place("depth"), PASSES["depth"], depth)
        view = camera.T_camera_world[frame]
        write_exr(place("normal"), PASSES["normal"], normals_of(drawn[frame], model, view))
        write_exr(place("flow"), PASSES["flow"], flow_of(frame, drawn, model, camera))
    people = [LabelledPerson(p.track_id, p.motion_id, p.gender, p.params.slice(0, FRAMES)) for p in longer]
    shorter = CameraPath(camera.K[:FRAMES], camera.T_world_camera[:FRAMES], 30.0, WIDTH, HEIGHT)
    labels = label_sequence(people, model, shorter, images.__getitem__)
    write_arrays(sequence.camera, labels.camera)
    write_arrays(sequence.people, labels.people)
    write_arrays(sequence.contact, labels.contact)
    write_json(sequence.shot, {"shots": []})


def facts(sequence_id: str, motion: str) -> dict:
    return {
        "id": sequence_id, "motion_id": motion, "frames": FRAMES, "fps": 30.0, "width": WIDTH, "height":
        HEIGHT, "people": 2, "passes": PASS_NAMES, "image_format": "png",
    }  # fmt: skip


@pytest.fixture(scope="session")
def sound(tmp_path_factory) -> Path:
    """Two sequences of one motion; nothing wrong."""
    layout = DatasetLayout(tmp_path_factory.mktemp("sound") / "data")
    write_sequence(layout.sequence("stroll-00"), BodyModel.embedded())
    shutil.copytree(layout.sequence("stroll-00").folder, layout.sequence("stroll-01").folder)
    for sequence_id in ("stroll-00", "stroll-01"):
        write_summary(layout.sequence(sequence_id), facts(sequence_id, "stroll"))
    write_index(layout, {})
    refresh_splits(layout, 0.0)
    return layout.root


@pytest.fixture
def dataset(sound: Path, tmp_path: Path) -> Path:
    """A copy to spoil; its second sequence is left out, for speed."""
    root = tmp_path / "data"
    shutil.copytree(sound, root, ignore=shutil.ignore_patterns("stroll-01"))
    write_index(DatasetLayout(root), {})
    refresh_splits(DatasetLayout(root), 0.0)
    return root


@pytest.fixture
def sequence(dataset: Path) -> SequenceLayout:
    return DatasetLayout(dataset).sequence("stroll-00")
