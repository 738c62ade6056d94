"""``whacamole stats``: what a dataset holds, in numbers."""

import json
from pathlib import Path
from typing import Annotated

import typer

__all__ = ["stats"]


def stats(
    dataset: Annotated[Path, typer.Argument(help="Folder of the dataset.")],
    split: Annotated[str | None, typer.Option(help="Only this split.", show_default="all sequences")] = None,
    card: Annotated[bool, typer.Option("--card", help="Also write DATASET/README.md anew.")] = False,
    json_output: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Count instances, sequences, motions, licences, shots, distances, visibility, contact, stages."""
    from whacamole.dataset import open_dataset
    from whacamole.dataset.card import statistics_text, write_card
    from whacamole.dataset.statistics import collect

    data = open_dataset(dataset)
    data.require_whole()
    numbers = collect(data if split is None else data.split(split))
    if card:
        write_card(data.layout)
    typer.echo(json.dumps(numbers.as_dict(), indent=1) if json_output else statistics_text(numbers))
