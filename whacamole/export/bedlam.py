"""BEDLAM's training files: one row a person and image, plain arrays.

A body's translation is stored in two parts: with the world-to-camera matrix ``cam_ext``, the body stands at
``trans_cam + cam_ext[:3, 3]`` in the camera frame. The world is y down, pixels as in the dataset.
"""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from whacamole.dataset import Sequence
from whacamole.export.frames import Y_DOWN_FROM_Z_UP, cameras_in, people_in
from whacamole.export.rows import ROWS_A_FILE, full_pose, instances, joint_boxes, person_name, shards
from whacamole.export.source import Source

__all__ = ["write_bedlam"]

BODY_JOINTS, MIN_INSIDE = 22, 12
"""BEDLAM leaves out rows with fewer of the body's joints inside the image (its df_full_body.py)."""
BOX_SCALE = 1.2 / 200.0
KEYPOINTS = 127
"""What its loaders take of ``gtkps``: SMPL-X joints and 72 landmarks of the licensed model's surface, which
have confidence 0 here."""


def write_bedlam(source: Source, folder: Path) -> list[str]:
    """Write ``bedlam_<label>_<number>.npz``; image paths are relative to the root of the dataset."""
    rows = (_rows(sequence, source) for sequence in source)
    for number, piece in enumerate(shards(rows, ROWS_A_FILE)):
        with (folder / f"bedlam_{source.label}_{number:03d}.npz").open("wb") as stream:
            np.savez(stream, **piece)
    return []


def _rows(sequence: Sequence, source: Source) -> dict[str, NDArray[Any]]:
    camera, people = sequence.camera, sequence.people
    p, t = instances(sequence, source.frames(sequence))
    points = people["joints_image"][p, t]
    inside = people["joint_visibility"][p, t] > 0
    enough = inside[:, :BODY_JOINTS].sum(axis=1) >= MIN_INSIDE
    p, t, points, inside = p[enough], t[enough], points[enough], inside[enough]
    boxes = joint_boxes(points[:, :BODY_JOINTS], inside[:, :BODY_JOINTS])
    keypoints = np.zeros((len(p), KEYPOINTS, 3))
    keypoints[:, : points.shape[1]] = np.concatenate([points, inside[..., None]], axis=-1)
    world = people_in(Y_DOWN_FROM_Z_UP, people)
    extrinsics = cameras_in(Y_DOWN_FROM_Z_UP, camera)[t]
    return {
        "imgname": np.array([source.image(sequence, frame) for frame in t], dtype=np.str_),
        "center": (boxes[:, :2] + boxes[:, 2:]) / 2.0,
        "scale": (boxes[:, 2:] - boxes[:, :2]).max(axis=1) * BOX_SCALE,
        "pose_cam": full_pose(people, people["global_orient_camera"])[p, t],
        "pose_world": full_pose(people, world.global_orient)[p, t],
        "shape": people["betas"][p].astype(np.float64),
        "trans_cam": people["transl_camera"][p, t] - extrinsics[:, :3, 3],
        "trans_world": world.transl[p, t],
        "gtkps": keypoints,
        "cam_int": camera["K"][t],
        "cam_ext": extrinsics,
        "gender": people["gender"][p],
        "motion_info": people["motion_id"][p],
        "sub": np.array([person_name(sequence, person) for person in p], dtype=np.str_),
    }
