"""``whacamole check``: do the labels of a dataset land on its pixels?"""

import json
from pathlib import Path
from typing import Annotated

import typer

from whacamole.cli.options import BodyModelOfDataset

__all__ = ["check"]


def check(
    dataset: Annotated[Path, typer.Argument(help="Folder of the dataset.")],
    checksums: Annotated[
        bool, typer.Option(help="Compare every file with the checksum noted when it was written.")
    ] = True,
    body_model: BodyModelOfDataset = None,
    contact_regions: Annotated[
        Path | None,
        typer.Option(
            help="The region file that the dataset's contacts are named by.",
            show_default="the recipe's, if it is still there",
        ),
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print findings only.")] = False,
    json_output: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Derive the labels again from each other and hold them against the pixels; exit 1 on a finding.

    The outcome is stored in DATASET/check.json, which `page` shows; nothing else is written.
    """
    from rich.console import Console

    from whacamole.body import BodyModel
    from whacamole.check import check_dataset
    from whacamole.check.stored import store_findings

    model = None if body_model is None else BodyModel.load(body_model)
    with Console(stderr=True, quiet=quiet or json_output).status("auditing") as status:
        found = check_dataset(
            dataset,
            checksums=checksums,
            body_model=model,
            contact_regions=contact_regions,
            on_sequence=lambda sequence_id: status.update(f"auditing {sequence_id}"),
        )
    try:
        store_findings(dataset, found)  # for the page and for whoever looks later
    except OSError as error:
        typer.echo(f"{dataset}: the outcome was not stored ({error.strerror or error})", err=True)
    if json_output:
        typer.echo(json.dumps(found.to_json(), indent=1))
    else:
        lines = [finding.line() for finding in found] if quiet else found.lines()
        typer.echo("\n".join(lines), nl=bool(lines))
    raise typer.Exit(0 if found.ok else 1)
