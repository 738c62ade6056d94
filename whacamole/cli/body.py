"""``whacamole body``: the embedded body, for other tools."""

from pathlib import Path
from typing import Annotated

import typer

__all__ = ["body"]


def body(
    export: Annotated[Path, typer.Option(help="Where to write the full SMPL-X-schema .npz.")],
) -> None:
    """Write the embedded body as a file that the smplx package and Blender add-ons load."""
    from whacamole.body import BodyModel

    model = BodyModel.embedded()
    model.export_full(export)
    typer.echo(f"{export}: {model.name}, {model.num_vertices} vertices, sha256 {model.sha256[:12]}")
