"""Options that several commands take in the same words."""

from pathlib import Path
from typing import Annotated

import typer

__all__ = ["BodyModelOfDataset", "OwnBodyModel"]

OwnBodyModel = Annotated[
    Path | None,
    typer.Option(help="SMPL-X .npz of your own licence.", show_default="the embedded CC0 body"),
]

BodyModelOfDataset = Annotated[
    Path | None,
    typer.Option(
        help="The SMPL-X .npz that the dataset was made with.", show_default="the embedded CC0 body"
    ),
]
