"""COCO: instances with run-length masks, and the 17 keypoints, streamed into one JSON file."""

import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from whacamole.body import JOINT_INDEX
from whacamole.dataset import Sequence
from whacamole.export.source import Source

__all__ = ["KEYPOINT_NAMES", "run_lengths", "write_coco"]

KEYPOINT_NAMES = (
    "nose", "left_eye", "right_eye", "left_ear", "right_ear", "left_shoulder", "right_shoulder",
    "left_elbow", "right_elbow", "left_wrist", "right_wrist", "left_hip", "right_hip", "left_knee",
    "right_knee", "left_ankle", "right_ankle",
)  # fmt: skip
SKELETON = (
    (16, 14), (14, 12), (17, 15), (15, 13), (12, 13), (6, 12), (7, 13), (6, 7), (6, 8), (7, 9), (8, 10),
    (9, 11), (2, 3), (1, 2), (1, 3), (2, 4), (3, 5), (4, 6), (5, 7),
)  # fmt: skip
"""COCO's own drawing order, keypoints numbered from 1."""

CATEGORY = {
    "id": 1,
    "name": "person",
    "supercategory": "person",
    "keypoints": list(KEYPOINT_NAMES),
    "skeleton": [list(bone) for bone in SKELETON],
}


def write_coco(source: Source, folder: Path) -> list[str]:
    """Write ``coco_<label>.json``; ``file_name`` is relative to the root of the dataset."""
    with (folder / f"coco_{source.label}.json").open("w", encoding="utf-8") as stream:
        head = {"info": {"description": "made by whacamole"}, "licenses": [], "categories": [CATEGORY]}
        stream.write(json.dumps(head)[:-1])
        _write_list(stream, "images", _images(source))
        _write_list(stream, "annotations", _annotations(source))
        stream.write("}\n")
    return []


def run_lengths(mask: NDArray[np.bool_]) -> list[int]:
    """Return COCO's run lengths of a mask (H, W): down the columns, beginning with the zeros."""
    flat = mask.ravel(order="F")
    edges = np.flatnonzero(flat[1:] != flat[:-1]) + 1
    counts: list[int] = np.diff([0, *edges.tolist(), flat.size]).tolist()
    return [0, *counts] if flat[0] else counts


def _write_list(stream: IO[str], key: str, items: Iterable[dict[str, Any]]) -> None:
    stream.write(f', "{key}": [')
    for number, item in enumerate(items):
        stream.write(",\n" if number else "\n")
        stream.write(json.dumps(item))
    stream.write("]")


def _frames(source: Source) -> Iterator[tuple[int, Sequence, int]]:
    """Yield the image's id from 1, the sequence and the frame."""
    number = 0
    for sequence in source:
        for frame in source.frames(sequence):
            number += 1
            yield number, sequence, frame


def _images(source: Source) -> Iterator[dict[str, Any]]:
    for number, sequence, frame in _frames(source):
        width, height = sequence.size
        yield {
            "id": number,
            "file_name": source.image(sequence, frame),
            "width": width,
            "height": height,
            "sequence": sequence.id,
            "frame": frame,
        }


def _annotations(source: Source) -> Iterator[dict[str, Any]]:
    """Yield everybody of whom a pixel is seen."""
    number = 0
    for image, sequence, frame in _frames(source):
        mask = sequence.mask(frame)
        for person, track_id in enumerate(sequence.people["track_id"].tolist()):
            seen = mask == track_id
            if not seen.any():
                continue
            number += 1
            points, labelled = _keypoints(sequence, person, frame)
            yield {
                "id": number,
                "image_id": image,
                "category_id": CATEGORY["id"],
                "iscrowd": 0,
                "segmentation": {"size": list(seen.shape), "counts": run_lengths(seen)},
                "area": int(seen.sum()),
                "bbox": _box(seen),
                "keypoints": points,
                "num_keypoints": labelled,
                "track_id": track_id,
            }


def _box(seen: NDArray[np.bool_]) -> list[int]:
    """Return x, y, width, height of the seen pixels."""
    rows, columns = np.flatnonzero(seen.any(axis=1)), np.flatnonzero(seen.any(axis=0))
    top, left = int(rows[0]), int(columns[0])
    return [left, top, int(columns[-1]) + 1 - left, int(rows[-1]) + 1 - top]


def _keypoints(sequence: Sequence, person: int, frame: int) -> tuple[list[float], int]:
    """Return x, y, v of the 17 (v: 2 seen, 1 hidden, 0 outside or not in SMPL-X), and how many have v > 0."""
    people = sequence.people
    values: list[float] = []
    for name in KEYPOINT_NAMES:
        joint = JOINT_INDEX.get(name)
        v = 0 if joint is None else int(people["joint_visibility"][person, frame, joint])
        x, y = (0.0, 0.0) if v == 0 else people["joints_image"][person, frame, joint].tolist()
        values += [round(x, 3), round(y, 3), v]
    return values, sum(v > 0 for v in values[2::3])
