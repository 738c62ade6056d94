"""What `whacamole preview` does: a video and a contact sheet of each sequence, the page after them."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from whacamole.dataset import Dataset, Sequence, open_dataset
from whacamole.dataset.video import write_video
from whacamole.errors import DatasetError, WhacamoleError
from whacamole.viewing.bodies import model_for
from whacamole.viewing.panels import DEFAULT_LAYERS, Panels, layers_named
from whacamole.viewing.places import Places
from whacamole.viewing.progress import passing_bar

__all__ = ["Made", "Wanted", "make_previews"]

SHEET_FRAMES, SHEET_WIDTH = 6, 320
"""Columns of a contact sheet, and the width of its pictures [px]."""


@dataclass(frozen=True)
class Wanted:
    """What to make.

    Attributes:
        layers: names of :data:`whacamole.viewing.panels.LAYERS` by commas.
        video, sheet: which files.
        width: of each picture of the video [px].
        out: folder; None for ``DATASET/previews``.
        body_model: file of the model, None for the embedded one.
    """

    layers: str = ",".join(DEFAULT_LAYERS)
    video: bool = True
    sheet: bool = True
    width: int = 480
    out: Path | None = None
    body_model: Path | None = None


@dataclass
class Made:
    """What came out.

    Attributes:
        files: written.
        failed: sequence id → one-line error.
    """

    files: list[Path] = field(default_factory=list)
    failed: dict[str, str] = field(default_factory=dict)


def make_previews(
    dataset: Path, ids: list[str], wanted: Wanted, *, limit: int | None = None, quiet: bool = False
) -> Made:
    """Make the previews of some sequences, or of all; one that fails does not stop the others.

    Args:
        ids: sequences; empty for all.
        limit: make at most so many.
        quiet: show no progress.

    Raises:
        DatasetError: there is no dataset, no such sequence or no such layer.
    """
    data = open_dataset(dataset)
    chosen = [data[name] for name in ids] if ids else _first(data, limit)
    layers_named(wanted.layers, chosen[0])  # a dataset has the same passes throughout: told once
    made = Made()
    with passing_bar(quiet=quiet) as progress:
        task = progress.add_task("previews", total=sum(len(sequence) for sequence in chosen))
        for sequence in chosen:
            progress.update(task, description=sequence.id)
            try:
                made.files += _make(sequence, data, wanted, lambda: progress.advance(task))
            except WhacamoleError as error:
                made.failed[sequence.id] = str(error)
            except OSError as error:
                reason = f"{error.filename}: {error.strerror}" if error.filename else str(error)
                made.failed[sequence.id] = f"{reason}; --out names another folder"
    return made


def _first(data: Dataset, limit: int | None) -> list[Sequence]:
    if not len(data):
        raise DatasetError(f"{data.layout.root}: holds no finished sequence; see `whacamole status`")
    return [data[name] for name in data.ids[:limit]]


def _make(sequence: Sequence, data: Dataset, wanted: Wanted, advance: Callable[[], None]) -> Iterator[Path]:
    places = Places(data.layout.root)
    folder = places.folder if wanted.out is None else wanted.out
    folder.mkdir(parents=True, exist_ok=True)
    model, layers = model_for(sequence, wanted.body_model), layers_named(wanted.layers, sequence)
    if wanted.sheet:
        count = min(SHEET_FRAMES, len(sequence))
        frames = np.unique(np.linspace(0, len(sequence) - 1, count).round().astype(int)).tolist()
        path = folder / places.sheet(sequence.id).name
        Panels(sequence, model, layers, SHEET_WIDTH).sheet(frames).save(path, quality=88)
        yield path
    if wanted.video:
        panels = Panels(sequence, model, layers, wanted.width)

        def pictures() -> Iterator[NDArray[np.uint8]]:
            for frame in range(len(sequence)):
                yield panels.frame(frame)
                advance()

        path = folder / places.video(sequence.id).name
        write_video(path, pictures(), float(sequence.facts["fps"]))
        yield path
