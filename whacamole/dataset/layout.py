"""The one owner of every path in a dataset (docs/format.md)."""

import re
from dataclasses import dataclass
from pathlib import Path

from whacamole.errors import DatasetError

__all__ = ["FORMAT_VERSION", "DatasetLayout", "SequenceLayout"]

FORMAT_VERSION = "1.0"
_SAFE_ID = re.compile(r"[A-Za-z0-9_.-]{1,200}")


@dataclass(frozen=True)
class SequenceLayout:
    """The files of one sequence, finished or being made."""

    folder: Path

    @property
    def camera(self) -> Path:
        return self.folder / "camera.npz"

    @property
    def people(self) -> Path:
        return self.folder / "people.npz"

    @property
    def contact(self) -> Path:
        return self.folder / "contact.npz"

    @property
    def shot(self) -> Path:
        return self.folder / "shot.json"

    @property
    def summary(self) -> Path:
        """What the sequence is, with the checksum of every other file in it."""
        return self.folder / "sequence.json"

    @property
    def video(self) -> Path:
        """The colour frames, where they are one file."""
        return self.folder / "rgb.mp4"

    @property
    def preview(self) -> Path:
        return self.folder / "preview.jpg"

    @property
    def labels(self) -> tuple[Path, ...]:
        """The files that the same recipe and seed give bit for bit."""
        return (self.camera, self.people, self.contact, self.shot)


@dataclass(frozen=True)
class DatasetLayout:
    """The files of a dataset."""

    root: Path

    @property
    def index(self) -> Path:
        return self.root / "dataset.json"

    @property
    def card(self) -> Path:
        return self.root / "README.md"

    @property
    def splits(self) -> Path:
        return self.root / "splits"

    @property
    def sequences(self) -> Path:
        return self.root / "sequences"

    @property
    def work(self) -> Path:
        """Unfinished sequences; nothing in here belongs to the dataset."""
        return self.root / ".work"

    @property
    def profiles(self) -> Path:
        """A file for each sequence: where the time went that it took."""
        return self.work / "profiles"

    @property
    def logs(self) -> Path:
        """Logs of sequences that took more than one attempt."""
        return self.work / "logs"

    @property
    def runs(self) -> Path:
        """A file for each run that is at work."""
        return self.work / "runs"

    def sequence(self, sequence_id: str) -> SequenceLayout:
        """Return the place of a finished sequence."""
        return SequenceLayout(self.sequences / _checked(sequence_id))

    def work_of(self, sequence_id: str) -> Path:
        """Return the folder in which a sequence is made."""
        return self.work / _checked(sequence_id)

    def finished(self) -> list[str]:
        """Return the ids of the finished sequences, sorted."""
        if not self.sequences.is_dir():
            return []
        return sorted(path.parent.name for path in self.sequences.glob("*/sequence.json"))


def _checked(sequence_id: str) -> str:
    if not _SAFE_ID.fullmatch(sequence_id) or set(sequence_id) <= {"."}:
        raise DatasetError(f"{sequence_id!r} is no sequence id: only letters, digits, '.', '_' and '-'")
    return sequence_id
