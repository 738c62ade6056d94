"""``whacamole status``: how far a dataset is."""

import json
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["status"]


def status(
    dataset: Annotated[Path, typer.Argument(help="Folder of the dataset.")],
    json_output: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Say what is finished, what is being made and what failed, also while `render` runs elsewhere."""
    from whacamole.production.status import status_of

    state = status_of(dataset)
    if json_output:
        typer.echo(json.dumps(state.as_dict(), indent=1))
        return
    typer.echo(state.as_text())
