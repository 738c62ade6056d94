"""Formats with one row a person and image: which rows there are, their boxes, and files of bounded size."""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from whacamole.dataset import Sequence

__all__ = ["ROWS_A_FILE", "full_pose", "instances", "joint_boxes", "person_name", "scaled_boxes", "shards"]

Rows = Mapping[str, NDArray[Any]]

ROWS_A_FILE = 100_000
"""Rows of a file before the next one is begun: some 300 MB of labels in memory."""


def instances(sequence: Sequence, frames: range) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return person index (N,) and frame (N,) of everybody in view, frame by frame."""
    taken = np.asarray(frames, dtype=np.intp)
    frame, person = np.nonzero(sequence.people["valid"].T[taken])
    return person, taken[frame]


def person_name(sequence: Sequence, person: int) -> str:
    """Return a name for one person of one sequence, unique in the dataset."""
    return f"{sequence.id}_{int(sequence.people['track_id'][person]):02d}"


def full_pose(people: Rows, root: NDArray[Any]) -> NDArray[np.float64]:
    """Return the pose (P, T, 165) in SMPL-X order: root, body, jaw, eyes, left hand, right hand.

    Args:
        people: arrays of ``people.npz``.
        root: the global orientation (P, T, 3) in the wanted frame.
    """
    shape = (*root.shape[:2], -1)
    names = ("body_pose", "jaw_pose", "leye_pose", "reye_pose", "left_hand_pose", "right_hand_pose")
    return np.concatenate([root, *(people[name].reshape(shape) for name in names)], axis=-1, dtype=np.float64)


def scaled_boxes(boxes: NDArray[Any], scale: float, size: tuple[int, int]) -> NDArray[np.float32]:
    """Return boxes (N, 4) xyxy as (N, 5) x, y, width, height, confidence.

    They are scaled about their centres and clipped to the image; what is left of none has confidence 0.
    """
    centre = (boxes[:, :2] + boxes[:, 2:]) / 2.0
    half = (boxes[:, 2:] - boxes[:, :2]) / 2.0 * scale
    low = np.clip(centre - half, 0.0, size)
    high = np.clip(centre + half, 0.0, size)
    present = (high > low).all(axis=1, keepdims=True)
    return np.asarray(np.hstack([low, high - low, np.ones_like(low[:, :1])]) * present, dtype=np.float32)


def joint_boxes(points: NDArray[Any], usable: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Return boxes (N, 4) xyxy around the usable ones of points (N, J, 2); zeros where none is."""
    inside = usable[..., None]
    low = np.where(inside, points, np.inf).min(axis=1)
    high = np.where(inside, points, -np.inf).max(axis=1)
    found = usable.any(axis=1)[:, None]
    return np.where(found, np.hstack([low, high]), 0.0)


def shards(parts: Iterable[Rows], rows: int) -> Iterator[dict[str, NDArray[Any]]]:
    """Join parts (each with equal first axes) into pieces of at most ``rows`` rows, never cutting a part."""
    held: list[Rows] = []
    count = 0
    for part in parts:
        length = len(next(iter(part.values())))
        if held and count + length > rows:
            yield _joined(held)
            held, count = [], 0
        if length:
            held.append(part)
            count += length
    if held:
        yield _joined(held)


def _joined(parts: list[Rows]) -> dict[str, NDArray[Any]]:
    return {key: np.concatenate([part[key] for part in parts]) for key in parts[0]}
