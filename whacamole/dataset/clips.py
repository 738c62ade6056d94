"""Clips of a dataset by number: what a training loop asks for, in plain NumPy.

:class:`Clips` has ``len()`` and ``[]``, which is all that ``torch.utils.data.DataLoader`` needs
(examples/03_train_on_clips.py).
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from whacamole.dataset.reader import Dataset

__all__ = ["Clips", "cut"]

_PEOPLE = (
    "expression", "global_orient_world", "transl_world", "global_orient_camera", "transl_camera",
    "body_pose", "left_hand_pose", "right_hand_pose", "jaw_pose", "leye_pose", "reye_pose",
    "joints_world", "joints_camera", "joints_image", "joint_visibility", "bbox_xyxy",
    "bbox_visible_xyxy", "visible_fraction", "truncation", "valid",
)  # fmt: skip
_BETWEEN_PEOPLE = ("person_contact", "person_distance", "person_contact_part")
_TIME_AXIS: dict[str, dict[str, int]] = {
    "camera": dict.fromkeys(("K", "T_world_camera", "T_camera_world", "focus_distance", "frame_index"), 0),
    "people": dict.fromkeys(_PEOPLE, 1),
    "contact": {
        **dict.fromkeys(("ground_contact", "ground_distance", "vertex_contact"), 1),
        **dict.fromkeys(_BETWEEN_PEOPLE, 2),
    },
}
"""The axis of time of every array that has one (docs/format.md)."""

_FOR_EACH_PERSON = ("track_id", "betas", *_PEOPLE)


def cut(kind: str, arrays: Mapping[str, NDArray[Any]], frames: range) -> dict[str, NDArray[Any]]:
    """Return the arrays of ``camera.npz``, ``people.npz`` or ``contact.npz`` for some frames only.

    Args:
        kind: ``"camera"``, ``"people"`` or ``"contact"``.
        arrays: all of that file.
        frames: the frames to keep; arrays without an axis of time are passed on.
    """
    axes = _TIME_AXIS[kind]
    taken = np.asarray(frames)
    return {
        key: np.take(value, taken, axis=axes[key]) if key in axes else value for key, value in arrays.items()
    }


class Clips:
    """Clips of equal length from every sequence of a dataset, by number.

    An item is a flat dictionary: ``sequence`` (its id), ``frame_index`` (L,), the passes asked for
    (``rgb`` (L, H, W, 3) and so on), the camera's and the people's arrays under the names of docs/format.md
    with L for T, and ``num_people``. Strings about people are left out; read them from the sequence.

    Args:
        dataset: a dataset or one of its splits.
        length: frames a clip, L. Sequences shorter than that give none.
        stride: frames from the start of one clip to the next; by default they are laid end to end.
        passes: images to read.
        max_people: pad the people's arrays to so many with zeros (``track_id`` 0, ``valid`` false), so that
            clips can be stacked; people beyond it are left out, the least visible first.
    """

    def __init__(
        self,
        dataset: Dataset,
        length: int,
        *,
        stride: int | None = None,
        passes: tuple[str, ...] = ("rgb",),
        max_people: int | None = None,
    ) -> None:
        if max_people is not None and max_people < 1:
            raise ValueError(f"max_people={max_people}: must be at least 1")
        self._dataset = dataset
        self._passes = passes
        self._max_people = max_people
        self._clips = [
            (sequence.id, frames) for sequence in dataset for frames in sequence.clips(length, stride)
        ]

    def __len__(self) -> int:
        """Return the number of clips."""
        return len(self._clips)

    def __getitem__(self, number: int) -> dict[str, Any]:
        """Read one clip.

        Raises:
            IndexError: there is none of this number.
            DatasetError: a file of it is missing or broken.
        """
        sequence_id, frames = self._clips[number]
        sequence = self._dataset[sequence_id]
        people = cut("people", sequence.people, frames)
        chosen = {key: people[key] for key in _FOR_EACH_PERSON}
        if self._max_people is not None:
            chosen = _padded(chosen, self._max_people)
        images = {
            name: np.stack([getattr(sequence, name)(frame) for frame in frames]) for name in self._passes
        }
        return {
            "sequence": sequence_id,
            **cut("camera", sequence.camera, frames),
            **images,
            **chosen,
            "num_people": int((chosen["track_id"] > 0).sum()),
        }


def _padded(people: dict[str, NDArray[Any]], count: int) -> dict[str, NDArray[Any]]:
    """Return the arrays with exactly ``count`` people, in the order of their track ids."""
    most_seen = np.argsort(-people["visible_fraction"].mean(axis=1), kind="stable")[:count]
    kept = np.sort(most_seen)
    missing = count - len(kept)
    return {
        key: np.pad(value[kept], [(0, missing), *[(0, 0)] * (value.ndim - 1)])
        for key, value in people.items()
    }
