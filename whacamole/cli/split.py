"""``whacamole split``: train and test by another rule."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from whacamole.words import counted

if TYPE_CHECKING:
    from whacamole.dataset import Dataset

__all__ = ["split"]


def split(
    dataset: Annotated[Path, typer.Argument(help="Folder of the dataset.")],
    by: Annotated[
        Literal["motion", "person", "stage"],
        typer.Option(help="What must not be on both sides; motions never are."),
    ] = "motion",
    test_fraction: Annotated[
        float, typer.Option(min=0.0, max=1.0, help="Share that goes to the test split.")
    ] = 0.2,
    seed: Annotated[int, typer.Option(help="Another seed gives another split.")] = 0,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print errors only.")] = False,
    json_output: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
) -> None:
    """Write splits/train.txt and splits/test.txt anew; a split that would leak is refused."""
    from whacamole.dataset import open_dataset
    from whacamole.dataset.splitting import SplitRule, split_dataset

    data = open_dataset(dataset)
    data.require_whole()
    sides = split_dataset(data.layout, SplitRule(by, test_fraction, seed))
    _count_anew(data)
    if json_output:
        typer.echo(json.dumps(sides, indent=1))
        return
    for name, ids in sides.items():
        if not quiet:
            typer.echo(f"{name}: {counted(len(ids), 'sequence')}")
    if 0.0 < test_fraction < 1.0 and not all(sides.values()):
        typer.echo("one side is empty, there are few groups to draw from; another --seed may help", err=True)


def _count_anew(data: "Dataset") -> None:
    """Card and page name the splits: make those again that are there."""
    from whacamole.dataset.card import write_card
    from whacamole.dataset.statistics import collect
    from whacamole.viewing.page import write_page
    from whacamole.viewing.places import Places

    card, page = data.layout.card.is_file(), Places(data.layout.root).page.is_file()
    if card or page:
        numbers = collect(data)
        if card:
            write_card(data.layout, numbers)
        if page:
            write_page(data.layout, numbers)
