"""``whacamole recipe``: the default recipe, with comments."""

import json
from typing import Annotated

import typer

__all__ = ["recipe"]


def recipe(
    schema: Annotated[bool, typer.Option("--schema", help="Print the JSON schema instead.")] = False,
) -> None:
    """Print the default recipe as YAML, every value explained: save it, edit it, `render --recipe` it."""
    from whacamole.recipe import Recipe, default_yaml

    typer.echo(json.dumps(Recipe.model_json_schema(), indent=1) if schema else default_yaml(), nl=schema)
