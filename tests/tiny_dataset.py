"""A whole dataset without a renderer: true labels of the embedded body, images cast by the rasteriser.

``duet-00`` has two people and a camera that turns, ``walk-00`` and ``walk-01`` one person on two stages; the
person of ``walk-00`` is out of view in the last frame.
"""

from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from camera_rigs import CameraPath
from render_jobs import PASSES
from render_jobs.images import write_exr
from whacamole.body import BodyModel, BodyParams
from whacamole.dataset import DatasetLayout, write_index, write_summary
from whacamole.dataset.files import write_arrays, write_json
from whacamole.dataset.splitting import refresh_splits
from whacamole.labels import (
    FrameImages,
    LabelledPerson,
    RasterMesh,
    SequenceLabels,
    label_sequence,
    rasterize,
)

FRAMES, WIDTH, HEIGHT, FPS = 4, 97, 64, 30.0
FOCAL = 80.0


def write_dataset(root: Path) -> DatasetLayout:
    """Write the dataset into the folder ``root``."""
    model, layout, rng = BodyModel.embedded(), DatasetLayout(root), np.random.default_rng(5)
    duet = [_person(model, -0.5, 0.0, rng), _person(model, 0.6, 0.0, rng)]
    walk = [_person(model, 0.0, 6.0, rng)]
    for name, people, stage in (("duet", duet, "studio"), ("walk", walk, "park")):
        labels, images = _labelled(model, people, name)
        _write(layout, f"{name}-00", labels, images, stage)
        if name == "walk":
            _write(layout, "walk-01", labels, images, "plaza")
    body = {"name": model.name, "sha256": model.sha256}
    write_index(layout, {"generator": "whacamole", "seed": 0, "body_model": body})
    refresh_splits(layout, 0.2)
    return layout


def _camera() -> CameraPath:
    """A camera four metres away, 1.2 m up, looking a little down, turning and moving."""
    poses = np.tile(np.eye(4), (FRAMES, 1, 1))
    for number, pose in enumerate(poses):
        turn, tilt = 0.05 * number, 0.1
        forward = np.array([np.sin(turn) * np.cos(tilt), np.cos(turn) * np.cos(tilt), -np.sin(tilt)])
        right = np.array([np.cos(turn), -np.sin(turn), 0.0])
        pose[:3, :3] = np.stack([right, np.cross(forward, right), forward], axis=1)
        pose[:3, 3] = [0.02 * number, -4.0, 1.2]
    K = np.array([[FOCAL, 0.0, WIDTH / 2], [0.0, FOCAL, HEIGHT / 2], [0.0, 0.0, 1.0]])
    return CameraPath(np.tile(K, (FRAMES, 1, 1)), poses, FPS, WIDTH, HEIGHT)


def _person(model: BodyModel, x: float, leap: float, rng: np.random.Generator) -> BodyParams:
    """Somebody near (x, 0) in a pose of no meaning, who is ``leap`` metres further in the last frame."""
    betas = rng.normal(scale=0.5, size=10)
    shapes = {"body_pose": (21, 3), "left_hand_pose": (15, 3), "right_hand_pose": (15, 3)}
    path = np.zeros((FRAMES, 3))
    path[:, 0] = 0.03 * np.arange(FRAMES)
    path[-1, 0] += leap
    return BodyParams(
        betas=betas,
        expression=np.zeros((FRAMES, 10)),
        global_orient=[np.pi / 2, 0.0, 0.0] + 0.1 * rng.normal(size=(FRAMES, 3)),
        transl=np.array([x, 0.0, 0.95]) - model.rest_joints(betas)[0] + path,
        **{name: rng.normal(scale=0.1, size=(FRAMES, *shape)) for name, shape in shapes.items()},
        **{name: rng.normal(scale=0.1, size=(FRAMES, 3)) for name in ("jaw_pose", "leye_pose", "reye_pose")},
    )


def _labelled(
    model: BodyModel, people: list[BodyParams], motion: str
) -> tuple[SequenceLabels, list[FrameImages]]:
    camera = _camera()
    bodies = [model.pose(params).vertices for params in people]
    images = []
    for frame, T in enumerate(camera.T_camera_world):
        meshes = [RasterMesh(body[frame] @ T[:3, :3].T + T[:3, 3], model.faces) for body in bodies]
        cast = rasterize(meshes, camera.K[frame], WIDTH, HEIGHT)
        images.append(FrameImages((cast.mesh + 1).astype(np.uint8), cast.depth.astype(np.float32)))
    cast_people = [
        LabelledPerson(number, motion, gender, params)
        for number, (gender, params) in enumerate(zip(("female", "male"), people, strict=False), start=1)
    ]
    return label_sequence(cast_people, model, camera, lambda frame: images[frame]), images


def _write(
    layout: DatasetLayout, sequence_id: str, labels: SequenceLabels, images: list[FrameImages], stage: str
) -> None:
    sequence = layout.sequence(sequence_id)
    passes = ("rgb", "mask", "depth")
    for name in passes:
        (sequence.folder / name).mkdir(parents=True)
    for frame, image in enumerate(images):
        colour = np.stack([np.asarray(image.mask) * 80, *np.indices((HEIGHT, WIDTH))], axis=-1)
        Image.fromarray(colour.astype(np.uint8)).save(sequence.folder / PASSES["rgb"].file(frame, "png"))
        Image.fromarray(np.asarray(image.mask)).save(sequence.folder / PASSES["mask"].file(frame))
        write_exr(sequence.folder / PASSES["depth"].file(frame), PASSES["depth"], np.asarray(image.depth))
    for name in ("camera", "people", "contact"):
        write_arrays(getattr(sequence, name), getattr(labels, name))
    write_json(sequence.shot, {"shots": [{"kind": "arc-horizontal", "start": 0, "end": FRAMES - 1}]})
    facts: dict[str, Any] = {
        "id": sequence_id, "motion_id": sequence_id[:-3], "motion_source": "made",
        "motion_licence": "CC0-1.0",
        "frames": FRAMES, "fps": FPS, "width": WIDTH, "height": HEIGHT,
        "people": len(labels.people["track_id"]), "interactive": sequence_id.startswith("duet"),
        "shots": ["arc-horizontal"], "stage": stage, "passes": list(passes), "image_format": "png",
        "body_model": str(labels.people["body_model"]),
    }  # fmt: skip
    write_summary(sequence, facts)
