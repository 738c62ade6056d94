"""What every exporter is given: sequences to write, and the few questions all of them ask."""

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from render_jobs import PASSES
from whacamole.dataset import Dataset, Sequence
from whacamole.errors import DatasetError

__all__ = ["Source", "image_format"]


def image_format(sequence: Sequence) -> str:
    """Return the format of a sequence's colour frames, each a file of its own.

    Raises:
        DatasetError: they are one video.
    """
    found = str(sequence.facts["image_format"])
    if found == "mp4":
        raise DatasetError(
            f"{sequence.layout.video}: this format lists single images; render with --image-format jpg or png"
        )
    return found


@dataclass(frozen=True, eq=False)
class Source:
    """The part of a dataset that is exported.

    Attributes:
        dataset: its sequences, in the order they are written.
        label: what the part is called in file names: ``"train"``, ``"test"`` or ``"all"``.
        every: take every Nth frame of a sequence, from its first.
        out: the folder the result will stand in, for paths relative to it.
    """

    dataset: Dataset
    label: str
    every: int
    out: Path

    def __iter__(self) -> Iterator[Sequence]:
        """Yield the sequences, one in memory at a time."""
        return iter(self.dataset)

    def frames(self, sequence: Sequence) -> range:
        """Return the frames that are taken of a sequence."""
        return range(0, len(sequence), self.every)

    def image(self, sequence: Sequence, frame: int) -> str:
        """Return the path of a colour frame relative to the root of the dataset, with slashes."""
        file = PASSES["rgb"].file(frame, image_format(sequence))
        return (sequence.layout.folder / file).relative_to(self.dataset.layout.root).as_posix()

    def from_out(self, path: Path, folder: str = ".") -> str:
        """Return ``path`` as seen from ``folder`` of the result, with slashes."""
        return Path(os.path.relpath(path.resolve(), (self.out / folder).resolve())).as_posix()
