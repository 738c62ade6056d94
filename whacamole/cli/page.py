"""``whacamole page``: one offline page of all sequences of a dataset."""

from pathlib import Path
from typing import Annotated

import typer

from whacamole.cli.options import BodyModelOfDataset

__all__ = ["page"]


def page(
    dataset: Annotated[Path, typer.Argument(help="Folder of the dataset.")],
    scenes: Annotated[
        int, typer.Option(min=0, help="First save the 3D scenes of so many sequences that have none.")
    ] = 0,
    videos: Annotated[
        int, typer.Option(min=0, help="First make the videos of so many sequences that have none.")
    ] = 0,
    body_model: BodyModelOfDataset = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")] = False,
) -> None:
    """Write DATASET/index.html: pictures, filters, statistics, findings of `check`, videos and 3D scenes.

    `render` writes the page too; write it again after `check`, `split`, `preview` or `view --save`.
    """
    from whacamole.viewing.make_page import make_page

    path = make_page(dataset, scenes=scenes, videos=videos, body_model=body_model, quiet=quiet)
    if not quiet:
        typer.echo(f"open {path} in a browser")
