"""Where what is made to be looked at lies: ``DATASET/previews``, beside the data and no part of it."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

__all__ = ["KINDS", "Places"]

KINDS: Mapping[str, int] = MappingProxyType({".html": 1, ".mp4": 2, ".jpg": 4})
"""Files of a sequence by ending, with the bit that stands for each on the page."""


@dataclass(frozen=True)
class Places:
    """The files of a dataset's previews.

    Attributes:
        root: the dataset.
    """

    root: Path

    @property
    def folder(self) -> Path:
        """The folder of all of them."""
        return self.root / "previews"

    @property
    def page(self) -> Path:
        """The page of the dataset."""
        return self.root / "index.html"

    def scene(self, sequence_id: str) -> Path:
        """The 3D scene of a sequence, made by `whacamole view --save`."""
        return self.folder / f"{sequence_id}.html"

    def video(self, sequence_id: str) -> Path:
        """The video of a sequence, made by `whacamole preview`."""
        return self.folder / f"{sequence_id}.mp4"

    def sheet(self, sequence_id: str) -> Path:
        """The contact sheet of a sequence, made by `whacamole preview`."""
        return self.folder / f"{sequence_id}.jpg"

    def made(self) -> dict[str, int]:
        """Sequence id → the sum of the bits of what is there."""
        found: dict[str, int] = {}
        for file in self.folder.iterdir() if self.folder.is_dir() else ():
            if file.suffix in KINDS and not file.name.startswith("."):
                found[file.stem] = found.get(file.stem, 0) | KINDS[file.suffix]
        return found
