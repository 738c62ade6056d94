"""``whacamole preview``: videos and contact sheets with the labels drawn in."""

from pathlib import Path
from typing import Annotated

import typer

from whacamole.cli.options import BodyModelOfDataset

__all__ = ["preview"]


def preview(
    dataset: Annotated[Path, typer.Argument(help="Folder of the dataset.")],
    sequences: Annotated[list[str] | None, typer.Argument(help="Ids.", show_default="all")] = None,
    layers: Annotated[
        str,
        typer.Option(
            help="By commas: rgb; mesh, joints, boxes, ids, contacts (over one picture); mask, depth, "
            "normal, flow; map, aside (the scene)."
        ),
    ] = "rgb,mesh,ids,contacts,map",
    video: Annotated[bool, typer.Option(help="Write <id>.mp4.")] = True,
    sheet: Annotated[bool, typer.Option(help="Write <id>.jpg: a row a layer, a column a frame.")] = True,
    width: Annotated[
        int, typer.Option(min=64, max=3840, help="Width of each picture of the video in pixels.")
    ] = 480,
    out: Annotated[
        Path | None, typer.Option(help="Folder to write to.", show_default="DATASET/previews")
    ] = None,
    limit: Annotated[
        int | None, typer.Option(min=1, help="At most so many sequences.", show_default="no limit")
    ] = None,
    body_model: BodyModelOfDataset = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")] = False,
) -> None:
    """Draw labels over frames and numbers as colours, side by side with the scene from above."""
    from whacamole.viewing.preview import Wanted, make_previews

    wanted = Wanted(layers, video, sheet, width, out, body_model)
    made = make_previews(dataset, list(sequences or ()), wanted, limit=limit, quiet=quiet)
    for path in () if quiet else made.files:
        typer.echo(path)
    for name, error in made.failed.items():
        typer.echo(f"failed: {name}: {error}", err=True)
    raise typer.Exit(1 if made.failed else 0)
