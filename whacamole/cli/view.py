"""``whacamole view``: people and camera in 3D in a browser."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from whacamole.cli.options import BodyModelOfDataset

__all__ = ["view"]


def view(
    dataset: Annotated[Path, typer.Argument(help="Folder of the dataset.")],
    sequence: Annotated[
        str | None, typer.Argument(help="Id of a sequence.", show_default="the first")
    ] = None,
    pred: Annotated[
        Path | None,
        typer.Option(help="Folder of predictions to draw beside the truth.", show_default=False),
    ] = None,
    align: Annotated[
        Literal["camera", "stored"],
        typer.Option(
            help="Where predictions stand. camera: moved rigidly so that their first camera is the true one; "
            "stored: in their own world."
        ),
    ] = "camera",
    save: Annotated[
        Path | None,
        typer.Option(help="Write one offline HTML file and stop.", show_default=False),
    ] = None,
    full: Annotated[
        bool, typer.Option("--full", help="With --save: all vertices of the bodies, a larger file.")
    ] = False,
    body_model: BodyModelOfDataset = None,
    host: Annotated[
        str, typer.Option(help="Address to serve on; 0.0.0.0 lets other machines look.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(min=0, max=65535, help="Port to serve on.")] = 8080,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")] = False,
) -> None:
    """Show bodies, the camera with the frame it films, contacts and predictions; play, step, look around."""
    from whacamole.viewing.view import Request, save_view, serve_view

    request = Request(dataset, sequence, pred, align, body_model)
    if save is None:
        serve_view(request, host, port, say=(lambda _: None) if quiet else typer.echo)
        return
    size = save_view(request, save, full=full, quiet=quiet)
    if not quiet:
        typer.echo(f"{save} ({size / 1e6:.1f} MB): open it in a browser")
