"""``whacamole export``: a dataset in the formats of other tools."""

import json
from pathlib import Path
from typing import Annotated

import typer

from whacamole.words import counted

__all__ = ["export"]


def export(
    dataset: Annotated[Path, typer.Argument(help="Folder of the dataset.")],
    to: Annotated[
        str,
        typer.Option(
            help="humandata, bedlam, emdb, coco, tum, nerfstudio, amass, webdataset or mp4 (docs/export.md)."
        ),
    ],
    out: Annotated[Path, typer.Option(help="Folder to write, which must not be there yet.")],
    split: Annotated[str | None, typer.Option(help="Only this split.", show_default="all sequences")] = None,
    every: Annotated[
        int, typer.Option(min=1, help="Take every Nth frame (humandata, bedlam, coco, webdataset).")
    ] = 1,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")] = False,
    json_output: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Write a dataset in another format: complete, or not at all."""
    from whacamole.dataset import open_dataset
    from whacamole.export import export_dataset

    result = export_dataset(open_dataset(dataset), to, out, split=split, every=every)
    if json_output:
        value = {
            "folder": str(result.folder), "format": to, "sequences": result.sequences,
            "files": list(result.files), "notes": list(result.notes),
        }  # fmt: skip
        typer.echo(json.dumps(value, indent=1))
        return
    for note in result.notes:
        typer.echo(note, err=True)
    if not quiet:
        typer.echo(
            f"{out}: {counted(result.sequences, 'sequence')} as {to}, {counted(len(result.files), 'file')}"
        )
