"""The list of export formats, and the one function that runs them."""

import shutil
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path

from whacamole.dataset import Dataset
from whacamole.errors import DatasetError, RecipeError
from whacamole.export.source import Source

__all__ = ["EXPORTERS", "ExportResult", "Exporter", "export_dataset"]

Writer = Callable[[Source, Path], list[str]]


@dataclass(frozen=True)
class Exporter:
    """One format.

    Attributes:
        name: what users type after ``--to``.
        summary: what is written, in one line.
        place: module and function that write it; imported when it is asked for.
        needs: passes it reads.
        thins: whether ``every`` may be above 1; formats of whole sequences keep every frame.
    """

    name: str
    summary: str
    place: tuple[str, str]
    needs: tuple[str, ...] = ()
    thins: bool = False

    @property
    def write(self) -> Writer:
        """The function that writes into an empty folder and returns a line for each thing left out."""
        module, function = self.place
        writer: Writer = getattr(import_module(f"whacamole.export.{module}"), function)
        return writer


EXPORTERS: dict[str, Exporter] = {
    exporter.name: exporter
    for exporter in (
        Exporter(
            "humandata",
            "HumanData npz, as the published WHAC-A-Mole: mmhuman3d, SMPLer-X, SMPLest-X",
            ("humandata", "write_humandata"),
            thins=True,
        ),
        Exporter(
            "bedlam",
            "npz of BEDLAM's training code, one row a person and image",
            ("bedlam", "write_bedlam"),
            thins=True,
        ),
        Exporter(
            "emdb", "EMDB pickles, one a person: evaluators of WHAM, TRAM, GVHMR", ("emdb", "write_emdb")
        ),
        Exporter(
            "coco",
            "COCO JSON: boxes, run-length masks, 17 keypoints",
            ("coco", "write_coco"),
            needs=("mask",),
            thins=True,
        ),
        Exporter("tum", "TUM trajectories of the camera, for evo and DPVO", ("trajectories", "write_tum")),
        Exporter(
            "nerfstudio",
            "transforms.json for nerfstudio, pointing at the frames",
            ("trajectories", "write_nerfstudio"),
        ),
        Exporter("amass", "AMASS SMPL-X npz, one motion a person", ("amass", "write_amass")),
        Exporter(
            "webdataset",
            "tar shards of frames with their labels",
            ("webdataset", "write_webdataset"),
            thins=True,
        ),
        Exporter("mp4", "H.264 video with exact frame times", ("video", "write_mp4"), needs=("rgb",)),
    )
}
"""Every format, by name."""


@dataclass(frozen=True)
class ExportResult:
    """What an export wrote.

    Attributes:
        folder: where.
        files: the files, relative to it, sorted.
        sequences: how many sequences were given to the format.
        notes: a line for each thing the format could not hold.
    """

    folder: Path
    files: tuple[str, ...]
    sequences: int
    notes: tuple[str, ...]


def export_dataset(
    dataset: Dataset, to: str, out: Path, *, split: str | None = None, every: int = 1
) -> ExportResult:
    """Write a dataset in another format: complete, or not at all.

    Args:
        dataset: what to export.
        to: the format, a key of :data:`EXPORTERS`.
        out: a folder that is not there yet.
        split: only this split; None takes every sequence.
        every: take every Nth frame, where the format holds single frames.

    Raises:
        RecipeError: no such format, or it cannot leave frames out.
        DatasetError: nothing to export, a sequence or a pass is missing, or ``out`` is there already.
    """
    exporter = EXPORTERS.get(to)
    if exporter is None:
        raise RecipeError(f"--to {to}: no such format; choose from {', '.join(EXPORTERS)}")
    if every < 1 or (every > 1 and not exporter.thins):
        raise RecipeError(f"--every {every}: {to} holds whole sequences; leave the option out")
    dataset.require_whole()
    chosen = dataset if split is None else dataset.split(split)
    _require(exporter, chosen, split)
    if out.exists():
        raise DatasetError(f"{out}: already there; choose another --out or delete it")
    part = out.with_name(f".{out.name}.part")
    shutil.rmtree(part, ignore_errors=True)
    try:
        part.mkdir(parents=True)
    except OSError as error:
        raise DatasetError(f"{out}: cannot be made ({error.strerror}); choose another --out") from error
    try:
        notes = exporter.write(Source(chosen, split or "all", every, out), part)
        part.rename(out)
    except BaseException:
        shutil.rmtree(part, ignore_errors=True)
        raise
    files = sorted(path.relative_to(out).as_posix() for path in out.rglob("*") if path.is_file())
    return ExportResult(out, tuple(files), len(chosen), tuple(notes))


def _require(exporter: Exporter, dataset: Dataset, split: str | None) -> None:
    """Refuse what cannot be written before anything is."""
    if not len(dataset):
        where = dataset.layout.root if split is None else dataset.layout.splits / f"{split}.txt"
        raise DatasetError(f"{where}: holds no sequence; render more, or choose another --split")
    for sequence in dataset:
        missing = [name for name in exporter.needs if name not in sequence.facts["passes"]]
        if missing:
            raise DatasetError(
                f"{sequence.id}: {missing[0]} was not rendered and {exporter.name} needs it; "
                f"render with --passes …,{missing[0]}"
            )
