"""HumanData: the form of the published WHAC-A-Mole labels, read by mmhuman3d, SMPLer-X and SMPLest-X.

One row a person and image, everything in the camera frame, flat hands zero. The format keeps dictionaries in
the ``.npz``, which NumPy stores by pickle; its readers open it with ``allow_pickle=True``.
"""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from whacamole.dataset import Sequence
from whacamole.export.frames import Y_DOWN_FROM_Z_UP, cameras_in
from whacamole.export.rows import ROWS_A_FILE, instances, joint_boxes, scaled_boxes, shards
from whacamole.export.source import Source

__all__ = ["write_humandata"]

KEYPOINTS = 190
"""Keypoints of the HUMAN_DATA convention; its first 55 are the joints of SMPL-X in their order."""

BODY_SCALE, HAND_SCALE = 1.2, 1.25
"""Of the whole person's box (readers of the format divide it by 1.2 again), and of the box of the hand's
joints, which end at the last knuckles."""

HANDS = {"lhand": (20, *range(25, 40)), "rhand": (21, *range(40, 55))}
SMPLX = {
    "betas": "betas",
    "global_orient": "global_orient_camera",
    "transl": "transl_camera",
    **{
        name: name
        for name in (
            "body_pose", "left_hand_pose", "right_hand_pose", "jaw_pose", "leye_pose", "reye_pose",
            "expression",
        )
    },
}  # fmt: skip
"""Name in the format → name in ``people.npz``."""


def write_humandata(source: Source, folder: Path) -> list[str]:
    """Write ``humandata_<label>_<number>.npz``; image paths are relative to the root of the dataset."""
    rows = (_rows(sequence, source) for sequence in source)
    for number, piece in enumerate(shards(rows, ROWS_A_FILE)):
        with (folder / f"humandata_{source.label}_{number:03d}.npz").open("wb") as stream:
            np.savez_compressed(stream, **_nested(piece, _facts(source)))
    return []


def _rows(sequence: Sequence, source: Source) -> dict[str, NDArray[Any]]:
    """Return the rows of a sequence; keys ``a/b`` become dictionaries."""
    camera, people = sequence.camera, sequence.people
    p, t = instances(sequence, source.frames(sequence))
    width, height = sequence.size
    K = camera["K"][t]
    rows: dict[str, NDArray[Any]] = {
        "image_path": np.array([source.image(sequence, frame) for frame in t], dtype=np.str_),
        "bbox_xywh": scaled_boxes(people["bbox_xyxy"][p, t], BODY_SCALE, sequence.size),
        # SMPL-X joints bound no face: a confidence of 0 tells readers that there is no box.
        "face_bbox_xywh": np.zeros((len(p), 5), np.float32),
        **_keypoints(sequence, p, t),
        "meta/gender": people["gender"][p],
        "meta/height": np.full(len(p), height),
        "meta/width": np.full(len(p), width),
        "meta/focal_length": K[:, (0, 1), (0, 1)],
        "meta/principal_point": K[:, :2, 2],
        "meta/RT": cameras_in(Y_DOWN_FROM_Z_UP, camera)[t],
        "meta/sequence_name": np.full(len(p), sequence.id),
        "meta/track_id": people["track_id"][p],
        "meta/frame_id": camera["frame_index"][t],
        "meta/motion_id": people["motion_id"][p],
        **_contact(sequence, p, t),
    }
    for name, ours in SMPLX.items():
        rows[f"smplx/{name}"] = (people[ours][p] if name == "betas" else people[ours][p, t]).astype(
            np.float32
        )
    return rows


def _keypoints(
    sequence: Sequence, p: NDArray[np.intp], t: NDArray[np.intp]
) -> dict[str, NDArray[np.float32]]:
    """Return joints in the image (confidence 1 inside it) and in the camera frame, and the hands' boxes."""
    people = sequence.people
    visibility = people["joint_visibility"][p, t]
    image = people["joints_image"][p, t]
    inside = (visibility > 0)[..., None]
    in_camera = people["joints_camera"][p, t]
    found = {
        "keypoints2d_smplx": np.concatenate([image, inside], axis=-1, dtype=np.float32),
        "keypoints3d_smplx": np.concatenate([in_camera, np.ones_like(inside)], axis=-1, dtype=np.float32),
    }
    for hand, joints in HANDS.items():
        boxes = joint_boxes(image[:, joints], visibility[:, joints] == 2)
        found[f"{hand}_bbox_xywh"] = scaled_boxes(boxes, HAND_SCALE, sequence.size)
    return found


def _contact(sequence: Sequence, p: NDArray[np.intp], t: NDArray[np.intp]) -> dict[str, NDArray[Any]]:
    """Return the feet on the ground as the published labels have them, and every part beside it."""
    contact = sequence.contact
    names = list(contact["part_names"])
    ground = contact["ground_contact"][p, t]
    feet = [
        ground[:, [names.index(f"{side}_heel"), names.index(f"{side}_forefoot")]].any(axis=1)
        for side in ("left", "right")
    ]
    return {
        "contact/part_segmentation": np.stack(feet, axis=1).astype(np.int64),
        "contact/ground": ground,
        "contact/person": contact["person_contact"].any(axis=1)[p, t],
    }


def _facts(source: Source) -> dict[str, Any]:
    first = next(iter(source))
    return {
        "flat_hand_mean": True,
        "bbox_body_scale": BODY_SCALE,
        "bbox_hand_scale": HAND_SCALE,
        "bbox_source": "mesh",
        "kps3d_root_aligned": False,
        "smplx_source": "synthetic",
        "contact_parts": [str(name) for name in first.contact["part_names"]],
        "body_model": str(first.people["body_model"]),
        "body_model_sha256": str(first.people["body_model_sha256"]),
    }


def _nested(rows: dict[str, NDArray[Any]], misc: dict[str, Any]) -> dict[str, Any]:
    """Return the content of a file from flat rows."""
    mask = np.zeros(KEYPOINTS, np.uint8)
    mask[: rows["keypoints2d_smplx"].shape[1]] = 1
    content: dict[str, Any] = {key: value for key, value in rows.items() if "/" not in key}
    for group in ("smplx", "meta", "contact"):
        prefix = f"{group}/"
        members = {key.removeprefix(prefix): rows[key] for key in rows if key.startswith(prefix)}
        content[group] = np.array(members, dtype=object)
    return {
        **content,
        "keypoints2d_smplx_mask": mask,
        "keypoints3d_smplx_mask": mask,
        "config": "whacamole",
        "misc": np.array(misc, dtype=object),
        "__key_strict__": False,
        "__data_len__": len(rows["image_path"]),
        "__keypoints_compressed__": True,
    }
