"""The command line: one file a command, each thin, nothing heavy imported before it is needed."""

import sys
from collections.abc import Callable
from typing import Any

import typer

from whacamole.cli.baseline import app as baseline
from whacamole.cli.body import body
from whacamole.cli.check import check
from whacamole.cli.doctor import doctor
from whacamole.cli.evaluate import evaluate
from whacamole.cli.export import export
from whacamole.cli.page import page
from whacamole.cli.plan import plan
from whacamole.cli.preview import preview
from whacamole.cli.recipe import recipe
from whacamole.cli.render import render
from whacamole.cli.split import split
from whacamole.cli.stats import stats
from whacamole.cli.status import status
from whacamole.cli.view import view

__all__ = ["app", "main"]

COMMANDS: tuple[Callable[..., Any], ...] = (
    render, plan, check, status, stats, view, preview, page, split, export, evaluate, body, recipe, doctor,
)  # fmt: skip

app = typer.Typer(
    name="whacamole",
    help="Synthetic video datasets of people and cameras in one metric world.",
    no_args_is_help=True,
    add_completion=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
for command in COMMANDS:
    app.command(command.__name__)(command)
app.add_typer(baseline, name="baseline")


def main() -> None:
    """Run the command line; an error a user can mend is one line, not a traceback."""
    try:
        app()
    except KeyboardInterrupt:
        typer.echo("stopped; finished sequences are kept, the same command goes on", err=True)
        sys.exit(130)
    except Exception as error:
        if not _is_ours(error):
            raise
        typer.echo(f"error: {error}", err=True)
        sys.exit(1)


def _is_ours(error: Exception) -> bool:
    """Return whether the error is one that names its remedy (the trees are imported late, they cost time)."""
    from camera_rigs import PlanError
    from render_jobs import RenderJobError
    from whacamole.errors import WhacamoleError

    return isinstance(error, WhacamoleError | RenderJobError | PlanError)
