"""Reading a dataset: sequences by name or number, arrays and frames only when asked for.

::

    import whacamole

    data = whacamole.open("dataset")
    for sequence in data.split("train"):
        camera, people = sequence.camera, sequence.people
        for clip in sequence.clips(16):
            images = [sequence.rgb(frame) for frame in clip]
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from render_jobs import PASSES
from render_jobs.images import read_exr
from whacamole.dataset.index import read_json, read_summary
from whacamole.dataset.layout import DatasetLayout, SequenceLayout
from whacamole.dataset.video import VideoFrames
from whacamole.errors import DatasetError

__all__ = ["Dataset", "Sequence", "open_dataset"]

Arrays = dict[str, NDArray[Any]]


@dataclass(frozen=True, eq=False)
class Sequence:
    """One sequence; nothing is read before it is asked for. Keys, shapes and units: docs/format.md.

    Attributes:
        id: its name.
        layout: where its files are.
        facts: what ``sequence.json`` says: motion, shots, stage, size, checksums.
    """

    id: str
    layout: SequenceLayout
    facts: Mapping[str, Any]

    @cached_property
    def camera(self) -> Arrays:
        """The arrays of ``camera.npz``."""
        return _arrays(self.layout.camera)

    @cached_property
    def people(self) -> Arrays:
        """The arrays of ``people.npz``."""
        return _arrays(self.layout.people)

    @cached_property
    def contact(self) -> Arrays:
        """The arrays of ``contact.npz``."""
        return _arrays(self.layout.contact)

    @cached_property
    def shot(self) -> dict[str, Any]:
        """What ``shot.json`` says: shots, keyframes, findings."""
        value = read_json(self.layout.shot, "delete the folder, render again")
        if not isinstance(value, dict):
            raise DatasetError(f"{self.layout.shot}: not the plan of a shot; render the sequence again")
        return value

    def __len__(self) -> int:
        """Return the number of frames, T."""
        return int(self.facts["frames"])

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of a frame in pixels."""
        return int(self.facts["width"]), int(self.facts["height"])

    def rgb(self, frame: int) -> NDArray[np.uint8]:
        """Return the colour frame (H, W, 3), sRGB.

        Raises:
            DatasetError: the frame is missing or broken.
        """
        if self.facts["image_format"] != "mp4":
            return np.asarray(_image(self._file("rgb", frame)).convert("RGB"))
        self._check_frame(frame)
        try:
            return self._video[frame]
        except (OSError, ValueError, IndexError) as error:
            raise DatasetError(
                f"{self.layout.video}: frame {frame} is not readable ({error}); render the sequence again"
            ) from error

    def mask(self, frame: int) -> NDArray[np.integer[Any]]:
        """Return the mask (H, W): track ids, 0 is background."""
        return np.asarray(_image(self._file("mask", frame)))

    def depth(self, frame: int) -> NDArray[np.float32]:
        """Return planar depth (H, W) in metres; no hit is infinite."""
        return self._exr("depth", frame)[..., 0]

    def normal(self, frame: int) -> NDArray[np.float32]:
        """Return unit normals (H, W, 3) in the camera frame, OpenCV axes."""
        return self._exr("normal", frame)

    def flow(self, frame: int) -> NDArray[np.float32]:
        """Return the flow to the next frame (H, W, 2) in pixels, x right, y down."""
        return self._exr("flow", frame)

    def clips(self, length: int, stride: int | None = None) -> Iterator[range]:
        """Yield the frame ranges of clips of ``length`` frames, ``stride`` apart (default: end to end).

        A rest shorter than ``length`` is left out.
        """
        if length < 1 or (stride is not None and stride < 1):
            raise ValueError(f"clips of {length} frames every {stride}: both must be at least 1")
        for start in range(0, len(self) - length + 1, stride or length):
            yield range(start, start + length)

    @cached_property
    def _video(self) -> VideoFrames:
        return VideoFrames(self.layout.video, *self.size)

    def _check_frame(self, frame: int) -> None:
        if not 0 <= frame < len(self):
            raise IndexError(f"{self.id}: frame {frame} of {len(self)}")

    def _file(self, name: str, frame: int) -> Path:
        self._check_frame(frame)
        if name not in self.facts["passes"]:
            made = ", ".join(self.facts["passes"])
            raise DatasetError(
                f"{self.id}: {name} was not rendered, only {made}; render with --passes …,{name}"
            )
        return self.layout.folder / PASSES[name].file(frame, self.facts["image_format"])

    def _exr(self, name: str, frame: int) -> NDArray[np.float32]:
        path = self._file(name, frame)
        try:
            channels = read_exr(path)
            return np.stack([channels[channel] for channel in PASSES[name].channels], axis=-1)
        except (OSError, RuntimeError, KeyError) as error:
            raise DatasetError(f"{path}: not a readable {name} image ({error}); render it again") from error


@dataclass(frozen=True, eq=False)
class Dataset:
    """A dataset on disk: a mapping from sequence id to :class:`Sequence`, in the order of the ids."""

    layout: DatasetLayout
    ids: tuple[str, ...]

    @cached_property
    def index(self) -> dict[str, Any]:
        """What ``dataset.json`` says: versions, recipe, body model, one entry a sequence."""
        value = read_json(self.layout.index)
        entries = value.get("sequences") if isinstance(value, dict) else None
        if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
            raise DatasetError(
                f"{self.layout.index}: not the index of a dataset; run `whacamole render` again"
            )
        whole: dict[str, Any] = value
        return whole

    def require_whole(self) -> None:
        """Refuse a dataset that lacks a sequence which ``dataset.json`` lists.

        Raises:
            DatasetError: the index is broken, or a sequence it lists is not there.
        """
        for entry in self.index["sequences"]:
            summary = self.layout.sequence(str(entry.get("id"))).summary
            if not summary.is_file():
                raise DatasetError(
                    f"{summary}: not there, but {self.layout.index.name} lists the sequence; "
                    "run `whacamole render` again with the same options"
                )

    def __len__(self) -> int:
        """Return the number of sequences."""
        return len(self.ids)

    def __iter__(self) -> Iterator[Sequence]:
        """Yield every sequence."""
        return (self[sequence_id] for sequence_id in self.ids)

    def __contains__(self, sequence_id: object) -> bool:
        """Return whether there is a sequence of this id."""
        return sequence_id in self.ids

    def __getitem__(self, key: str | int) -> Sequence:
        """Return a sequence by id or by number.

        Raises:
            DatasetError: there is no sequence of this id.
            IndexError: there is none of this number.
        """
        sequence_id = self.ids[key] if isinstance(key, int) else key
        if sequence_id not in self.ids:
            some = ", ".join((*self.ids[:5], *(["…"] if len(self.ids) > 5 else ())))
            raise DatasetError(f"{self.layout.root}: no sequence {key!r}; there are {some or 'none'}")
        sequence = self.layout.sequence(sequence_id)
        return Sequence(sequence_id, sequence, read_summary(sequence))

    def split(self, name: str) -> "Dataset":
        """Return the sequences listed in ``splits/<name>.txt`` as a dataset of their own.

        Raises:
            DatasetError: there is no such split, or it lists a sequence that is not there.
        """
        file = self.layout.splits / f"{name}.txt"
        try:
            listed = tuple(file.read_text(encoding="utf-8").split())
        except OSError as error:
            raise DatasetError(
                f"{file}: no split {name!r} ({error.strerror}); there are train and test"
            ) from error
        missing = [sequence_id for sequence_id in listed if sequence_id not in self.ids]
        if missing:
            raise DatasetError(
                f"{file}: lists {missing[0]}, which is not there; run `whacamole render` again"
            )
        return Dataset(self.layout, listed)


def open_dataset(path: Path | str) -> Dataset:
    """Open the dataset in the folder ``path``.

    Raises:
        DatasetError: it is no dataset, is not finished, or its index is broken.
    """
    layout = DatasetLayout(Path(path))
    if not layout.index.is_file():
        if layout.work.is_dir() or layout.sequences.is_dir():
            raise DatasetError(
                f"{path}: unfinished, there is no dataset.json yet; wait for `whacamole render` to end "
                "(`whacamole status`), or start it again with the same options"
            )
        raise DatasetError(f"{path}: no dataset.json; is this a folder made by `whacamole render`?")
    dataset = Dataset(layout, tuple(layout.finished()))
    _ = dataset.index  # a broken index is told now, not when half the work is done
    return dataset


def _arrays(path: Path) -> Arrays:
    try:
        with path.open("rb") as stream, np.load(stream, allow_pickle=False) as stored:
            return {key: stored[key] for key in stored.files}
    except (OSError, ValueError, EOFError, BadZipFile) as error:
        raise DatasetError(f"{path}: not readable ({error}); render the sequence again") from error


def _image(path: Path) -> Image.Image:
    try:
        image = Image.open(path)
        image.load()
        return image
    except (OSError, UnidentifiedImageError) as error:
        raise DatasetError(f"{path}: not a readable image ({error}); render the sequence again") from error
